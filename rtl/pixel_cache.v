// pixel_cache.v - the cache between alpha blender and frame buffer (Figure 2 and Table 1 of the paper;
// docs/architecture.md, section 9; docs/timing.md, sections 7 and 9).
//
//   port     way  what it is
//   colour   in   a link: a fragment on its way to the door, where it waits until it is `gone`: looked up, or dropped
//                 when it is dead; `hazard`: it is not, for that alone
//   look_up  out  strobe, for who counts: hit or miss
//   pixel    out  strobe: a pixel, the cycle after its read
//   blended  in   strobes: two cycles after a read whether the pixel is written, BLEND_CYCLES - 1 after it the pixel
//   fill     out  strobe: a line is wanted; filled: here it is
//   write    out  strobe: a line is to be written; written: the bus has it
//   *_idle   in   of the blocks that fragments come through: when all are idle, the flush begins
//   report   out  status and idle
//
//   colour ─► door ─► cache_tags ─► queue ─► evict, fill, read ─► pixel      blended
//              │ a blocking cache:              ▲ │      ▲    └► cache_blends ──┤
//              └──────────────── hits ──────────┼─┼──────┤                      ▼
//                                    filled ────┘ │    data  ◄──────────── pixels, dirty
//                                                 └──► write buffer ─► write
//
// In a blocking cache the queue holds the one miss under way. In a non-blocking one it holds all that was looked up and
// not read; misses have a queue of their own beside it, of the lines that they replace.
`include "vodr_hw.vh"
`include "status.vh"

