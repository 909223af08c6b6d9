// vodr_top.v - the machine: seven blocks and what lies between them (Figure 2 of the paper). Everything is in the blocks;
// here are wires, named as the ports are (docs/cosimulation.md).
//
//   volume_divider ─brick─► slice_generator ─slice─► rasterizer ─fragment─► texture_unit ─colour─► pixel_cache
//         └───────────brick─────────────────────────────────────────────────►  │   ▲                 ▲ │    ▲ │
//                                                                         load ▼   │ load    blended │ ▼ pixel
//   external memory ◄── memory ──► frame_buffer ◄───────────────────────────────────┘          alpha_blender │
//                                      ▲  └─────────────── filled, written ─────────────────────────────►    │
//                                      └────────────────── fill, write ──────────────────────────────────────┘
//
// Registers and tables are taken over while rst is up. A frame is drawn when all seven blocks are idle.
`include "vodr_hw.vh"

module vodr_top #(
    parameter DENSITY_BITS       = `VODR_DEFAULT_DENSITY_BITS,
    parameter WEIGHT_BITS        = `VODR_DEFAULT_WEIGHT_BITS,
    parameter GUARD_BITS         = `VODR_DEFAULT_GUARD_BITS,
    parameter FB_BITS            = `VODR_DEFAULT_FB_BITS,
    parameter LINE_W             = 16,
    parameter LINE_H             = 1,
    parameter CACHE_BYTES        = `VODR_DEFAULT_CACHE_BYTES,
    parameter WAYS               = `VODR_DEFAULT_WAYS,
    parameter NONBLOCKING        = `VODR_DEFAULT_NONBLOCKING,
    parameter NONBLOCKING_FIFO   = `VODR_DEFAULT_NONBLOCKING_FIFO,
    parameter NONBLOCKING_MISSES = `VODR_DEFAULT_NONBLOCKING_MISSES,
    parameter WRITE_FIFO         = `VODR_DEFAULT_WRITE_FIFO,
    parameter BLEND_CYCLES       = `VODR_DEFAULT_BLEND_CYCLES,
    parameter MEM_BUS_BYTES      = `VODR_DEFAULT_MEM_BUS_BYTES,
    parameter BEAT_BYTES         = MEM_BUS_BYTES,
    parameter TEXTURE_BYTES      = `VODR_DEFAULT_TEXTURE_MEMORY_BYTES / 2,
    parameter FRAGMENT_ROOM      = `VODR_DEFAULT_FRAGMENT_FIFO,
    parameter EMPTY_BRICKS       = 1,
    parameter FRAME_LINES        = 1
) (
    input                                clk,
    input                                rst,

    // the view
    input                         [15:0] dim_x, dim_y, dim_z,
    input                         [14:0] width_px, height_px, slices,
    input                                perspective,
    input                          [4:0] shift,
    input  signed                 [63:0] base_x, base_y, base_z,
    input  signed                 [63:0] step_u_x, step_u_y, step_u_z,
    input  signed                 [63:0] step_v_x, step_v_y, step_v_z,
    input  signed                 [63:0] step_s_x, step_s_y, step_s_z,
    input  signed                 [63:0] depth_first, depth_step,

    // the machine
    input                          [1:0] blend,
    input                                filter,
    input                          [1:0] traversal,
    input                                double_buffer,
    input                                skip_empty,
    input                                index,
    input                          [1:0] replacement,
    input                                write_policy,
    input                                clear_on_first_touch,
    input                                fb_layout,
    input                         [15:0] brick_setup_cycles, slice_setup_cycles,
    input                          [7:0] texture_latency_cycles,
    input                                memory,
    input                         [15:0] mem_latency_cycles,
    input                         [12:0] texture_burst_bytes,
    input                          [6:0] dram_banks,
    input                         [16:0] dram_row_bytes,
    input                          [7:0] dram_trcd_cycles, dram_tcas_cycles, dram_trp_cycles,
    input                         [19:0] dram_refresh_cycles,
    input                         [15:0] dram_trfc_cycles,

    // derived from both (docs/timing.md, section 2)
    input                         [15:0] edge_x, edge_y, edge_z,
    input                         [15:0] bricks_x, bricks_y, bricks_z,
    input                         [15:0] eye_x, eye_y, eye_z,
    input                          [1:0] nest_0, nest_1, nest_2,
    input                         [14:0] tile_px,
    input                         [14:0] centre_x, centre_y,
    input  signed                 [31:0] bound_x_m_x, bound_x_m_y, bound_x_m_z,
    input  signed                 [31:0] bound_y_m_x, bound_y_m_y, bound_y_m_z,
    input  signed                 [31:0] bound_z_m_x, bound_z_m_y, bound_z_m_z,
    input  signed                 [31:0] bound_k_m_x, bound_k_m_y, bound_k_m_z,
    input  signed                 [52:0] bound_x_lo, bound_x_hi, bound_y_lo, bound_y_hi,
    input  signed                 [52:0] bound_z_lo, bound_z_hi, bound_k_lo, bound_k_hi,
    input                          [4:0] bound_x_fraction, bound_y_fraction, bound_k_fraction,
    input                         [15:0] lines_across,
    input                         [47:0] texture_base,
    input                         [47:0] brick_room_bytes,

    // tables, loaded while rst is up
    input                                table_write,
    input                         [11:0] table_address,
    input                  [4*FB_BITS:0] table_data,
    input                                empty_write,
    input                         [31:0] empty_address,
    input                                empty_data,

    // the external memory behind the frame buffer
    output                               memory_read, memory_write,
    output                        [47:0] memory_address,
    output                         [8:0] memory_write_bytes,
    output         [8*MEM_BUS_BYTES-1:0] memory_write_data,
    input          [8*MEM_BUS_BYTES-1:0] memory_read_data,

    // the external memory of `whole`
    output                               fetch_valid,
    output                        [15:0] fetch_lo_x, fetch_lo_y, fetch_lo_z,
    output                        [15:0] fetch_hi_x, fetch_hi_y, fetch_hi_z,
    input                                voxels_valid,
    input                        [127:0] voxels_density,

    // what counters listen to
    output                               brick_valid, brick_fresh, brick_ready,
    output                        [47:0] brick_number,
    output                        [15:0] brick_lo_x, brick_lo_y, brick_lo_z,
    output                        [15:0] brick_hi_x, brick_hi_y, brick_hi_z,
    output                        [14:0] brick_x0, brick_y0, brick_x1, brick_y1,
    output                               slice_valid, slice_ready,
    output                        [14:0] slice_k,
    output                               fragment_valid, fragment_ready, fragment_visit_done,
    output                        [14:0] fragment_x, fragment_y,
    output                               load_valid, load_ready,
    output                        [31:0] load_bytes,
    output                               colour_valid, colour_ready, colour_gone,
    output                               look_up_valid, look_up_miss, look_up_replaced,
    output                        [14:0] look_up_x, look_up_y,
    output                               pixel_valid,
    output                               blended_valid, blended_writes,
    output                               fill_valid, write_valid,
    output                        [13:0] write_bytes,
    output                         [3:0] volume_divider_status,
    output                         [3:0] slice_generator_status,
    output                         [3:0] rasterizer_status,
    output                         [3:0] texture_unit_status,
    output                         [3:0] alpha_blender_status,
    output                         [3:0] pixel_cache_status,
    output                         [3:0] frame_buffer_status,
    output                               volume_divider_idle, slice_generator_idle, rasterizer_idle, texture_unit_idle,
    output                               alpha_blender_idle, pixel_cache_idle, frame_buffer_idle
);
    // ---- registers: taken over while rst is up, so that nothing follows from an input without a register between ----

    reg [2291:0] held;
    wire [15:0] held_dim_x, held_dim_y, held_dim_z, held_brick_setup_cycles, held_slice_setup_cycles,
                held_mem_latency_cycles, held_dram_trfc_cycles, held_edge_x, held_edge_y, held_edge_z, held_bricks_x,
                held_bricks_y, held_bricks_z, held_eye_x, held_eye_y, held_eye_z, held_lines_across;
    wire [14:0] held_width_px, held_height_px, held_slices, held_tile_px, held_centre_x, held_centre_y;
    wire held_perspective, held_filter, held_double_buffer, held_skip_empty, held_index, held_write_policy,
         held_clear_on_first_touch, held_fb_layout, held_memory;
    wire [4:0] held_shift, held_bound_x_fraction, held_bound_y_fraction, held_bound_k_fraction;
    wire signed [63:0] held_base_x, held_base_y, held_base_z, held_step_u_x, held_step_u_y, held_step_u_z,
                       held_step_v_x, held_step_v_y, held_step_v_z, held_step_s_x, held_step_s_y, held_step_s_z,
                       held_depth_first, held_depth_step;
    wire [1:0] held_blend, held_traversal, held_replacement, held_nest_0, held_nest_1, held_nest_2;
    wire [7:0] held_texture_latency_cycles, held_dram_trcd_cycles, held_dram_tcas_cycles, held_dram_trp_cycles;
    wire [12:0] held_texture_burst_bytes;
    wire [6:0] held_dram_banks;
    wire [16:0] held_dram_row_bytes;
    wire [19:0] held_dram_refresh_cycles;
    wire signed [31:0] held_bound_x_m_x, held_bound_x_m_y, held_bound_x_m_z, held_bound_y_m_x, held_bound_y_m_y,
                       held_bound_y_m_z, held_bound_z_m_x, held_bound_z_m_y, held_bound_z_m_z, held_bound_k_m_x,
                       held_bound_k_m_y, held_bound_k_m_z;
    wire signed [52:0] held_bound_x_lo, held_bound_x_hi, held_bound_y_lo, held_bound_y_hi, held_bound_z_lo,
                       held_bound_z_hi, held_bound_k_lo, held_bound_k_hi;
    wire [47:0] held_texture_base, held_brick_room_bytes;

    always @(posedge clk)
        if (rst)
            held <= {
                dim_x, dim_y, dim_z, width_px, height_px, slices, perspective, shift, base_x, base_y, base_z,
                step_u_x, step_u_y, step_u_z, step_v_x, step_v_y, step_v_z, step_s_x, step_s_y, step_s_z,
                depth_first, depth_step, blend, filter, traversal, double_buffer, skip_empty, index, replacement,
                write_policy, clear_on_first_touch, fb_layout, brick_setup_cycles, slice_setup_cycles,
                texture_latency_cycles, memory, mem_latency_cycles, texture_burst_bytes, dram_banks, dram_row_bytes, dram_trcd_cycles,
                dram_tcas_cycles, dram_trp_cycles, dram_refresh_cycles, dram_trfc_cycles, edge_x, edge_y, edge_z,
                bricks_x, bricks_y, bricks_z, eye_x, eye_y, eye_z, nest_0, nest_1, nest_2, tile_px, centre_x,
                centre_y, bound_x_m_x, bound_x_m_y, bound_x_m_z, bound_y_m_x, bound_y_m_y, bound_y_m_z, bound_z_m_x,
                bound_z_m_y, bound_z_m_z, bound_k_m_x, bound_k_m_y, bound_k_m_z, bound_x_lo, bound_x_hi, bound_y_lo,
                bound_y_hi, bound_z_lo, bound_z_hi, bound_k_lo, bound_k_hi, bound_x_fraction, bound_y_fraction,
                bound_k_fraction, lines_across, texture_base, brick_room_bytes
            };

    assign {
        held_dim_x, held_dim_y, held_dim_z, held_width_px, held_height_px, held_slices, held_perspective,
        held_shift, held_base_x, held_base_y, held_base_z, held_step_u_x, held_step_u_y, held_step_u_z,
        held_step_v_x, held_step_v_y, held_step_v_z, held_step_s_x, held_step_s_y, held_step_s_z, held_depth_first,
        held_depth_step, held_blend, held_filter, held_traversal, held_double_buffer, held_skip_empty, held_index,
        held_replacement, held_write_policy, held_clear_on_first_touch, held_fb_layout, held_brick_setup_cycles,
        held_slice_setup_cycles,
        held_texture_latency_cycles, held_memory, held_mem_latency_cycles, held_texture_burst_bytes,
        held_dram_banks, held_dram_row_bytes, held_dram_trcd_cycles, held_dram_tcas_cycles, held_dram_trp_cycles,
        held_dram_refresh_cycles, held_dram_trfc_cycles, held_edge_x, held_edge_y, held_edge_z, held_bricks_x,
        held_bricks_y, held_bricks_z, held_eye_x, held_eye_y, held_eye_z, held_nest_0, held_nest_1, held_nest_2,
        held_tile_px, held_centre_x, held_centre_y, held_bound_x_m_x, held_bound_x_m_y, held_bound_x_m_z,
        held_bound_y_m_x, held_bound_y_m_y, held_bound_y_m_z, held_bound_z_m_x, held_bound_z_m_y, held_bound_z_m_z,
        held_bound_k_m_x, held_bound_k_m_y, held_bound_k_m_z, held_bound_x_lo, held_bound_x_hi, held_bound_y_lo,
        held_bound_y_hi, held_bound_z_lo, held_bound_z_hi, held_bound_k_lo, held_bound_k_hi, held_bound_x_fraction,
        held_bound_y_fraction, held_bound_k_fraction, held_lines_across, held_texture_base, held_brick_room_bytes
    } = held;

    // ---- from block to block ----

    wire [14:0] brick_k0, brick_k1, slice_x0, slice_y0, slice_x1, slice_y1, colour_x, colour_y;
    wire slice_last, fragment_loading, colour_dead, blended_known, blended_known_writes, colour_hazard, filled_valid,
         written_valid, load_granted, load_data_valid;
    wire signed [63:0] slice_origin_x, slice_origin_y, slice_origin_z, slice_step_u_x, slice_step_u_y, slice_step_u_z,
                       slice_step_v_x, slice_step_v_y, slice_step_v_z, slice_lo_x, slice_lo_y, slice_lo_z, slice_hi_x,
                       slice_hi_y, slice_hi_z, fragment_a_x, fragment_a_y, fragment_a_z;
    wire [47:0] load_address, fill_address, write_address;
    wire [4*FB_BITS-1:0] colour_rgba, blended_rgba, pixel_rgba;
    wire [4*FB_BITS*LINE_W*LINE_H-1:0] write_data;
    wire [LINE_W*LINE_H*FB_BITS*4-1:0] filled_data;
    wire [8:0] load_data_bytes;
    wire [8*MEM_BUS_BYTES-1:0] load_data;

    // ---- blocks, in the order of Figure 2 ----

    volume_divider #(
        .EMPTY_BRICKS(EMPTY_BRICKS)
    ) the_volume_divider (
        .clk(clk), .rst(rst), .brick_valid(brick_valid), .brick_fresh(brick_fresh), .brick_number(brick_number),
        .brick_lo_x(brick_lo_x), .brick_lo_y(brick_lo_y), .brick_lo_z(brick_lo_z), .brick_hi_x(brick_hi_x),
        .brick_hi_y(brick_hi_y), .brick_hi_z(brick_hi_z), .brick_x0(brick_x0), .brick_y0(brick_y0),
        .brick_x1(brick_x1), .brick_y1(brick_y1), .brick_k0(brick_k0), .brick_k1(brick_k1), .brick_ready(brick_ready),
        .report_status(volume_divider_status), .report_idle(volume_divider_idle), .empty_write(empty_write),
        .empty_address(empty_address), .empty_data(empty_data), .dim_x(held_dim_x), .dim_y(held_dim_y),
        .dim_z(held_dim_z), .width_px(held_width_px), .height_px(held_height_px), .slices(held_slices),
        .perspective(held_perspective), .shift(held_shift), .base_x(held_base_x), .base_y(held_base_y),
        .base_z(held_base_z), .step_u_x(held_step_u_x), .step_u_y(held_step_u_y), .step_u_z(held_step_u_z),
        .step_v_x(held_step_v_x), .step_v_y(held_step_v_y), .step_v_z(held_step_v_z), .step_s_x(held_step_s_x),
        .step_s_y(held_step_s_y), .step_s_z(held_step_s_z), .depth_first(held_depth_first),
        .depth_step(held_depth_step), .blend(held_blend), .skip_empty(held_skip_empty),
        .brick_setup_cycles(held_brick_setup_cycles), .edge_x(held_edge_x), .edge_y(held_edge_y),
        .edge_z(held_edge_z), .bricks_x(held_bricks_x), .bricks_y(held_bricks_y), .bricks_z(held_bricks_z),
        .eye_x(held_eye_x), .eye_y(held_eye_y), .eye_z(held_eye_z), .nest_0(held_nest_0), .nest_1(held_nest_1),
        .nest_2(held_nest_2), .tile_px(held_tile_px), .centre_x(held_centre_x), .centre_y(held_centre_y),
        .bound_x_m_x(held_bound_x_m_x), .bound_x_m_y(held_bound_x_m_y), .bound_x_m_z(held_bound_x_m_z),
        .bound_y_m_x(held_bound_y_m_x), .bound_y_m_y(held_bound_y_m_y), .bound_y_m_z(held_bound_y_m_z),
        .bound_z_m_x(held_bound_z_m_x), .bound_z_m_y(held_bound_z_m_y), .bound_z_m_z(held_bound_z_m_z),
        .bound_k_m_x(held_bound_k_m_x), .bound_k_m_y(held_bound_k_m_y), .bound_k_m_z(held_bound_k_m_z),
        .bound_x_lo(held_bound_x_lo), .bound_x_hi(held_bound_x_hi), .bound_y_lo(held_bound_y_lo),
        .bound_y_hi(held_bound_y_hi), .bound_z_lo(held_bound_z_lo), .bound_z_hi(held_bound_z_hi),
        .bound_k_lo(held_bound_k_lo), .bound_k_hi(held_bound_k_hi), .bound_x_fraction(held_bound_x_fraction),
        .bound_y_fraction(held_bound_y_fraction), .bound_k_fraction(held_bound_k_fraction)
    );

    slice_generator the_slice_generator (
        .clk(clk), .rst(rst), .brick_valid(brick_valid), .brick_lo_x(brick_lo_x), .brick_lo_y(brick_lo_y),
        .brick_lo_z(brick_lo_z), .brick_hi_x(brick_hi_x), .brick_hi_y(brick_hi_y), .brick_hi_z(brick_hi_z),
        .brick_x0(brick_x0), .brick_y0(brick_y0), .brick_x1(brick_x1), .brick_y1(brick_y1), .brick_k0(brick_k0),
        .brick_k1(brick_k1), .brick_ready(brick_ready), .slice_valid(slice_valid), .slice_last(slice_last),
        .slice_k(slice_k), .slice_origin_x(slice_origin_x), .slice_origin_y(slice_origin_y),
        .slice_origin_z(slice_origin_z), .slice_step_u_x(slice_step_u_x), .slice_step_u_y(slice_step_u_y),
        .slice_step_u_z(slice_step_u_z), .slice_step_v_x(slice_step_v_x), .slice_step_v_y(slice_step_v_y),
        .slice_step_v_z(slice_step_v_z), .slice_lo_x(slice_lo_x), .slice_lo_y(slice_lo_y), .slice_lo_z(slice_lo_z),
        .slice_hi_x(slice_hi_x), .slice_hi_y(slice_hi_y), .slice_hi_z(slice_hi_z), .slice_x0(slice_x0),
        .slice_y0(slice_y0), .slice_x1(slice_x1), .slice_y1(slice_y1), .slice_ready(slice_ready),
        .report_status(slice_generator_status), .report_idle(slice_generator_idle), .blend(held_blend),
        .perspective(held_perspective), .shift(held_shift), .base_x(held_base_x), .base_y(held_base_y),
        .base_z(held_base_z), .step_u_x(held_step_u_x), .step_u_y(held_step_u_y), .step_u_z(held_step_u_z),
        .step_v_x(held_step_v_x), .step_v_y(held_step_v_y), .step_v_z(held_step_v_z), .step_s_x(held_step_s_x),
        .step_s_y(held_step_s_y), .step_s_z(held_step_s_z), .depth_first(held_depth_first),
        .depth_step(held_depth_step), .slice_setup_cycles(held_slice_setup_cycles)
    );

    rasterizer the_rasterizer (
        .clk(clk), .rst(rst), .slice_valid(slice_valid), .slice_last(slice_last), .slice_origin_x(slice_origin_x),
        .slice_origin_y(slice_origin_y), .slice_origin_z(slice_origin_z), .slice_step_u_x(slice_step_u_x),
        .slice_step_u_y(slice_step_u_y), .slice_step_u_z(slice_step_u_z), .slice_step_v_x(slice_step_v_x),
        .slice_step_v_y(slice_step_v_y), .slice_step_v_z(slice_step_v_z), .slice_lo_x(slice_lo_x),
        .slice_lo_y(slice_lo_y), .slice_lo_z(slice_lo_z), .slice_hi_x(slice_hi_x), .slice_hi_y(slice_hi_y),
        .slice_hi_z(slice_hi_z), .slice_x0(slice_x0), .slice_y0(slice_y0), .slice_x1(slice_x1), .slice_y1(slice_y1),
        .slice_ready(slice_ready), .fragment_valid(fragment_valid), .fragment_visit_done(fragment_visit_done),
        .fragment_x(fragment_x), .fragment_y(fragment_y), .fragment_a_x(fragment_a_x), .fragment_a_y(fragment_a_y),
        .fragment_a_z(fragment_a_z), .fragment_ready(fragment_ready), .fragment_loading(fragment_loading),
        .report_status(rasterizer_status), .report_idle(rasterizer_idle)
    );

    texture_unit #(
        .DENSITY_BITS(DENSITY_BITS), .WEIGHT_BITS(WEIGHT_BITS), .GUARD_BITS(GUARD_BITS), .FB_BITS(FB_BITS),
        .MEM_BUS_BYTES(MEM_BUS_BYTES), .BEAT_BYTES(BEAT_BYTES), .TEXTURE_BYTES(TEXTURE_BYTES),
        .FRAGMENT_ROOM(FRAGMENT_ROOM)
    ) the_texture_unit (
        .clk(clk), .rst(rst), .brick_fresh(brick_fresh), .brick_number(brick_number), .brick_lo_x(brick_lo_x),
        .brick_lo_y(brick_lo_y), .brick_lo_z(brick_lo_z), .brick_hi_x(brick_hi_x), .brick_hi_y(brick_hi_y),
        .brick_hi_z(brick_hi_z), .fragment_valid(fragment_valid), .fragment_visit_done(fragment_visit_done),
        .fragment_x(fragment_x), .fragment_y(fragment_y), .fragment_a_x(fragment_a_x), .fragment_a_y(fragment_a_y),
        .fragment_a_z(fragment_a_z), .fragment_ready(fragment_ready), .fragment_loading(fragment_loading),
        .load_valid(load_valid), .load_address(load_address), .load_bytes(load_bytes), .load_ready(load_ready),
        .load_granted(load_granted), .load_data_valid(load_data_valid), .load_data_bytes(load_data_bytes),
        .load_data(load_data), .fetch_valid(fetch_valid), .fetch_lo_x(fetch_lo_x), .fetch_lo_y(fetch_lo_y),
        .fetch_lo_z(fetch_lo_z), .fetch_hi_x(fetch_hi_x), .fetch_hi_y(fetch_hi_y), .fetch_hi_z(fetch_hi_z),
        .voxels_valid(voxels_valid), .voxels_density(voxels_density), .colour_valid(colour_valid),
        .colour_dead(colour_dead), .colour_x(colour_x), .colour_y(colour_y), .colour_rgba(colour_rgba),
        .colour_ready(colour_ready), .colour_gone(colour_gone), .report_status(texture_unit_status),
        .report_idle(texture_unit_idle), .table_write(table_write), .table_address(table_address),
        .table_data(table_data), .filter(held_filter), .traversal(held_traversal),
        .texture_latency_cycles(held_texture_latency_cycles), .double_buffer(held_double_buffer), .shift(held_shift),
        .base_x(held_base_x), .base_y(held_base_y), .base_z(held_base_z), .dim_x(held_dim_x), .dim_y(held_dim_y),
        .dim_z(held_dim_z), .texture_base(held_texture_base), .brick_room_bytes(held_brick_room_bytes)
    );

    alpha_blender #(
        .FB_BITS(FB_BITS), .BLEND_CYCLES(BLEND_CYCLES), .NONBLOCKING(NONBLOCKING), .NONBLOCKING_FIFO(NONBLOCKING_FIFO)
    ) the_alpha_blender (
        .clk(clk), .rst(rst), .blend(held_blend), .colour_valid(colour_valid), .colour_dead(colour_dead),
        .colour_rgba(colour_rgba), .colour_ready(colour_ready), .colour_gone(colour_gone),
        .colour_hazard(colour_hazard), .pixel_valid(pixel_valid), .pixel_rgba(pixel_rgba),
        .blended_known(blended_known), .blended_known_writes(blended_known_writes), .blended_valid(blended_valid),
        .blended_writes(blended_writes), .blended_rgba(blended_rgba), .report_status(alpha_blender_status),
        .report_idle(alpha_blender_idle)
    );

    pixel_cache #(
        .FB_BITS(FB_BITS), .LINE_W(LINE_W), .LINE_H(LINE_H), .CACHE_BYTES(CACHE_BYTES), .WAYS(WAYS),
        .BLEND_CYCLES(BLEND_CYCLES), .NONBLOCKING(NONBLOCKING), .NONBLOCKING_FIFO(NONBLOCKING_FIFO),
        .NONBLOCKING_MISSES(NONBLOCKING_MISSES), .WRITE_FIFO(WRITE_FIFO), .FRAME_LINES(FRAME_LINES)
    ) the_pixel_cache (
        .clk(clk), .rst(rst), .index(held_index), .replacement(held_replacement), .write_policy(held_write_policy),
        .clear_on_first_touch(held_clear_on_first_touch), .fb_layout(held_fb_layout),
        .lines_across(held_lines_across), .colour_valid(colour_valid), .colour_dead(colour_dead), .colour_x(colour_x),
        .colour_y(colour_y), .colour_ready(colour_ready), .colour_gone(colour_gone), .colour_hazard(colour_hazard),
        .look_up_valid(look_up_valid), .look_up_miss(look_up_miss), .look_up_replaced(look_up_replaced),
        .look_up_x(look_up_x), .look_up_y(look_up_y), .pixel_valid(pixel_valid), .pixel_rgba(pixel_rgba),
        .blended_known(blended_known), .blended_known_writes(blended_known_writes), .blended_valid(blended_valid),
        .blended_writes(blended_writes), .blended_rgba(blended_rgba), .fill_valid(fill_valid),
        .fill_address(fill_address), .filled_valid(filled_valid), .filled_data(filled_data),
        .write_valid(write_valid), .write_address(write_address), .write_bytes(write_bytes), .write_data(write_data),
        .written_valid(written_valid), .volume_divider_idle(volume_divider_idle),
        .slice_generator_idle(slice_generator_idle), .rasterizer_idle(rasterizer_idle),
        .texture_unit_idle(texture_unit_idle), .report_status(pixel_cache_status), .report_idle(pixel_cache_idle)
    );

    frame_buffer #(
        .FB_BITS(FB_BITS), .LINE_W(LINE_W), .LINE_H(LINE_H), .MEM_BUS_BYTES(MEM_BUS_BYTES), .NONBLOCKING(NONBLOCKING),
        .NONBLOCKING_MISSES(NONBLOCKING_MISSES), .WRITE_FIFO(WRITE_FIFO)
    ) the_frame_buffer (
        .clk(clk), .rst(rst), .memory(held_memory), .mem_latency_cycles(held_mem_latency_cycles),
        .dram_banks(held_dram_banks), .dram_row_bytes(held_dram_row_bytes), .dram_trcd_cycles(held_dram_trcd_cycles),
        .dram_tcas_cycles(held_dram_tcas_cycles), .dram_trp_cycles(held_dram_trp_cycles),
        .dram_refresh_cycles(held_dram_refresh_cycles), .dram_trfc_cycles(held_dram_trfc_cycles),
        .texture_burst_bytes(held_texture_burst_bytes), .fill_valid(fill_valid), .fill_address(fill_address),
        .filled_valid(filled_valid), .filled_data(filled_data), .write_valid(write_valid),
        .write_address(write_address), .write_bytes(write_bytes), .write_data(write_data),
        .written_valid(written_valid), .load_valid(load_valid), .load_address(load_address), .load_bytes(load_bytes),
        .load_ready(load_ready), .load_granted(load_granted), .load_data_valid(load_data_valid),
        .load_data_bytes(load_data_bytes), .load_data(load_data), .memory_read(memory_read),
        .memory_write(memory_write), .memory_address(memory_address), .memory_write_bytes(memory_write_bytes),
        .memory_write_data(memory_write_data), .memory_read_data(memory_read_data),
        .report_status(frame_buffer_status), .report_idle(frame_buffer_idle)
    );
endmodule
