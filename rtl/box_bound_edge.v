// box_bound_edge.v - one edge of a box's bound: its first pixel or slice on an axis, or the one behind the last
// (docs/timing.md, section 2), from a row's sum at the box. Part of box_bound.
//
//   take                sum is this edge's; without `perspective` that does it
//   divide              up for 16 cycles then: a bit of the quotient each
//   finish              the quotient's edge
//   sum, fraction       of a row
//   nearest, farthest   least and greatest depth of the box; the edge is centre + sum over one of them
//   from, to            which the edge is cut to
//
//   sum >> fraction ------------------------------------------------> cut --> edge_px
//   sum --> |sum| --> rest, tail --+--> rest >= divisor --> quotient --^
//                        ^         v
//                        +---- shift, subtract
module box_bound_edge #(
    parameter END = 0 // 0: the first, 1: the one behind the last
) (
    input                    clk,
    input                    take,
    input                    divide,
    input                    finish,
    input                    perspective,
    input signed      [52:0] sum,
    input              [4:0] fraction,
    input signed      [52:0] nearest,
    input             [50:0] farthest, // positive where nearest is
    input             [14:0] centre,
    input             [14:0] from, to,
    output reg        [14:0] edge_px
);
    // Also of slices: at least `from`, at most `to`.
    function [14:0] cut(input signed [52:0] value, input [14:0] least, input [14:0] most);
        if (value <= $signed({38'd0, least}))
            cut = least;
        else if (value >= $signed({38'd0, most}))
            cut = most;
        else
            cut = value[14:0];
    endfunction

    // Quotients are cut off towards zero, and then the first is what is not below, the end what is above: with n the
    // sum, less one for the first, that is n/divisor + 1 where n is not negative, else -(-1-n)/divisor.
    wire signed [52:0] n = END != 0 ? sum : sum - 53'sd1;

    reg         minus;    // n is negative
    reg  [51:0] rest;     // what is left of the numerator's bits up to the quotient's bit at hand
    reg  [14:0] tail;     // those below
    reg  [15:0] quotient; // 2^15 and more is beyond any frame
    wire [50:0] divisor = minus == (END != 0) ? farthest : nearest[50:0];
    wire        fits    = divide && rest >= {1'b0, divisor};
    wire [50:0] left    = rest[50:0] - (fits ? divisor : 51'd0);

    always @(posedge clk)
        if (take && perspective) begin
            minus <= n[52];
            rest <= {15'd0, n[51:15] ^ {37{n[52]}}};
            tail <= n[14:0] ^ {15{n[52]}};
        end else if (divide) begin
            rest <= {left, tail[14]};
            tail <= {tail[13:0], 1'b0};
            quotient <= {quotient[14:0], fits};
        end

    wire signed [52:0] distance = minus ? -$signed({37'd0, quotient}) : $signed({37'd0, quotient}) + 53'sd1;

    always @(posedge clk)
        if (take && !perspective)
            edge_px <= cut(sum >>> fraction, from, to);
        else if (finish && nearest <= 53'sd0)
            edge_px <= END != 0 ? to : from;
        else if (finish)
            edge_px <= cut($signed({38'd0, centre}) + distance, from, to);
endmodule