module pixel_cache #(
    parameter FB_BITS            = `VODR_DEFAULT_FB_BITS,
    parameter LINE_W             = 16,
    parameter LINE_H             = 1,
    parameter CACHE_BYTES        = `VODR_DEFAULT_CACHE_BYTES,
    parameter WAYS               = `VODR_DEFAULT_WAYS,
    parameter BLEND_CYCLES       = `VODR_DEFAULT_BLEND_CYCLES,
    parameter NONBLOCKING        = `VODR_DEFAULT_NONBLOCKING,
    parameter NONBLOCKING_FIFO   = `VODR_DEFAULT_NONBLOCKING_FIFO,
    parameter NONBLOCKING_MISSES = `VODR_DEFAULT_NONBLOCKING_MISSES,
    parameter WRITE_FIFO         = `VODR_DEFAULT_WRITE_FIFO,
    parameter FRAME_LINES        = 1                // of clear_on_first_touch
) (
    input                                  clk,
    input                                  rst,
    input                                  index,
    input                            [1:0] replacement,
    input                                  write_policy,
    input                                  clear_on_first_touch,
    input                                  fb_layout,
    input                           [15:0] lines_across,

    input                                  colour_valid,
    input                                  colour_dead,
    input                           [14:0] colour_x,
    input                           [14:0] colour_y,
    output reg                             colour_ready,
    output reg                             colour_gone,
    output reg                             colour_hazard,

    output reg                             look_up_valid,
    output reg                             look_up_miss,
    output reg                             look_up_replaced,
    output reg                      [14:0] look_up_x,
    output reg                      [14:0] look_up_y,

    output reg                             pixel_valid,
    output reg             [4*FB_BITS-1:0] pixel_rgba,
    input                                  blended_known,
    input                                  blended_known_writes,
    input                                  blended_valid,
    input                                  blended_writes,
    input                  [4*FB_BITS-1:0] blended_rgba,

    output reg                             fill_valid,
    output reg                      [47:0] fill_address,
    input                                  filled_valid,
    input    [4*FB_BITS*LINE_W*LINE_H-1:0] filled_data,

    output reg                             write_valid,
    output reg                      [47:0] write_address,
    output reg                      [13:0] write_bytes,
    output reg [4*FB_BITS*LINE_W*LINE_H-1:0] write_data,
    input                                  written_valid,

    input                                  volume_divider_idle,
    input                                  slice_generator_idle,
    input                                  rasterizer_idle,
    input                                  texture_unit_idle,
    output reg                       [3:0] report_status,
    output reg                             report_idle
);
    localparam PIXEL       = 4 * FB_BITS;
    localparam LINE        = PIXEL * LINE_W * LINE_H;
    localparam LINES       = 8 * CACHE_BYTES / LINE;
    localparam PLACE_BITS  = LINES > 1 ? $clog2(LINES) : 1;
    localparam W_BITS      = $clog2(LINE_W);
    localparam H_BITS      = $clog2(LINE_H);
    localparam NUMBER_BITS = 28 - W_BITS - H_BITS;             // a frame has up to 16384x16384 pixels
    localparam BYTE_BITS   = $clog2(LINE / 8);
    localparam [31:0] X_MASK = LINE_W - 1, Y_MASK = LINE_H - 1, BYTES = LINE / 8, PIXEL_BYTES = PIXEL / 8;

    localparam DEPTH       = NONBLOCKING != 0 ? NONBLOCKING_FIFO : 1;
    localparam DEPTH_BITS  = DEPTH > 1 ? $clog2(DEPTH) : 1;
    localparam MISSES      = NONBLOCKING != 0 ? NONBLOCKING_MISSES : 1;
    localparam MISS_BITS   = MISSES > 1 ? $clog2(MISSES) : 1;
    localparam [31:0] FULL = DEPTH, ALL_MISSES = MISSES, LAST_MISS = MISSES - 1;

    // ---- where a pixel lies ----

    // The line of a pixel: lines, or tiles of 32x32 pixels, row by row; lines of a tile row by row.
    function [NUMBER_BITS-1:0] line_of(input [14:0] x, input [14:0] y, input tiled, input [15:0] across);
        reg [NUMBER_BITS-1:0] column, row, in_tile;
        begin
            column  = {{(NUMBER_BITS-15){1'b0}}, x};
            row     = {{(NUMBER_BITS-15){1'b0}}, y};
            in_tile = (row & 31) >> H_BITS << (5 - W_BITS) | (column & 31) >> W_BITS;
            line_of = (row >> (tiled ? 5 : H_BITS)) * {{(NUMBER_BITS-16){1'b0}}, across}
                      + (column >> (tiled ? 5 : W_BITS));
            if (tiled)
                line_of = line_of << (10 - W_BITS - H_BITS) | in_tile;
        end
    endfunction

    // Where a pixel's bits begin in its line.
    function [31:0] bit_of(input [29:0] pixel);
        bit_of = (({17'b0, pixel[29:15]} & Y_MASK) << W_BITS | {17'b0, pixel[14:0]} & X_MASK) * PIXEL;
    endfunction

    function [47:0] address_of(input [NUMBER_BITS-1:0] number);
        address_of = {{(48-NUMBER_BITS){1'b0}}, number} << BYTE_BITS;
    endfunction

    function [MISS_BITS-1:0] after(input [MISS_BITS-1:0] miss);
        after = miss == LAST_MISS[MISS_BITS-1:0] ? 0 : miss + 1'b1;
    endfunction

    // ---- the door ----

    reg                    door_valid, door_dead;
    reg             [29:0] door_pixel;
    wire                   arrives = colour_valid & colour_ready;
    wire                   looks   = colour_gone & ~door_dead;
    reg  [NUMBER_BITS-1:0] arriving;

    wire                   arriving_hit, door_hit, replaces;
    wire [NUMBER_BITS-1:0] door_line, victim, flush_line;
    wire  [PLACE_BITS-1:0] at;
    reg   [PLACE_BITS-1:0] flush_at;
    wire                   misses = looks & ~door_hit;
    wire                   touches;      // and its line is zeros
    wire                   through = write_policy == `VODR_WRITE_POLICY_THROUGH;

    always @* begin
        arriving = 0;
        if (arrives)
            arriving = line_of(colour_x, colour_y, fb_layout == `VODR_FB_LAYOUT_TILED, lines_across);
    end

    cache_tags #(
        .SETS(LINES / WAYS), .WAYS(WAYS), .NUMBER_BITS(NUMBER_BITS), .PLACE_BITS(PLACE_BITS)
    ) directory (
        .clk(clk), .rst(rst), .index(index), .replacement(replacement),
        .arrives(arrives), .arriving(arriving), .arriving_hit(arriving_hit), .line(door_line), .hit(door_hit),
        .look_up(looks), .at(at), .replaces(replaces), .victim(victim), .place(flush_at), .held(flush_line)
    );

    cache_touched #(
        .FRAME_LINES(FRAME_LINES), .NUMBER_BITS(NUMBER_BITS)
    ) first_touch (
        .clk(clk), .rst(rst), .clear_on_first_touch(clear_on_first_touch),
        .misses(misses), .line(door_line), .first(touches)
    );

    always @(posedge clk) begin
        door_valid <= ~rst & (arrives | (door_valid & ~colour_gone));
        if (arrives) begin
            door_dead  <= colour_dead;
            door_pixel <= {colour_y, colour_x};
        end
        look_up_valid    <= looks & ~rst;
        look_up_miss     <= misses;
        look_up_replaced <= misses & replaces;
        {look_up_y, look_up_x} <= door_pixel;
    end

    // ---- looked up and not read: the queue, and what misses replace ----

    reg [PLACE_BITS+32:0] queue [0:(1<<DEPTH_BITS)-1];
    reg  [DEPTH_BITS-1:0] first, last;  // the oldest, and where the next goes
    reg    [DEPTH_BITS:0] count;
    wire                  pushes = looks & (NONBLOCKING != 0 | ~door_hit);
    reg                   pops;         // its pixel is read
    reg                   evicted;      // the line that the oldest replaces is out of the way

    wire                  front_misses, front_fills, front_replaces;
    wire [PLACE_BITS-1:0] front_at;
    wire           [29:0] front_pixel;
    assign {front_misses, front_fills, front_replaces, front_at, front_pixel} = queue[first];
    wire                  waiting    = count != 0;
    wire   [DEPTH_BITS:0] count_next = count + {{DEPTH_BITS{1'b0}}, pushes} - {{DEPTH_BITS{1'b0}}, pops};

    reg [NUMBER_BITS-1:0] victims [0:MISSES-1];
    reg      [MISSES-1:0] leaving;      // the miss replaces that line, which is not yet out of the way
    reg   [MISS_BITS-1:0] first_miss, last_miss;
    reg     [MISS_BITS:0] miss_count;
    wire                  miss_pops = pops & front_misses;
    wire    [MISS_BITS:0] miss_count_next = miss_count + {{MISS_BITS{1'b0}}, misses} - {{MISS_BITS{1'b0}}, miss_pops};
    reg [NUMBER_BITS-1:0] missed_line;  // of the last miss
    reg                   wanted;       // in the cycle after its look-up

    always @(posedge clk)
        if (rst) begin
            first      <= 0;
            last       <= 0;
            count      <= 0;
            first_miss <= 0;
            last_miss  <= 0;
            miss_count <= 0;
            leaving    <= 0;
            evicted    <= 1'b0;
            wanted     <= 1'b0;
        end else begin
            count      <= count_next;
            miss_count <= miss_count_next;
            wanted     <= misses & ~touches;
            evicted    <= ~pops & (evicted | passes | moves);
            if (pushes) begin
                queue[last] <= {misses, misses & ~touches, replaces, at, door_pixel};
                last        <= last + 1'b1;
            end
            if (misses) begin
                victims[last_miss] <= victim;
                missed_line        <= door_line;
                last_miss          <= after(last_miss);
            end
            if (pops)
                first <= first + 1'b1;
            if (miss_pops)
                first_miss <= after(first_miss);
            if (front_misses & (passes | moves))
                leaving[first_miss] <= 1'b0;
            if (misses)
                leaving[last_miss] <= replaces;
        end

    // ---- evict, fill, read ----

    wire                  blends;       // some pixel is being blended
    wire [PLACE_BITS-1:0] known_at;
    reg       [LINES-1:0] dirty;
    wire                  soils   = blended_known & blended_known_writes & ~through;
    wire                  dirties = front_replaces & (dirty[front_at] | (soils & known_at == front_at));
    reg                   just_read;
    wire                  hazard;       // the pixel asked for is being blended

    reg                   write_pending; // the write buffer holds write_line
    reg [NUMBER_BITS-1:0] write_line;
    wire                  pending = write_pending & ~written_valid;
    wire                  may_move = ~pending & ~blends;

    wire                  unsettled;    // an access to the line asked for has a place of the write FIFO
    reg     [MISS_BITS:0] fill_count;
    reg                   passes, moves; // the replaced line is out of the way, or moves there
    reg             [3:0] status;

    always @* begin
        {passes, moves, pops} = 3'b0;
        status = `STATUS_IDLE;
        if (waiting) begin
            if (!evicted) begin
                if (NONBLOCKING != 0 && front_misses && just_read)
                    status = `STATUS_IDLE;  // whether that pixel is written is not known yet
                else if (NONBLOCKING != 0 && hazard)
                    status = `STATUS_STALLED_HAZARD;
                else if (dirties) begin
                    moves  = may_move;
                    status = moves && NONBLOCKING == 0 ? `STATUS_STALLED_FILL : `STATUS_STALLED_WRITE_BACK;
                end else if (NONBLOCKING == 0 && front_fills && ((pending && write_line == missed_line) || unsettled))
                    status = `STATUS_STALLED_WRITE_BACK;
                else begin
                    passes = 1'b1;
                    status = `STATUS_STALLED_FILL;
                end
            end
            if (evicted || (passes && NONBLOCKING != 0)) begin
                pops   = ~front_fills | fill_count != 0;
                status = pops ? `STATUS_BUSY : `STATUS_STALLED_FILL;
            end
        end
    end

    wire                  hits    = looks & door_hit & NONBLOCKING == 0;
    wire                  reads   = pops | hits;
    wire           [29:0] read_pixel = hits ? door_pixel : front_pixel;

    always @(posedge clk) begin
        just_read     <= reads;
        report_status <= rst ? `STATUS_IDLE : hits ? `STATUS_BUSY : status;
    end

    // ---- lines ----

    reg        [LINE-1:0] data   [0:LINES-1];
    reg        [LINE-1:0] filled [0:MISSES-1];  // lines that came and wait for their miss's turn
    reg   [MISS_BITS-1:0] fill_first, fill_last;
    wire                  fill_pops = pops & front_fills;
    wire           [29:0] done_pixel;
    wire                  done_replaced;
    wire [PLACE_BITS-1:0] done_at;
    wire [PLACE_BITS-1:0] read_at = flushes ? flush_at : hits ? at : front_at;

    always @(posedge clk) begin
        pixel_valid <= reads & ~rst;
        if (blended_valid & blended_writes & ~done_replaced)
            data[done_at][bit_of(done_pixel) +: PIXEL] <= blended_rgba;
        if (miss_pops)
            data[front_at] <= front_fills ? filled[fill_first] : 0;
        if (miss_pops)
            pixel_rgba <= front_fills ? filled[fill_first][bit_of(read_pixel) +: PIXEL] : 0;
        else if (reads)
            pixel_rgba <= data[read_at][bit_of(read_pixel) +: PIXEL];
    end

    always @(posedge clk)
        if (rst) begin
            fill_first <= 0;
            fill_last  <= 0;
            fill_count <= 0;
        end else begin
            fill_count <= fill_count + {{MISS_BITS{1'b0}}, filled_valid} - {{MISS_BITS{1'b0}}, fill_pops};
            if (filled_valid) begin
                filled[fill_last] <= filled_data;
                fill_last         <= after(fill_last);
            end
            if (fill_pops)
                fill_first <= after(fill_first);
        end

    always @(posedge clk) begin
        fill_valid   <= ~rst & (NONBLOCKING != 0 ? wanted : (passes | moves) & front_fills);
        fill_address <= address_of(missed_line);
    end

    // ---- the write buffer, and the flush ----

    wire empty   = ~(door_valid & ~colour_gone) & ~arrives & count_next == 0 & ~reads & ~blends
                   & volume_divider_idle & slice_generator_idle & rasterizer_idle & texture_unit_idle;
    wire flushes = empty & ~pending & |dirty;
    wire [NUMBER_BITS-1:0] moved_line = flushes ? flush_line : victims[first_miss];

    // Sets, and ways in a set, in their order.
    function [PLACE_BITS-1:0] first_of(input [LINES-1:0] places);
        integer p;
        begin
            first_of = 0;
            for (p = LINES - 1; p >= 0; p = p - 1)
                if (places[p])
                    first_of = p[PLACE_BITS-1:0];
        end
    endfunction

    always @* begin
        flush_at = 0;
        if (flushes)
            flush_at = first_of(dirty);
    end

    always @(posedge clk) begin
        write_valid   <= ~rst & (moves | flushes | settles);
        write_pending <= ~rst & (moves | flushes | pending);
        report_idle   <= ~rst & empty & ~|dirty & ~settles;
        if (moves | flushes) begin
            write_line    <= moved_line;
            write_address <= address_of(moved_line);
            write_bytes   <= BYTES[13:0];
            write_data    <= data[read_at];
        end
        if (settles) begin
            write_address          <= address_of(settled_line) + {16'b0, bit_of(settled_pixel)} / 8;
            write_bytes            <= PIXEL_BYTES[13:0];
            write_data[PIXEL-1:0]  <= settled_rgba;
        end
    end

    always @(posedge clk)
        if (rst)
            dirty <= 0;
        else begin
            if (soils)
                dirty[known_at] <= 1'b1;
            if (moves | flushes)
                dirty[read_at] <= 1'b0;
        end

    // ---- written through ----

    reg                    settled, settled_writes; // a blend was over in the cycle before
    reg        [PIXEL-1:0] settled_rgba;
    reg             [29:0] settled_pixel;
    wire [NUMBER_BITS-1:0] settled_line;
    wire                   settles = settled & settled_writes;
    wire                   full;                    // there is no place in the next cycle

    always @(posedge clk)
        if (rst)
            settled <= 1'b0;
        else if (through) begin
            settled        <= blended_valid;
            settled_writes <= blended_writes;
            settled_rgba   <= blended_rgba;
            settled_pixel  <= done_pixel;
        end

    cache_places #(
        .WRITE_FIFO(WRITE_FIFO), .NUMBER_BITS(NUMBER_BITS), .OWN(NONBLOCKING == 0)
    ) places (
        .clk(clk), .rst(rst), .through(through), .take(looks), .take_line(door_line),
        .settle(settled), .settle_writes(settled_writes), .settle_line(settled_line), .granted(written_valid),
        .full(full), .ask(NONBLOCKING != 0 ? next_alive & ~next_hit : waiting & ~evicted),
        .asked(NONBLOCKING != 0 ? next_line : missed_line), .unsettled(unsettled)
    );

    // ---- blends ----

    wire           [29:0] next_pixel = arrives ? {colour_y, colour_x} : door_pixel;
    wire                  next_alive = arrives ? ~colour_dead : door_valid & ~colour_gone & ~door_dead;

    cache_blends #(
        .BLEND_CYCLES(BLEND_CYCLES), .PIXEL_BITS(30), .PLACE_BITS(PLACE_BITS), .NEXT(NONBLOCKING == 0)
    ) blending (
        .clk(clk), .rst(rst), .read(reads), .read_pixel(read_pixel), .read_at(read_at),
        .known_at(known_at), .done_pixel(done_pixel), .done_at(done_at),
        .done_replaced(done_replaced), .any(blends), .install(miss_pops & through), .install_at(front_at),
        .ask(NONBLOCKING != 0 ? waiting & ~evicted : next_alive & count_next == 0),
        .asked(NONBLOCKING != 0 ? front_pixel : next_pixel), .hazard(hazard)
    );

    // ---- whether the fragment at the door goes in the next cycle ----

    wire                   next_valid = arrives | (door_valid & ~colour_gone);
    wire                   next_hit   = arrives ? arriving_hit : door_hit;
    wire [NUMBER_BITS-1:0] next_line  = arrives ? arriving : door_line;
    reg                    blocked;
    integer m;

    always @* begin
        m       = 0;
        blocked = 1'b0;
        if (NONBLOCKING == 0)
            blocked = count_next != 0 | (next_alive & full);
        else if (next_alive) begin
            blocked = count_next == FULL[DEPTH_BITS:0] | full;
            if (!next_hit && !blocked) begin
                blocked = miss_count_next == ALL_MISSES[MISS_BITS:0]
                          | (pending & write_line == next_line) | unsettled
                          | (misses & replaces & victim == next_line);
                for (m = 0; m < MISSES; m = m + 1)
                    if (leaving[m] && victims[m] == next_line && !(passes && front_misses && m[MISS_BITS-1:0] == first_miss))
                        blocked = 1'b1;
            end
        end
    end

    wire hazardous = NONBLOCKING == 0 & next_alive & ~blocked & hazard;

    always @(posedge clk) begin
        colour_hazard <= ~rst & hazardous;
        colour_gone   <= ~rst & next_valid & ~blocked & ~hazardous;
        colour_ready  <= rst | ~next_valid | (~blocked & ~hazardous);
    end
endmodule
