// slice_probe.v - looks for the first fragment of a candidate, a row of a slice a cycle (docs/timing.md, section 3). Part
// of volume_divider.
//
//   begins            the candidate is known: the box lo_*, hi_*, its bound x0 .. k1
//   shift_in          up for two cycles then: slices move up, and the first is at hand
//   probing           a row is looked at
//   found, exhausted  it has a fragment; it has none, and no row is left
//   under             the nearest slice comes first
//   perspective .. depth_step    registers of that name
//
// A slice without a row takes a cycle too: so none can be faster than those behind it, which are made ready meanwhile.
//
//            +-------+     +-------------------------+     +----------------------+
//   k0, k1 ->| k --> |---->| its plane --> the rows  |---->| numerators, row by   |--> found
//            | depth |     | where axes without      |     | row --> its run of   |
//            +-------+     | step_u are in the box   |     | pixels               |
//                          +-------------------------+     +----------------------+
//             behind the next slice     the next slice        the slice at hand
module slice_probe (
    input                    clk,
    input                    begins,
    input                    shift_in,
    input                    probing,
    output                   found,
    output                   exhausted,

    input             [15:0] lo_x, lo_y, lo_z, hi_x, hi_y, hi_z,
    input             [14:0] x0, y0, x1, y1, k0, k1,

    input                    under,
    input                    perspective,
    input              [4:0] shift,
    input signed      [63:0] base_x, base_y, base_z,
    input signed      [63:0] step_u_x, step_u_y, step_u_z,
    input signed      [63:0] step_v_x, step_v_y, step_v_z,
    input signed      [63:0] step_s_x, step_s_y, step_s_z,
    input signed      [63:0] depth_first, depth_step
);
    `include "slice_plane.vh"
    `include "slice_rows.vh"

    // ---- which slice ----

    wire next_slice; // the slice at hand is done
    wire moves = shift_in || next_slice;

    reg [14:0] k;           // behind the next slice
    reg [23:0] z;           // its depth
    reg [14:0] slices_left; // with the slice at hand
    wire [14:0] k_then = begins ? (under ? k1 - 15'd1 : k0) : under ? k - 15'd1 : k + 15'd1;

    always @(posedge clk)
        if (begins || moves) begin
            k <= k_then;
            if (perspective)
                z <= slice_depth(depth_first, depth_step, k_then);
        end

    always @(posedge clk)
        if (begins)
            slices_left <= k1 - k0;
        else if (next_slice)
            slices_left <= slices_left - 15'd1;

    // ---- the box's borders ----

    reg signed [63:0] least_x, least_y, least_z, limit_x, limit_y, limit_z;

    always @(posedge clk)
        if (begins) begin
            least_x <= border_of(lo_x, base_x, shift);
            least_y <= border_of(lo_y, base_y, shift);
            least_z <= border_of(lo_z, base_z, shift);
            limit_x <= border_of(hi_x, base_x, shift);
            limit_y <= border_of(hi_y, base_y, shift);
            limit_z <= border_of(hi_z, base_z, shift);
        end

    // ---- the next slice ----

    reg signed [63:0] next_a_x, next_a_y, next_a_z; // its origin
    reg signed [63:0] next_u_x, next_u_y, next_u_z;
    reg signed [63:0] next_v_x, next_v_y, next_v_z;
    reg [29:0] next_rows; // {end, first}

    always @(posedge clk) begin : plane
        reg signed [63:0] a_x, a_y, a_z, v_x, v_y, v_z;
        reg [29:0] rows;
        if (moves) begin
            a_x = slice_origin(perspective, z, k, step_s_x);
            a_y = slice_origin(perspective, z, k, step_s_y);
            a_z = slice_origin(perspective, z, k, step_s_z);
            v_x = slice_step(perspective, z, step_v_x);
            v_y = slice_step(perspective, z, step_v_y);
            v_z = slice_step(perspective, z, step_v_z);
            rows = {y1, y0};
            if (step_u_x == 64'sd0)
                rows = narrow(rows, a_x, v_x, least_x, limit_x);
            if (step_u_y == 64'sd0)
                rows = narrow(rows, a_y, v_y, least_y, limit_y);
            if (step_u_z == 64'sd0)
                rows = narrow(rows, a_z, v_z, least_z, limit_z);
            next_rows <= rows;
            next_a_x <= a_x;
            next_a_y <= a_y;
            next_a_z <= a_z;
            next_v_x <= v_x;
            next_v_y <= v_y;
            next_v_z <= v_z;
            next_u_x <= slice_step(perspective, z, step_u_x);
            next_u_y <= slice_step(perspective, z, step_u_y);
            next_u_z <= slice_step(perspective, z, step_u_z);
        end
    end

    // ---- the slice at hand, row by row ----

    reg signed [63:0] a_x, a_y, a_z; // at x = 0 of this row
    reg signed [63:0] u_x, u_y, u_z, v_x, v_y, v_z;
    reg [14:0] row, rows_end;
    wire some_row = row < rows_end;
    wire last_row = !some_row || row + 15'd1 == rows_end;

    always @(posedge clk)
        if (moves) begin
            {rows_end, row} <= next_rows;
            u_x <= next_u_x;
            u_y <= next_u_y;
            u_z <= next_u_z;
            v_x <= next_v_x;
            v_y <= next_v_y;
            v_z <= next_v_z;
            a_x <= next_a_x + next_v_x * $signed({49'd0, next_rows[14:0]});
            a_y <= next_a_y + next_v_y * $signed({49'd0, next_rows[14:0]});
            a_z <= next_a_z + next_v_z * $signed({49'd0, next_rows[14:0]});
        end else if (probing) begin
            row <= row + 15'd1;
            a_x <= a_x + v_x;
            a_y <= a_y + v_y;
            a_z <= a_z + v_z;
        end

    reg [29:0] run; // {end, first}

    always @* begin
        run = 30'd0;
        if (probing && some_row) begin
            run = narrow({x1, x0}, a_x, u_x, least_x, limit_x);
            run = narrow(run, a_y, u_y, least_y, limit_y);
            run = narrow(run, a_z, u_z, least_z, limit_z);
        end
    end

    assign found = run[14:0] < run[29:15];
    assign next_slice = probing && !found && last_row;
    assign exhausted = next_slice && slices_left == 15'd1;
endmodule
