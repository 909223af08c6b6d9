// slice_generator.v - cuts a brick into slices, planes parallel to the image (section 3.2 and Figure 2 of the paper;
// docs/timing.md, section 4).
//
//   port    way  what it is
//   brick   in   link: a brick's borders in voxels, its bound on the screen, slices k0 to k1-1
//   slice   out  link: a slice's plane, the brick's borders as limits of its numerators, the bound
//   report  out  status and idle
//
//   brick_k0, k1 ──► k ──┬──► z(k) ──► z ──┬─► z*step_s, z*step_u, z*step_v ──► slice_origin, step_u, step_v
//                    ▲   │   at the end    │   parallel: k*step_s
//                    +1  │   of set-up     │   when the slice is pushed
//                        └─────────────────┘
//   brick_lo, hi ──► box ────────────────────► (box - base) << shift ─────────► slice_lo, hi
//   brick_x0..y1 ──► bound ───────────────────────────────────────────────────► slice_x0..y1
`include "vodr_hw.vh"
`include "status.vh"

module slice_generator (
    input clk,
    input rst,

    input brick_valid,
    input [15:0] brick_lo_x, brick_lo_y, brick_lo_z,
    input [15:0] brick_hi_x, brick_hi_y, brick_hi_z,
    input [14:0] brick_x0, brick_y0, brick_x1, brick_y1,
    input [14:0] brick_k0, brick_k1,
    output reg brick_ready,

    output reg slice_valid,
    output reg slice_last,
    output reg [14:0] slice_k,
    output reg signed [63:0] slice_origin_x, slice_origin_y, slice_origin_z,
    output reg signed [63:0] slice_step_u_x, slice_step_u_y, slice_step_u_z,
    output reg signed [63:0] slice_step_v_x, slice_step_v_y, slice_step_v_z,
    output reg signed [63:0] slice_lo_x, slice_lo_y, slice_lo_z,
    output reg signed [63:0] slice_hi_x, slice_hi_y, slice_hi_z,
    output reg [14:0] slice_x0, slice_y0, slice_x1, slice_y1,
    input slice_ready,

    output reg [3:0] report_status,
    output reg report_idle,

    input [1:0] blend,
    input perspective,
    input [4:0] shift,
    input signed [63:0] base_x, base_y, base_z,
    input signed [63:0] step_u_x, step_u_y, step_u_z,
    input signed [63:0] step_v_x, step_v_y, step_v_z,
    input signed [63:0] step_s_x, step_s_y, step_s_z,
    input signed [63:0] depth_first, depth_step,
    input [15:0] slice_setup_cycles
);
    `include "slice_plane.vh"

    // ---- what happens in this cycle ----

    reg [15:0] setup_left; // cycles of work on slice k
    reg [14:0] k, k_behind; // the slice at hand, and the one behind the last
    wire under = blend == `VODR_BLEND_UNDER;
    wire [14:0] k_next = under ? k - 15'd1 : k + 15'd1;
    wire generating = !brick_ready; // slice k is to be pushed
    wire ready_to_push = generating && setup_left == 0;
    wire pop = brick_ready && brick_valid;
    wire push = ready_to_push && !slice_valid;
    wire more = pop ? brick_k0 != brick_k1 : generating && !(push && k_next == k_behind);
    wire offer = push || (slice_valid && !slice_ready);

    always @(posedge clk)
        if (rst) begin
            brick_ready <= 1'b1;
            slice_valid <= 1'b0;
            report_idle <= 1'b1;
        end else begin
            brick_ready <= !more;
            slice_valid <= offer;
            report_idle <= !more && !offer;
        end

    always @(posedge clk)
        if (rst || (brick_ready && !brick_valid))
            report_status <= `STATUS_IDLE;
        else
            report_status <= ready_to_push && slice_valid ? `STATUS_STALLED_SLICE : `STATUS_BUSY;

    // ---- the brick ----

    reg [15:0] lo_x, lo_y, lo_z, hi_x, hi_y, hi_z;
    reg [14:0] x0, y0, x1, y1;

    always @(posedge clk)
        if (pop) begin
            {lo_x, lo_y, lo_z} <= {brick_lo_x, brick_lo_y, brick_lo_z};
            {hi_x, hi_y, hi_z} <= {brick_hi_x, brick_hi_y, brick_hi_z};
            {x0, y0, x1, y1} <= {brick_x0, brick_y0, brick_x1, brick_y1};
        end

    always @(posedge clk)
        if (pop) begin
            k <= under ? brick_k1 - 15'd1 : brick_k0;
            k_behind <= under ? brick_k0 - 15'd1 : brick_k1;
        end else if (push)
            k <= k_next;

    // ---- work on a slice: its depth at the end of the set-up, the rest when it is pushed ----

    reg [23:0] z;

    always @(posedge clk)
        if (pop || push)
            setup_left <= slice_setup_cycles;
        else if (setup_left != 0)
            setup_left <= setup_left - 16'd1;

    always @(posedge clk)
        if (perspective && setup_left == 16'd1)
            z <= slice_depth(depth_first, depth_step, k);

    always @(posedge clk)
        if (push) begin
            slice_last <= k_next == k_behind;
            slice_k <= k;
            slice_origin_x <= slice_origin(perspective, z, k, step_s_x);
            slice_origin_y <= slice_origin(perspective, z, k, step_s_y);
            slice_origin_z <= slice_origin(perspective, z, k, step_s_z);
            slice_step_u_x <= slice_step(perspective, z, step_u_x);
            slice_step_u_y <= slice_step(perspective, z, step_u_y);
            slice_step_u_z <= slice_step(perspective, z, step_u_z);
            slice_step_v_x <= slice_step(perspective, z, step_v_x);
            slice_step_v_y <= slice_step(perspective, z, step_v_y);
            slice_step_v_z <= slice_step(perspective, z, step_v_z);
            slice_lo_x <= border_of(lo_x, base_x, shift);
            slice_lo_y <= border_of(lo_y, base_y, shift);
            slice_lo_z <= border_of(lo_z, base_z, shift);
            slice_hi_x <= border_of(hi_x, base_x, shift);
            slice_hi_y <= border_of(hi_y, base_y, shift);
            slice_hi_z <= border_of(hi_z, base_z, shift);
            {slice_x0, slice_y0, slice_x1, slice_y1} <= {x0, y0, x1, y1};
        end
endmodule
