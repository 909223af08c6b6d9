// slice_rows.vh - which rows and pixels of a slice lie in a brick, in exact integers (docs/architecture.md, section 3):
// along a row or a column numerators grow by one step, so those between two limits are one run, and its ends are two
// divisions, of which 14 bits matter, as there are no more pixels. Combinational; to be included inside a module none of
// whose signals has the name of an argument or a local here.
//
// A run is {end, first}, 15 bits each: pixels first to end-1; none when first >= end.
//
//   rows of a slice   start with those of its bound; each axis whose step_u is 0 narrows them, by
//                     origin, step_v, lo, hi
//   run of row y      starts with the columns of the bound; each axis narrows it, by
//                     origin + y*step_v, step_u, lo, hi

// The least p >= 0 with p*size > n: floor(n/size) + 1, or 0 when n is negative; 2^14 stands for all that are
// more. size > 0.
function [14:0] steps_past(input [63:0] n, input [63:0] size);
    reg [63:0] rest;
    reg [13:0] quotient;
    integer i;
    begin
        rest = n;
        quotient = 14'd0;
        for (i = 13; i >= 0; i = i - 1)
            if ((rest >> i) >= size) begin
                rest = rest - (size << i);
                quotient[i] = 1'b1;
            end
        steps_past = n[63] ? 15'd0 : {1'b0, quotient} + 15'd1;
    end
endfunction

// What is left of a run when of its pixels p only those with least <= at_0 + p*growth < limit count. Differences of
// numerators and limits fit 64 bits, as both are below 2^62 in magnitude.
function [29:0] narrow(input [29:0] whole_run, input signed [63:0] at_0, input signed [63:0] growth,
                       input signed [63:0] least, input signed [63:0] limit);
    reg [14:0] first, behind;
    begin
        if (growth == 64'sd0) begin
            first = 15'd0;
            behind = at_0 >= least && at_0 < limit ? 15'h7fff : 15'd0;
        end else if (growth < 64'sd0) begin
            first = steps_past(at_0 - limit, -growth);
            behind = steps_past(at_0 - least, -growth);
        end else begin
            first = steps_past(least - at_0 - 64'sd1, growth);
            behind = steps_past(limit - at_0 - 64'sd1, growth);
        end
        narrow = {behind < whole_run[29:15] ? behind : whole_run[29:15],
                  first > whole_run[14:0] ? first : whole_run[14:0]};
    end
endfunction
