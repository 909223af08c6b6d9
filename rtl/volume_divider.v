// volume_divider.v - cuts the volume into bricks and hands on those with a fragment, in visibility order (section 3.1 and
// Figures 1, 3 and 4 of the paper; docs/timing.md, sections 2 and 3; docs/blocks/volume_divider.md).
//
//   port      way  what it is
//   brick     out  a link: a visit's brick, its number, its box in voxels, its bound in pixels and slices; fresh: a
//                  strobe in the first cycle of valid
//   report    out  status and idle
//   empty     in   skip_empty: writes, under reset, the bit of a brick that is left out
//
// Registers hold still from reset's last cycle on. brick_setup_cycles is at least 29.
//
//            +-------------------------------------------------+
//            |                                  nothing to see |
//            v                                                 |
//   tiles ──► slab ──► row ──► brick ──► BOUND ──► PROBE ──► PUSH ──► brick_*
//              ^        ^                 │ │        slice_probe
//              └────────┴──── one inward ─┘ box_bound
`include "vodr_hw.vh"
`include "status.vh"

module volume_divider #(
    parameter EMPTY_BRICKS = 1 // bricks of which skip_empty can know whether they are left out
) (
    input                    clk,
    input                    rst,

    output reg               brick_valid,
    output reg               brick_fresh,
    output reg        [47:0] brick_number,
    output reg        [15:0] brick_lo_x, brick_lo_y, brick_lo_z,
    output reg        [15:0] brick_hi_x, brick_hi_y, brick_hi_z,
    output reg        [14:0] brick_x0, brick_y0, brick_x1, brick_y1,
    output reg        [14:0] brick_k0, brick_k1,
    input                    brick_ready,

    output reg         [3:0] report_status,
    output reg               report_idle,

    input                    empty_write,
    /* verilator lint_off UNUSEDSIGNAL */ // beyond EMPTY_BRICKS
    input             [31:0] empty_address, // the brick's number
    /* verilator lint_on UNUSEDSIGNAL */
    input                    empty_data,

    // the view
    input             [15:0] dim_x, dim_y, dim_z,
    input             [14:0] width_px, height_px, slices,
    input                    perspective,
    input              [4:0] shift,
    input signed      [63:0] base_x, base_y, base_z,
    input signed      [63:0] step_u_x, step_u_y, step_u_z,
    input signed      [63:0] step_v_x, step_v_y, step_v_z,
    input signed      [63:0] step_s_x, step_s_y, step_s_z,
    input signed      [63:0] depth_first, depth_step,

    // the machine
    input              [1:0] blend,
    input                    skip_empty,
    input             [15:0] brick_setup_cycles,

    // derived from both
    input             [15:0] edge_x, edge_y, edge_z,       // of a brick, voxels
    input             [15:0] bricks_x, bricks_y, bricks_z, // along an axis
    input             [15:0] eye_x, eye_y, eye_z,          // the index that an axis is walked towards from both ends
    input              [1:0] nest_0, nest_1, nest_2,       // axes of slabs, of rows in a slab, of bricks in a row
    input             [14:0] tile_px,                      // 0: the frame is not cut into tiles
    input             [14:0] centre_x, centre_y,           // as in docs/timing.md, like all that follow
    input signed      [31:0] bound_x_m_x, bound_x_m_y, bound_x_m_z,
    input signed      [31:0] bound_y_m_x, bound_y_m_y, bound_y_m_z,
    input signed      [31:0] bound_z_m_x, bound_z_m_y, bound_z_m_z,
    input signed      [31:0] bound_k_m_x, bound_k_m_y, bound_k_m_z,
    input signed      [52:0] bound_x_lo, bound_x_hi, bound_y_lo, bound_y_hi,
    input signed      [52:0] bound_z_lo, bound_z_hi, bound_k_lo, bound_k_hi,
    input              [4:0] bound_x_fraction, bound_y_fraction, bound_k_fraction
);
    localparam [1:0] BOUND = 0, PROBE = 1, PUSH = 2, DONE = 3; // DONE: no box is left
    localparam [1:0] SLAB = 0, ROW = 1, BRICK = 2;
    localparam EMPTY_BITS = EMPTY_BRICKS > 1 ? $clog2(EMPTY_BRICKS) : 1;

    wire under = blend == `VODR_BLEND_UNDER;

    // ---- what happens in this cycle ----

    reg   [1:0] state;
    reg   [1:0] level; // of the box at hand
    reg  [15:0] step;  // of its bounding
    wire        some, found, exhausted;
    reg         empty_here;
    reg         left;  // there is a next box
    wire        left_out  = state == BOUND && step == 16'd0 && level == BRICK && skip_empty && empty_here;
    wire        bounded   = state == BOUND && step + 16'd1 == brick_setup_cycles;
    wire        candidate = level == BRICK && some;
    wire        inward    = bounded && level != BRICK && some;
    wire        push      = state == PUSH && !brick_valid;
    wire        over      = left_out || (bounded && !some) || exhausted || push; // on to the next box
    wire        moves     = over || inward;
    wire        offered   = push || (brick_valid && !brick_ready);

    always @(posedge clk)
        if (rst)
            state <= BOUND;
        else if (moves)
            state <= inward || left ? BOUND : DONE;
        else if (bounded)
            state <= PROBE;
        else if (found)
            state <= PUSH;

    always @(posedge clk)
        step <= rst || moves ? 16'd0 : step + 16'd1;

    always @(posedge clk)
        if (rst) begin
            report_status <= `STATUS_IDLE;
            report_idle   <= 1'b0;
        end else begin
            report_status <= state == DONE                 ? `STATUS_IDLE
                             : state == PUSH && brick_valid ? `STATUS_STALLED_DIVIDER : `STATUS_BUSY;
            report_idle   <= !offered && (state == DONE || (over && !left));
        end

    // ---- three loops, in each tile ----

    function [15:0] of_axis(input [1:0] axis, input [15:0] x, input [15:0] y, input [15:0] z);
        of_axis = axis == 2'd0 ? x : axis == 2'd1 ? y : z;
    endfunction

    reg  [15:0] at_0, at_1, at_2;                // turns of the loops
    reg  [14:0] tile_x0, tile_y0;
    reg  [15:0] then_0, then_1, then_2;          // in the next box
    reg  [14:0] then_x0, then_y0;
    reg   [1:0] then_level;
    wire [14:0] tile_x1 = tile_px == 15'd0 || width_px - tile_x0 < tile_px ? width_px : tile_x0 + tile_px;
    wire [14:0] tile_y1 = tile_px == 15'd0 || height_px - tile_y0 < tile_px ? height_px : tile_y0 + tile_px;
    wire        more_0  = at_0 + 16'd1 != of_axis(nest_0, bricks_x, bricks_y, bricks_z);
    wire        more_1  = at_1 + 16'd1 != of_axis(nest_1, bricks_x, bricks_y, bricks_z);
    wire        more_2  = at_2 + 16'd1 != of_axis(nest_2, bricks_x, bricks_y, bricks_z);

    always @* begin
        {then_0, then_1, then_2} = {at_0, at_1, at_2};
        {then_x0, then_y0} = {tile_x0, tile_y0};
        then_level = level;
        left = 1'b1;
        if (inward)
            then_level = level + 2'd1;
        else if (level == BRICK && more_2)
            then_2 = at_2 + 16'd1;
        else if (level != SLAB && more_1) begin
            {then_1, then_2} = {at_1 + 16'd1, 16'd0};
            then_level = ROW;
        end else begin
            {then_0, then_1, then_2} = {more_0 ? at_0 + 16'd1 : 16'd0, 32'd0};
            then_level = SLAB;
            if (!more_0) begin
                then_x0 = tile_x1 == width_px ? 15'd0 : tile_x1;
                then_y0 = tile_x1 == width_px ? tile_y1 : tile_y0;
                left = then_y0 != height_px;
            end
        end
    end

    always @(posedge clk)
        if (rst) begin
            {at_0, at_1, at_2} <= 48'd0;
            {tile_x0, tile_y0} <= 30'd0;
            level <= SLAB;
        end else if (moves) begin
            {at_0, at_1, at_2} <= {then_0, then_1, then_2};
            {tile_x0, tile_y0} <= {then_x0, then_y0};
            level <= then_level;
        end

    // ---- which brick that is, and whether it is left out ----

    // A turn's index on an axis: up to the eye's from below, then down to it from above; `under` goes away from it.
    function [15:0] brick_index(input [15:0] turn, input [15:0] bricks, input [15:0] eye, input outwards);
        reg [15:0] place;
        begin
            place = outwards ? bricks - 16'd1 - turn : turn;
            brick_index = place < eye ? place : bricks - 16'd1 + eye - place;
        end
    endfunction

    // An axis' turn.
    function [15:0] turn_of(input [1:0] axis, input [1:0] axis_0, input [1:0] axis_1, input [47:0] turns);
        turn_of = axis == axis_0 ? turns[47:32] : axis == axis_1 ? turns[31:16] : turns[15:0];
    endfunction

    reg  [15:0] index_x, index_y, index_z;
    reg  [47:0] number;
    wire [47:0] turns = rst ? 48'd0 : {then_0, then_1, then_2};
    reg  [15:0] then_x, then_y, then_z;
    reg  [47:0] then_number;
    reg         empty_bricks [0:EMPTY_BRICKS-1];

    always @* begin
        {then_x, then_y, then_z} = 48'd0;
        then_number = 48'd0;
        if (rst || moves) begin
            then_x = brick_index(turn_of(2'd0, nest_0, nest_1, turns), bricks_x, eye_x, under);
            then_y = brick_index(turn_of(2'd1, nest_0, nest_1, turns), bricks_y, eye_y, under);
            then_z = brick_index(turn_of(2'd2, nest_0, nest_1, turns), bricks_z, eye_z, under);
            then_number = ({32'd0, then_z} * {32'd0, bricks_y} + {32'd0, then_y}) * {32'd0, bricks_x} + {32'd0, then_x};
        end
    end

    always @(posedge clk)
        if (rst || moves) begin
            {index_x, index_y, index_z} <= {then_x, then_y, then_z};
            number <= then_number;
        end

    always @(posedge clk)
        if (moves && skip_empty)
            empty_here <= empty_bricks[then_number[EMPTY_BITS-1:0]];

    always @(posedge clk)
        if (empty_write)
            empty_bricks[empty_address[EMPTY_BITS-1:0]] <= empty_data;

    // ---- its box: a slab and a row have all bricks of the loops within ----

    function [15:0] lower(input whole, input [15:0] brick, input [15:0] side);
        lower = whole ? 16'd0 : brick * side;
    endfunction

    function [15:0] upper(input whole, input [15:0] brick, input [15:0] side, input [15:0] dim);
        reg [15:0] from;
        begin
            from = brick * side;
            upper = whole || dim - from < side ? dim : from + side;
        end
    endfunction

    reg  [15:0] lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
    wire        whole_x = level == SLAB ? nest_0 != 2'd0 : level == ROW && nest_2 == 2'd0;
    wire        whole_y = level == SLAB ? nest_0 != 2'd1 : level == ROW && nest_2 == 2'd1;
    wire        whole_z = level == SLAB ? nest_0 != 2'd2 : level == ROW && nest_2 == 2'd2;

    always @(posedge clk)
        if (state == BOUND && step == 16'd0) begin
            lo_x <= lower(whole_x, index_x, edge_x);
            lo_y <= lower(whole_y, index_y, edge_y);
            lo_z <= lower(whole_z, index_z, edge_z);
            hi_x <= upper(whole_x, index_x, edge_x, dim_x);
            hi_y <= upper(whole_y, index_y, edge_y, dim_y);
            hi_z <= upper(whole_z, index_z, edge_z, dim_z);
        end

    // ---- its bound ----

    wire [14:0] x0, y0, x1, y1, k0, k1;
    wire  [4:0] bound_step = state == BOUND && step < 16'd32 ? step[4:0] : 5'd0;

    box_bound box_bound (
        .clk(clk), .step(bound_step), .perspective(perspective), .slices(slices),
        .centre_x(centre_x), .centre_y(centre_y),
        .lo_x(lo_x), .lo_y(lo_y), .lo_z(lo_z), .hi_x(hi_x), .hi_y(hi_y), .hi_z(hi_z),
        .clip_x0(tile_x0), .clip_y0(tile_y0), .clip_x1(tile_x1), .clip_y1(tile_y1),
        .bound_x_m_x(bound_x_m_x), .bound_x_m_y(bound_x_m_y), .bound_x_m_z(bound_x_m_z),
        .bound_y_m_x(bound_y_m_x), .bound_y_m_y(bound_y_m_y), .bound_y_m_z(bound_y_m_z),
        .bound_z_m_x(bound_z_m_x), .bound_z_m_y(bound_z_m_y), .bound_z_m_z(bound_z_m_z),
        .bound_k_m_x(bound_k_m_x), .bound_k_m_y(bound_k_m_y), .bound_k_m_z(bound_k_m_z),
        .bound_x_lo(bound_x_lo), .bound_x_hi(bound_x_hi), .bound_y_lo(bound_y_lo), .bound_y_hi(bound_y_hi),
        .bound_z_lo(bound_z_lo), .bound_z_hi(bound_z_hi), .bound_k_lo(bound_k_lo), .bound_k_hi(bound_k_hi),
        .bound_x_fraction(bound_x_fraction), .bound_y_fraction(bound_y_fraction),
        .bound_k_fraction(bound_k_fraction),
        .x0(x0), .y0(y0), .x1(x1), .y1(y1), .k0(k0), .k1(k1), .some(some));

    // ---- its first fragment: the first slices are made ready while the bounding lasts ----

    slice_probe slice_probe (
        .clk(clk), .begins(bound_step == 5'd26 && candidate),
        .shift_in((bound_step == 5'd27 || bound_step == 5'd28) && candidate), .probing(state == PROBE),
        .found(found), .exhausted(exhausted),
        .lo_x(lo_x), .lo_y(lo_y), .lo_z(lo_z), .hi_x(hi_x), .hi_y(hi_y), .hi_z(hi_z),
        .x0(x0), .y0(y0), .x1(x1), .y1(y1), .k0(k0), .k1(k1),
        .under(under), .perspective(perspective), .shift(shift),
        .base_x(base_x), .base_y(base_y), .base_z(base_z),
        .step_u_x(step_u_x), .step_u_y(step_u_y), .step_u_z(step_u_z),
        .step_v_x(step_v_x), .step_v_y(step_v_y), .step_v_z(step_v_z),
        .step_s_x(step_s_x), .step_s_y(step_s_y), .step_s_z(step_s_z),
        .depth_first(depth_first), .depth_step(depth_step));

    // ---- the link ----

    always @(posedge clk)
        if (rst) begin
            brick_valid <= 1'b0;
            brick_fresh <= 1'b0;
        end else begin
            brick_valid <= offered;
            brick_fresh <= push;
        end

    always @(posedge clk)
        if (push) begin
            brick_number <= number;
            {brick_lo_x, brick_lo_y, brick_lo_z} <= {lo_x, lo_y, lo_z};
            {brick_hi_x, brick_hi_y, brick_hi_z} <= {hi_x, hi_y, hi_z};
            {brick_x0, brick_y0, brick_x1, brick_y1} <= {x0, y0, x1, y1};
            {brick_k0, brick_k1} <= {k0, k1};
        end
endmodule
