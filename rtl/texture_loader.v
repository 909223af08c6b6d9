// texture_loader.v - the texture unit's loader: which bricks lie in the buffers of texture memory, which are on their
// way, and which visit is being drawn (docs/timing.md, section 6, "Loader"; docs/architecture.md, section 4).
//
//   brick_fresh, _number, _lo, _hi   strobe: a visit was handed on to the slice generator
//   visit_done                       strobe: the rasterizer has gone through the oldest visit that is not drawn
//   load_*                           link to the frame buffer: a brick is wanted; its answers, and the brick's bytes
//   there_next                       from the next cycle on the visit that is drawn has its brick
//   buffer, origin_*, row, plane     of the visit that is drawn: its buffer; the first voxel that lies there; bytes of
//                                    a row of voxels, of a plane
//   write, write_word, write_data    to texture memory: a word of a buffer
//
//   brick --> +------------------+  a brick that   +------------------+   +-----------+
//             | held[2]: is it   |  no buffer has  | load_visit[8]    |-->| cut, size |--> load_valid, _address, _bytes
//             | in a buffer, or  |---------------->| loads by number: |   | address   |--> region of its buffer
//             | which takes it   |                 | loaded <= asked  |   +-----------+
//             +------------------+                 | <= known         |<-- load_granted, data
//              | visit by visit                    +------------------+--> write, by bytes done
//              v                                     | first visit that has not its brick
//             +------------------+                   v
//             | visit_buffer[8]  |--> buffer       loaded visit != drawn visit --> there_next
//             +------------------+
//
// Visits, and the loads among them, have numbers modulo 16; at most 8 are known and not drawn. A buffer is asked for
// again only when all visits that used it are drawn, so what is known of a brick's size and place is kept by buffer.
module texture_loader #(
    parameter DENSITY_BYTES = 1,
    parameter BEAT_BYTES    = 16, // of a brick in a beat
    parameter WORD_BYTES    = 16, // BEAT_BYTES, or 2 where they are 1 and a density has two
    parameter BUFFER_BITS   = 13  // of a word's number in a buffer
) (
    input                     clk,
    input                     rst,

    input                     whole,
    input                     border, // a voxel on each side, for the filter
    input                     double_buffer,
    input              [15:0] dim_x, dim_y, dim_z,
    input              [47:0] texture_base,
    input              [47:0] brick_room_bytes,

    input                     brick_fresh,
    input              [47:0] brick_number,
    input              [15:0] brick_lo_x, brick_lo_y, brick_lo_z,
    input              [15:0] brick_hi_x, brick_hi_y, brick_hi_z,
    input                     visit_done,

    output reg                load_valid,
    output reg         [47:0] load_address,
    output reg         [31:0] load_bytes,
    input                     load_ready,
    input                     load_granted,
    input                     load_data_valid,
    input               [8:0] load_data_bytes,
    input  [8*BEAT_BYTES-1:0] load_data,

    output                    there_next,
    output                    buffer,
    output             [15:0] origin_x, origin_y, origin_z,
    output             [31:0] row_bytes, plane_bytes,

    output                    write,
    output                    write_buffer,
    output  [BUFFER_BITS-1:0] write_word,
    output [8*WORD_BYTES-1:0] write_data
);
    // ---- visits: by number, the buffer that has the brick or will take it ----

    reg [3:0]  known, drawn;   // visits that came; that were drawn
    reg        visit_buffer [0:7];
    reg [47:0] held_0, held_1; // bricks that buffers hold or will, once all visits are loaded
    reg [1:0]  holds;          // whether they do
    reg        last_buffer;    // of the visit that came last

    wire [3:0] known_next = known + {3'd0, brick_fresh};
    wire [3:0] drawn_next = drawn + {3'd0, visit_done};
    wire       in_0       = holds[0] && held_0 == brick_number;
    wire       in_1       = holds[1] && held_1 == brick_number;
    wire       to_load    = brick_fresh && !whole && !in_0 && !in_1;
    wire       new_buffer = in_0 ? 1'b0 : in_1 ? 1'b1 : double_buffer && !last_buffer;

    assign buffer = visit_buffer[drawn[2:0]];

    always @(posedge clk) begin
        known <= rst ? 4'd0 : known_next;
        drawn <= rst ? 4'd0 : drawn_next;
    end

    always @(posedge clk)
        if (brick_fresh) visit_buffer[known[2:0]] <= new_buffer;

    always @(posedge clk)
        if (rst) begin
            holds       <= 2'b00;
            last_buffer <= 1'b0;
        end else if (brick_fresh && !whole) begin
            holds[new_buffer] <= 1'b1;
            last_buffer       <= new_buffer;
        end

    always @(posedge clk)
        if (to_load && !new_buffer) held_0 <= brick_number;

    always @(posedge clk)
        if (to_load && new_buffer) held_1 <= brick_number;

    // ---- loads: by number, what is loaded into which buffer, for which visit ----

    reg [3:0]  load_visit [0:7];
    reg        load_buffer [0:7];
    reg [47:0] load_number [0:7];
    reg [47:0] load_lo [0:7];
    reg [47:0] load_hi [0:7];
    reg [3:0]  loads_known, loads_asked, loads_loaded; // that came; granted in full; with all data

    wire       finished;                               // a brick's last data
    wire [3:0] loads_known_next  = loads_known + {3'd0, to_load};
    wire [3:0] loads_asked_next  = loads_asked + {3'd0, load_granted};
    wire [3:0] loads_loaded_next = loads_loaded + {3'd0, finished};

    // The first visit that has not its brick: the one that comes now, one of those that wait, or none that is known.
    wire [3:0] loaded_next = loads_loaded_next == loads_known_next ? known_next
                           : loads_loaded_next == loads_known      ? known
                           : load_visit[loads_loaded_next[2:0]];

    assign there_next = loaded_next != drawn_next; // no visit is drawn before it has its brick

    always @(posedge clk) begin
        loads_known  <= rst ? 4'd0 : loads_known_next;
        loads_asked  <= rst ? 4'd0 : loads_asked_next;
        loads_loaded <= rst ? 4'd0 : loads_loaded_next;
    end

    wire [47:0] new_lo = {brick_lo_z, brick_lo_y, brick_lo_x};
    wire [47:0] new_hi = {brick_hi_z, brick_hi_y, brick_hi_x};

    always @(posedge clk)
        if (to_load) begin
            load_visit[loads_known[2:0]]  <= known;
            load_buffer[loads_known[2:0]] <= new_buffer;
            load_number[loads_known[2:0]] <= brick_number;
            load_lo[loads_known[2:0]]     <= new_lo;
            load_hi[loads_known[2:0]]     <= new_hi;
        end

    // ---- request: of the first load that was not asked for, once its buffer's visits are drawn ----

    reg         under_way; // asked for, and not granted in full
    wire        now_comes  = loads_asked_next == loads_known;
    wire [3:0]  ask_visit  = now_comes ? known : load_visit[loads_asked_next[2:0]];
    wire        ask_buffer = now_comes ? new_buffer : load_buffer[loads_asked_next[2:0]];
    wire [47:0] ask_number = now_comes ? brick_number : load_number[loads_asked_next[2:0]];
    wire [47:0] ask_lo     = now_comes ? new_lo : load_lo[loads_asked_next[2:0]];
    wire [47:0] ask_hi     = now_comes ? new_hi : load_hi[loads_asked_next[2:0]];
    wire [3:0]  ahead      = ask_visit - drawn_next;
    wire        ask        = loads_asked_next != loads_known_next && !(under_way && !load_granted)
                             && ahead < (double_buffer ? 4'd2 : 4'd1);

    reg [15:0] lo_x, lo_y, lo_z, hi_x, hi_y, hi_z; // the voxels that lie in memory for it
    reg [31:0] ask_row, ask_plane, ask_bytes;      // bytes

    function [15:0] grown_down;
        input [15:0] lo;
        grown_down = lo - {15'd0, border && lo != 16'd0};
    endfunction

    function [15:0] grown_up;
        input [15:0] hi, dim;
        grown_up = hi + {15'd0, border && hi != dim};
    endfunction

    always @* begin
        {lo_z, lo_y, lo_x} = 48'd0;
        {hi_z, hi_y, hi_x} = 48'd0;
        ask_row = 32'd0;
        ask_plane = 32'd0;
        ask_bytes = 32'd0;
        if (ask) begin
            lo_x = grown_down(ask_lo[15:0]);
            lo_y = grown_down(ask_lo[31:16]);
            lo_z = grown_down(ask_lo[47:32]);
            hi_x = grown_up(ask_hi[15:0], dim_x);
            hi_y = grown_up(ask_hi[31:16], dim_y);
            hi_z = grown_up(ask_hi[47:32], dim_z);
            ask_row = {16'd0, hi_x - lo_x} * DENSITY_BYTES;
            ask_plane = ask_row * {16'd0, hi_y - lo_y};
            ask_bytes = ask_plane * {16'd0, hi_z - lo_z};
        end
    end

    always @(posedge clk)
        if (rst) begin
            load_valid <= 1'b0;
            under_way  <= 1'b0;
        end else begin
            load_valid <= ask || (load_valid && !load_ready);
            under_way  <= ask || (under_way && !load_granted);
        end

    always @(posedge clk)
        if (ask) begin
            load_address <= texture_base + ask_number * brick_room_bytes;
            load_bytes   <= ask_bytes;
        end

    // ---- regions: what lies in each buffer ----

    reg [15:0] region_x [0:1];
    reg [15:0] region_y [0:1];
    reg [15:0] region_z [0:1];
    reg [31:0] region_row [0:1];
    reg [31:0] region_plane [0:1];
    reg [31:0] region_bytes [0:1];

    always @(posedge clk)
        if (ask) begin
            region_x[ask_buffer]     <= lo_x;
            region_y[ask_buffer]     <= lo_y;
            region_z[ask_buffer]     <= lo_z;
            region_row[ask_buffer]   <= ask_row;
            region_plane[ask_buffer] <= ask_plane;
            region_bytes[ask_buffer] <= ask_bytes;
        end

    assign origin_x    = region_x[buffer];
    assign origin_y    = region_y[buffer];
    assign origin_z    = region_z[buffer];
    assign row_bytes   = region_row[buffer];
    assign plane_bytes = region_plane[buffer];

    // ---- data: a brick's bytes in order, a word a beat ----

    reg [31:0]  done_bytes;
    wire [31:0] done_next = done_bytes + {23'd0, load_data_bytes};

    assign write        = load_data_valid;
    assign write_buffer = load_buffer[loads_loaded[2:0]];
    assign write_word   = done_bytes[$clog2(WORD_BYTES) +: BUFFER_BITS];
    assign finished     = load_data_valid && done_next >= region_bytes[write_buffer];

    always @(posedge clk)
        if (rst || finished) done_bytes <= 32'd0;
        else if (load_data_valid) done_bytes <= done_next;

    // A density's first byte waits for its second where a beat brings one.
    generate
        if (WORD_BYTES > BEAT_BYTES) begin : halves
            reg [8*BEAT_BYTES-1:0] first;
            always @(posedge clk)
                if (load_data_valid) first <= load_data;
            assign write_data = {load_data, first};
        end else begin : wholes
            assign write_data = load_data;
        end
    endgenerate
endmodule
