// rasterizer.v - the fragments of a slice: runs of pixels, row by row from the top, left to right (Figure 2 of the
// paper; docs/architecture.md, section 3; docs/timing.md, section 5).
//
//   port      way  what it is
//   slice     in   link: a slice's plane, the brick's borders as limits of its numerators, its bound on the screen;
//                  last: of its visit
//   fragment  out  link: a pixel, and the numerators of its position; strobe visit_done: the visit's last row was gone
//                  through; in: ready, and loading: it is not because the brick is not loaded
//   report    out  status and idle
//
//   slice ──► narrow rows by each axis without step_u ──► y0, origin + y0*step_v ──┐
//                                                                                  ▼
//             row: y, numerators at x = 0 ──► y + 1, numerators + step_v ────────► a row begins: at the pop,
//               ▲                                                                  │ and when one is done
//               └──────────────────────────────────────────────────────────────────┤
//                    ┌─────────────────────────────────────────────────────────────┘
//                    ▼
//             narrow its run by each axis ──► first x, numerators + x*step_u ──► fragment ──┐ accepted:
//                                                                                   ▲      │ x + 1, numerators + step_u
//                                                                                   └──────┘
`include "status.vh"

module rasterizer (
    input clk,
    input rst,

    input slice_valid,
    input slice_last,
    input signed [63:0] slice_origin_x, slice_origin_y, slice_origin_z,
    input signed [63:0] slice_step_u_x, slice_step_u_y, slice_step_u_z,
    input signed [63:0] slice_step_v_x, slice_step_v_y, slice_step_v_z,
    input signed [63:0] slice_lo_x, slice_lo_y, slice_lo_z,
    input signed [63:0] slice_hi_x, slice_hi_y, slice_hi_z,
    input [14:0] slice_x0, slice_y0, slice_x1, slice_y1,
    output reg slice_ready,

    output reg fragment_valid,
    output reg fragment_visit_done,
    output reg [14:0] fragment_x, fragment_y,
    output reg signed [63:0] fragment_a_x, fragment_a_y, fragment_a_z,
    input fragment_ready,
    input fragment_loading,

    output reg [3:0] report_status,
    output reg report_idle
);
    `include "slice_rows.vh"

    // A numerator so many steps on.
    function [63:0] at;
        input [63:0] at_0;
        input [63:0] growth;
        input [14:0] steps;
        at = at_0 + growth * {49'd0, steps};
    endfunction

    // ---- what happens in this cycle ----

    reg [14:0] x_end, y1; // behind the last pixel of the row, the last row of the slice
    wire rastering = !slice_ready; // row fragment_y is at hand; it has fragments if one is offered
    wire accepted = fragment_valid && fragment_ready;
    wire pop = slice_ready && slice_valid;
    wire row_done = rastering && (!fragment_valid || (accepted && fragment_x + 15'd1 == x_end));

    always @(posedge clk)
        if (rst || !(rastering || slice_valid))
            report_status <= `STATUS_IDLE;
        else if (fragment_valid && !fragment_ready)
            report_status <= fragment_loading ? `STATUS_STALLED_TEXTURE_LOAD : `STATUS_STALLED_FRAGMENT_FIFO;
        else
            report_status <= `STATUS_BUSY;

    // ---- the slice at hand ----

    reg last;
    reg [14:0] x0, x1; // columns of its bound
    reg signed [63:0] step_u_x, step_u_y, step_u_z;
    reg signed [63:0] step_v_x, step_v_y, step_v_z;
    reg signed [63:0] lo_x, lo_y, lo_z;
    reg signed [63:0] hi_x, hi_y, hi_z;

    always @(posedge clk)
        if (pop) begin
            last <= slice_last;
            {x0, x1} <= {slice_x0, slice_x1};
            {step_u_x, step_u_y, step_u_z} <= {slice_step_u_x, slice_step_u_y, slice_step_u_z};
            {step_v_x, step_v_y, step_v_z} <= {slice_step_v_x, slice_step_v_y, slice_step_v_z};
            {lo_x, lo_y, lo_z} <= {slice_lo_x, slice_lo_y, slice_lo_z};
            {hi_x, hi_y, hi_z} <= {slice_hi_x, slice_hi_y, slice_hi_z};
        end

    // ---- a row begins: at the pop, and when the row at hand is done ----

    reg signed [63:0] row_a_x, row_a_y, row_a_z; // numerators at x = 0

    always @(posedge clk) begin : row
        reg [29:0] rows, run; // as in slice_rows.vh: rows that are left, from this one on; its fragments
        reg [63:0] a_x, a_y, a_z;
        if (rst) begin
            slice_ready <= 1'b1;
            fragment_valid <= 1'b0;
            fragment_visit_done <= 1'b0;
            report_idle <= 1'b1;
        end else if (pop || row_done) begin
            rows = {y1, fragment_y + 15'd1};
            {a_x, a_y, a_z} = {row_a_x + step_v_x, row_a_y + step_v_y, row_a_z + step_v_z};
            if (pop) begin
                rows = {slice_y1, slice_y0};
                if (slice_step_u_x == 0)
                    rows = narrow(rows, slice_origin_x, slice_step_v_x, slice_lo_x, slice_hi_x);
                if (slice_step_u_y == 0)
                    rows = narrow(rows, slice_origin_y, slice_step_v_y, slice_lo_y, slice_hi_y);
                if (slice_step_u_z == 0)
                    rows = narrow(rows, slice_origin_z, slice_step_v_z, slice_lo_z, slice_hi_z);
                a_x = at(slice_origin_x, slice_step_v_x, rows[14:0]);
                a_y = at(slice_origin_y, slice_step_v_y, rows[14:0]);
                a_z = at(slice_origin_z, slice_step_v_z, rows[14:0]);
            end
            run = pop ? {slice_x1, slice_x0} : {x1, x0};
            if (rows[14:0] < rows[29:15]) begin
                run = narrow(run, a_x, pop ? slice_step_u_x : step_u_x,
                             pop ? slice_lo_x : lo_x, pop ? slice_hi_x : hi_x);
                run = narrow(run, a_y, pop ? slice_step_u_y : step_u_y,
                             pop ? slice_lo_y : lo_y, pop ? slice_hi_y : hi_y);
                run = narrow(run, a_z, pop ? slice_step_u_z : step_u_z,
                             pop ? slice_lo_z : lo_z, pop ? slice_hi_z : hi_z);
                fragment_valid <= run[14:0] < run[29:15];
                fragment_visit_done <= 1'b0;
                {slice_ready, report_idle} <= 2'b00;
            end else begin
                fragment_valid <= 1'b0;
                fragment_visit_done <= pop ? slice_last : last;
                {slice_ready, report_idle} <= 2'b11;
            end
            {y1, fragment_y} <= rows;
            {x_end, fragment_x} <= run;
            {row_a_x, row_a_y, row_a_z} <= {a_x, a_y, a_z};
            fragment_a_x <= at(a_x, pop ? slice_step_u_x : step_u_x, run[14:0]);
            fragment_a_y <= at(a_y, pop ? slice_step_u_y : step_u_y, run[14:0]);
            fragment_a_z <= at(a_z, pop ? slice_step_u_z : step_u_z, run[14:0]);
        end else begin
            fragment_visit_done <= 1'b0;
            if (accepted) begin
                fragment_x <= fragment_x + 15'd1;
                fragment_a_x <= fragment_a_x + step_u_x;
                fragment_a_y <= fragment_a_y + step_u_y;
                fragment_a_z <= fragment_a_z + step_u_z;
            end
        end
    end
endmodule
