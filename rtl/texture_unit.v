// texture_unit.v - the 3D texture mapping unit: address, fetch, filter, classify, and the FIFO before the alpha blender
// (Figure 2 of the paper; docs/architecture.md, section 6; docs/timing.md, section 6; docs/blocks/texture_unit.md).
//
//   port        from, to                   what it is
//   brick_*     volume divider             strobe `fresh`: a visit
//   fragment_*  rasterizer, and back       link: a fragment with the numerators of its position; `loading`: not ready,
//                                          for want of its brick; strobe `visit_done`: a visit's last row is through
//   load_*      frame buffer, and back     link: a brick is wanted; strobes: the last grant, data
//   fetch_*     external memory (`whole`)  strobe: which voxels are wanted
//   voxels_*    external memory (`whole`)  strobe: their densities
//   colour_*    pixel cache, and back      link: a fragment with its colour, or dead; `gone`: one left the cache's door
//   table_*     the application, in reset  an entry {dead, word} of the classification table
//   report_*    who counts                 what it did; whether all fragments are gone
//
// Elaborated are widths and what memories hold: TEXTURE_BYTES, of one buffer, at least those of the largest brick with
// its border, cut to the volume; BEAT_BYTES, the smaller of mem_bus_bytes and texture_burst_bytes; FRAGMENT_ROOM.
//
//             in cycle a                     in a + 1; `whole`: when voxels come               in a + latency - 2, or
//             it is accepted                                                                   when there is room
//            +----------+    +---------+  8  +--------+  +----------+
//  fragment -| position |-+->| texture |--+->| filter |->| classify |-> shaded[] ---------------------+-> colour
//            | address  | |  | memory  |  |  +--------+  +----------+      |                          |
//            +----------+ |  +---------+  |      |         colours[]       +- straight on: latency 3 -+
//                         |    ^          |      |                                                    |
//                         +----|-> fetch  +- voxels         due[]: the cycle in which it may be shown |
//                         +----|--------- weights[]                                                   |
//                         +----|--------- place[]: x, y ----------------------------------------------+
//                              |
//     brick, load <--> texture_loader
//
// Fragments keep their order. So what is known of each lies in arrays [FRAGMENT_ROOM] at one slot, and four pointers
// follow each other through the slots: accepted, filtered, ripe (the latency is over), shown.
`include "vodr_hw.vh"
`include "status.vh"

module texture_unit #(
    parameter DENSITY_BITS  = `VODR_DEFAULT_DENSITY_BITS,
    parameter WEIGHT_BITS   = `VODR_DEFAULT_WEIGHT_BITS,
    parameter GUARD_BITS    = `VODR_DEFAULT_GUARD_BITS,
    parameter FB_BITS       = `VODR_DEFAULT_FB_BITS,
    parameter MEM_BUS_BYTES = `VODR_DEFAULT_MEM_BUS_BYTES,
    parameter BEAT_BYTES    = MEM_BUS_BYTES,
    parameter TEXTURE_BYTES = `VODR_DEFAULT_TEXTURE_MEMORY_BYTES / 2,
    parameter FRAGMENT_ROOM = `VODR_DEFAULT_FRAGMENT_FIFO
) (
    input                            clk,
    input                            rst,

    // verilator lint_off UNUSEDSIGNAL
    // Registers and ports are as wide as any machine needs.
    input                            filter,
    input                      [1:0] traversal,
    input                      [7:0] texture_latency_cycles, // at least 3
    input                            double_buffer,
    input                      [4:0] shift,
    input signed              [63:0] base_x, base_y, base_z,
    input                     [15:0] dim_x, dim_y, dim_z,
    input                     [47:0] texture_base,
    input                     [47:0] brick_room_bytes,

    input                            table_write,
    input                     [11:0] table_address,
    input              [4*FB_BITS:0] table_data,

    input                            brick_fresh,
    input                     [47:0] brick_number,
    input                     [15:0] brick_lo_x, brick_lo_y, brick_lo_z,
    input                     [15:0] brick_hi_x, brick_hi_y, brick_hi_z,

    input                            fragment_valid,
    input                            fragment_visit_done,
    input                     [14:0] fragment_x, fragment_y,
    input signed              [63:0] fragment_a_x, fragment_a_y, fragment_a_z,
    output reg                       fragment_ready,
    output reg                       fragment_loading,

    output                           load_valid,
    output                    [47:0] load_address,
    output                    [31:0] load_bytes,
    input                            load_ready,
    input                            load_granted,
    input                            load_data_valid,
    input                      [8:0] load_data_bytes,
    input      [8*MEM_BUS_BYTES-1:0] load_data,

    output reg                       fetch_valid,
    output reg                [15:0] fetch_lo_x, fetch_lo_y, fetch_lo_z,
    output reg                [15:0] fetch_hi_x, fetch_hi_y, fetch_hi_z,
    input                            voxels_valid,
    input                    [127:0] voxels_density,

    output reg                       colour_valid,
    output reg                       colour_dead,
    output reg                [14:0] colour_x, colour_y,
    output reg       [4*FB_BITS-1:0] colour_rgba,
    input                            colour_ready,
    input                            colour_gone,

    output reg                 [3:0] report_status,
    output reg                       report_idle
    // verilator lint_on UNUSEDSIGNAL
);
    localparam DENSITY_BYTES = DENSITY_BITS > 8 ? 2 : 1;
    localparam WORD_BYTES    = BEAT_BYTES > DENSITY_BYTES ? BEAT_BYTES : DENSITY_BYTES; // of texture memory
    localparam BUFFER_BITS   = TEXTURE_BYTES > WORD_BYTES ? $clog2((TEXTURE_BYTES + WORD_BYTES - 1) / WORD_BYTES) : 1;
    localparam LANE_BITS     = $clog2(8 * WORD_BYTES);                                  // of a bit's number in a word
    localparam SLOT_BITS     = FRAGMENT_ROOM > 1 ? $clog2(FRAGMENT_ROOM) : 1;
    localparam COUNT_BITS    = $clog2(FRAGMENT_ROOM + 1);
    localparam LAST_SLOT     = FRAGMENT_ROOM - 1;
    localparam FRACTION_BITS = 24; // of a position
    localparam Q_BITS        = 40; // what a position inside the volume takes, or half a voxel before it

    `include "texture_filter.vh"

    wire whole  = traversal == `VODR_TRAVERSAL_WHOLE;
    wire linear = filter == `VODR_FILTER_LINEAR;
    wire accept = fragment_valid && fragment_ready;

    // ---- the loader ----

    wire                    there_next, buffer, write, write_buffer;
    wire [15:0]             origin_x, origin_y, origin_z;
    wire [31:0]             row_bytes, plane_bytes;
    wire [BUFFER_BITS-1:0]  write_word;
    wire [8*WORD_BYTES-1:0] write_data;

    texture_loader #(
        .DENSITY_BYTES(DENSITY_BYTES), .BEAT_BYTES(BEAT_BYTES), .WORD_BYTES(WORD_BYTES), .BUFFER_BITS(BUFFER_BITS)
    ) loader (
        .clk(clk), .rst(rst), .brick_fresh(brick_fresh), .brick_number(brick_number),
        .brick_lo_x(brick_lo_x), .brick_lo_y(brick_lo_y), .brick_lo_z(brick_lo_z),
        .brick_hi_x(brick_hi_x), .brick_hi_y(brick_hi_y), .brick_hi_z(brick_hi_z),
        .visit_done(fragment_visit_done), .load_ready(load_ready), .load_granted(load_granted),
        .load_data_valid(load_data_valid), .load_data_bytes(load_data_bytes), .load_data(load_data[8*BEAT_BYTES-1:0]),
        .whole(whole), .border(linear), .double_buffer(double_buffer), .dim_x(dim_x), .dim_y(dim_y), .dim_z(dim_z),
        .texture_base(texture_base), .brick_room_bytes(brick_room_bytes),
        .load_valid(load_valid), .load_address(load_address), .load_bytes(load_bytes),
        .there_next(there_next), .buffer(buffer), .origin_x(origin_x), .origin_y(origin_y), .origin_z(origin_z),
        .row_bytes(row_bytes), .plane_bytes(plane_bytes),
        .write(write), .write_buffer(write_buffer), .write_word(write_word), .write_data(write_data)
    );

    // ---- address: which voxels, and how they are weighed ----

    // Position along an axis; in linear, from the centre of voxel 0 on. Bits beyond Q_BITS are its sign, too.
    // verilator lint_off UNUSEDSIGNAL
    function [Q_BITS-1:0] position_of;
        input signed [63:0] a;
        input [Q_BITS-1:0]  base;
        reg signed [63:0]   moved;
        reg [Q_BITS-1:0]    half;
        begin
            moved = a >>> shift;
            half = {{(Q_BITS - FRACTION_BITS){1'b0}}, linear, {(FRACTION_BITS - 1){1'b0}}};
            position_of = base + moved[Q_BITS-1:0] - half;
        end
    endfunction

    // Of the voxels i and i + 1 the first, and whether there is another: both are cut to the volume.
    function [15:0] first_of;
        input [15:0] i;
        first_of = i[15] ? 16'd0 : i;
    endfunction

    function two_of;
        input [15:0] i, dim;
        two_of = linear && !i[15] && i + 16'd1 != dim;
    endfunction

    reg [Q_BITS-1:0] q_x, q_y, q_z; // of their fractions the first WEIGHT_BITS count
    // verilator lint_on UNUSEDSIGNAL

    always @* begin
        q_x = {Q_BITS{1'b0}};
        q_y = {Q_BITS{1'b0}};
        q_z = {Q_BITS{1'b0}};
        if (accept) begin
            q_x = position_of(fragment_a_x, base_x[Q_BITS-1:0]);
            q_y = position_of(fragment_a_y, base_y[Q_BITS-1:0]);
            q_z = position_of(fragment_a_z, base_z[Q_BITS-1:0]);
        end
    end

    wire [15:0] lo_x  = first_of(q_x[FRACTION_BITS +: 16]);
    wire [15:0] lo_y  = first_of(q_y[FRACTION_BITS +: 16]);
    wire [15:0] lo_z  = first_of(q_z[FRACTION_BITS +: 16]);
    wire        two_x = two_of(q_x[FRACTION_BITS +: 16], dim_x);
    wire        two_y = two_of(q_y[FRACTION_BITS +: 16], dim_y);
    wire        two_z = two_of(q_z[FRACTION_BITS +: 16], dim_z);

    // The first voxel's byte among those of its brick, and how far on its neighbours are.
    wire [31:0] step_x = two_x ? DENSITY_BYTES : 32'd0;
    wire [31:0] step_y = two_y ? row_bytes : 32'd0;
    wire [31:0] step_z = two_z ? plane_bytes : 32'd0;
    reg  [31:0] first;

    always @* begin
        first = 32'd0;
        if (accept && !whole)
            first = {16'd0, lo_z - origin_z} * plane_bytes + {16'd0, lo_y - origin_y} * row_bytes
                  + {16'd0, lo_x - origin_x} * DENSITY_BYTES;
    end

    always @(posedge clk) fetch_valid <= accept && whole && !rst;

    always @(posedge clk)
        if (accept && whole) begin
            fetch_lo_x <= lo_x;
            fetch_lo_y <= lo_y;
            fetch_lo_z <= lo_z;
            fetch_hi_x <= lo_x + {15'd0, two_x};
            fetch_hi_y <= lo_y + {15'd0, two_y};
            fetch_hi_z <= lo_z + {15'd0, two_z};
        end

    // ---- texture memory: written a word a beat, read by eight ports ----

    reg [8*WORD_BYTES-1:0]    memory [0:(2 << BUFFER_BITS)-1];
    reg                       read;   // eight words, for the fragment that was accepted in the cycle before
    wire                      filtering = whole ? voxels_valid : read;
    wire [8*DENSITY_BITS-1:0] voxels; // of the fragment that is filtered, x fastest

    always @(posedge clk)
        if (write) memory[{write_buffer, write_word}] <= write_data;

    always @(posedge clk) read <= accept && !whole && !rst;

    // Of a byte of a buffer: the word that has it, and where it begins there.
    // verilator lint_off UNUSEDSIGNAL
    function [BUFFER_BITS-1:0] word_of;
        input [31:0] at;
        reg [34:0]   at_bit;
        begin
            at_bit = {at, 3'b000};
            word_of = at_bit[LANE_BITS +: BUFFER_BITS];
        end
    endfunction

    function [LANE_BITS-1:0] lane_of;
        input [31:0] at;
        reg [34:0]   at_bit;
        begin
            at_bit = {at, 3'b000};
            lane_of = at_bit[LANE_BITS-1:0];
        end
    endfunction
    // verilator lint_on UNUSEDSIGNAL

    genvar i;
    generate
        for (i = 0; i < 8; i = i + 1) begin : corner
            localparam [31:0] X = i & 1, Y = i >> 1 & 1, Z = i >> 2;
            reg [8*WORD_BYTES-1:0] word;
            reg [LANE_BITS-1:0]    lane;
            always @(posedge clk)
                if (accept && !whole) begin
                    word <= memory[{buffer, word_of(first + step_x * X + step_y * Y + step_z * Z)}];
                    lane <= lane_of(first + step_x * X + step_y * Y + step_z * Z);
                end
            assign voxels[i*DENSITY_BITS +: DENSITY_BITS] =
                !filtering ? {DENSITY_BITS{1'b0}} :
                read       ? word[lane +: DENSITY_BITS] : voxels_density[16*i +: DENSITY_BITS];
        end
    endgenerate

    // ---- slots ----

    reg [SLOT_BITS-1:0] accepted_at, filtered_at, ripe_at, shown_at; // of the next to be so
    wire                ripens, show;

    function [SLOT_BITS-1:0] next;
        input [SLOT_BITS-1:0] at;
        next = at == LAST_SLOT[SLOT_BITS-1:0] ? {SLOT_BITS{1'b0}} : at + {{(SLOT_BITS - 1){1'b0}}, 1'b1};
    endfunction

    always @(posedge clk)
        if (rst) accepted_at <= {SLOT_BITS{1'b0}};
        else if (accept) accepted_at <= next(accepted_at);

    always @(posedge clk)
        if (rst) filtered_at <= {SLOT_BITS{1'b0}};
        else if (filtering) filtered_at <= next(filtered_at);

    always @(posedge clk)
        if (rst) ripe_at <= {SLOT_BITS{1'b0}};
        else if (ripens) ripe_at <= next(ripe_at);

    always @(posedge clk)
        if (rst) shown_at <= {SLOT_BITS{1'b0}};
        else if (show) shown_at <= next(shown_at);

    // ---- accepted: place and weights ----

    reg [29:0]              place [0:LAST_SLOT];
    reg [3*WEIGHT_BITS-1:0] weights [0:LAST_SLOT];

    always @(posedge clk)
        if (accept) begin
            place[accepted_at]   <= {fragment_y, fragment_x};
            weights[accepted_at] <= {q_z[FRACTION_BITS-1 -: WEIGHT_BITS], q_y[FRACTION_BITS-1 -: WEIGHT_BITS],
                                     q_x[FRACTION_BITS-1 -: WEIGHT_BITS]};
        end

    // ---- filtered and classified ----

    reg [4*FB_BITS:0]        colours [0:(1 << DENSITY_BITS)-1]; // of densities: {dead, word}
    reg [4*FB_BITS:0]        shaded [0:LAST_SLOT];
    reg [DENSITY_BITS-1:0]   density;
    wire [4*FB_BITS:0]       colour = colours[density];
    wire [3*WEIGHT_BITS-1:0] weight = weights[filtered_at];

    always @(posedge clk)
        if (table_write) colours[table_address[DENSITY_BITS-1:0]] <= table_data;

    always @* begin
        density = {DENSITY_BITS{1'b0}};
        if (filtering)
            density = linear ? trilinear(voxels, weight) : voxels[DENSITY_BITS-1:0];
    end

    always @(posedge clk)
        if (filtering) shaded[filtered_at] <= colour;

    // ---- ripe: the latency is over; with each filtered fragment is noted when that will be so ----

    reg [7:0]            now;
    reg [7:0]            due [0:LAST_SLOT];
    reg [COUNT_BITS-1:0] unripe, ripe; // filtered, but not ripe; ripe, but not shown
    wire                 at_once = texture_latency_cycles == 8'd3;

    assign ripens = at_once ? filtering : unripe != 0 && due[ripe_at] == now;

    always @(posedge clk) now <= rst ? 8'd0 : now + 8'd1;

    always @(posedge clk)
        if (filtering) due[filtered_at] <= now + texture_latency_cycles - 8'd3;

    always @(posedge clk) begin
        unripe <= rst ? {COUNT_BITS{1'b0}} : step(unripe, filtering, ripens);
        ripe   <= rst ? {COUNT_BITS{1'b0}} : step(ripe, ripens, show);
    end

    function [COUNT_BITS-1:0] step;
        input [COUNT_BITS-1:0] count;
        input                  up, down;
        step = up == down ? count : up ? count + 1'b1 : count - 1'b1;
    endfunction

    // ---- shown: what is seen at the end, until it moves ----

    assign show = (!colour_valid || colour_ready) && (ripe != 0 || ripens);

    always @(posedge clk) colour_valid <= !rst && (show || (colour_valid && !colour_ready));

    always @(posedge clk)
        if (show) begin
            {colour_y, colour_x}       <= place[shown_at];
            {colour_dead, colour_rgba} <= at_once && ripe == 0 ? colour : shaded[shown_at];
        end

    // ---- room: of fragments accepted and not gone ----

    reg [COUNT_BITS-1:0]  count;
    wire [COUNT_BITS-1:0] count_next = step(count, accept, colour_gone);

    always @(posedge clk)
        if (rst) begin
            count            <= {COUNT_BITS{1'b0}};
            fragment_ready   <= 1'b0;
            fragment_loading <= 1'b1;
            report_idle      <= 1'b1;
            report_status    <= `STATUS_IDLE;
        end else begin
            count            <= count_next;
            fragment_ready   <= there_next && count_next != FRAGMENT_ROOM[COUNT_BITS-1:0];
            fragment_loading <= !there_next;
            report_idle      <= count_next == 0;
            report_status    <= accept           ? `STATUS_BUSY
                              : !fragment_valid  ? `STATUS_IDLE
                              : fragment_loading ? `STATUS_STALLED_TEXTURE_LOAD
                                                 : `STATUS_STALLED_FRAGMENT_FIFO;
        end
endmodule
