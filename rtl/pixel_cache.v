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
//   colour ─► door ─► cache_tags ─► cache_queue ─► evict ─► fill ─► read ─► pixel
//              │    cache_touched                    │       ▲       ▲ └──► cache_blends
//              └─── hits, when it is blocking ───────┼───────┼───────┤           │
//                                                    │     filled  cache_lines ◄─┴─ blended ─► dirty, cache_places
//                                                    └─► write buffer ─► write ◄──────────────────────────┘
//
// Here are the door, the stage behind it, the write buffer and the flush.
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
    output                 [4*FB_BITS-1:0] pixel_rgba,
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
    output   [4*FB_BITS*LINE_W*LINE_H-1:0] write_data,
    input                                  written_valid,

    input                                  volume_divider_idle,
    input                                  slice_generator_idle,
    input                                  rasterizer_idle,
    input                                  texture_unit_idle,
    output reg                       [3:0] report_status,
    output reg                             report_idle
);
    localparam PIXEL       = 4 * FB_BITS;
    localparam LINE_PIXELS = LINE_W * LINE_H;
    localparam LINES       = 8 * CACHE_BYTES / (PIXEL * LINE_PIXELS);
    localparam PLACE_BITS  = LINES > 1 ? $clog2(LINES) : 1;
    localparam W_BITS      = $clog2(LINE_W);
    localparam H_BITS      = $clog2(LINE_H);
    localparam NUMBER_BITS = 28 - W_BITS - H_BITS; // a frame has up to 16384x16384 pixels
    localparam DEPTH       = NONBLOCKING != 0 ? NONBLOCKING_FIFO : 1;
    localparam MISSES      = NONBLOCKING != 0 ? NONBLOCKING_MISSES : 1;
    localparam [31:0] X_MASK = LINE_W - 1, Y_MASK = LINE_H - 1, PIXEL_BYTES = PIXEL / 8,
                      LINE_BYTES = PIXEL * LINE_PIXELS / 8;

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

    // Its index in its line.
    function [9:0] offset_of(input [4:0] x, input [4:0] y);
        offset_of = {5'b0, y & Y_MASK[4:0]} << W_BITS | {5'b0, x & X_MASK[4:0]};
    endfunction

    function [47:0] address_of(input [NUMBER_BITS-1:0] number, input [9:0] offset);
        address_of = ({{(48-NUMBER_BITS){1'b0}}, number} << (W_BITS + H_BITS) | {38'b0, offset}) << $clog2(PIXEL / 8);
    endfunction

    // ---- the door ----

    wire through = write_policy == `VODR_WRITE_POLICY_THROUGH;
    wire arrives = colour_valid & colour_ready;
    reg  door_valid, door_dead;
    reg  [14:0] door_x, door_y;
    reg  [NUMBER_BITS-1:0] arriving;

    always @* begin
        arriving = 0;
        if (arrives)
            arriving = line_of(colour_x, colour_y, fb_layout == `VODR_FB_LAYOUT_TILED, lines_across);
    end

    always @(posedge clk) begin
        door_valid <= ~rst & (arrives | (door_valid & ~colour_gone));
        if (arrives) begin
            door_dead <= colour_dead;
            door_x    <= colour_x;
            door_y    <= colour_y;
        end
    end

    // ---- the look-up ----

    wire looks = colour_gone & ~door_dead;
    wire arriving_hit, door_hit, replaces, touches; // touches: its line's first miss of the frame, which is zeros
    wire [NUMBER_BITS-1:0] door_line, victim;
    wire [PLACE_BITS-1:0] at;
    wire misses = looks & ~door_hit;
    wire hits   = looks & door_hit & NONBLOCKING == 0; // it is read in this cycle, too
    wire flushes;
    reg  [PLACE_BITS-1:0] flush_at;

    cache_tags #(
        .SETS(LINES / WAYS), .WAYS(WAYS), .NUMBER_BITS(NUMBER_BITS), .PLACE_BITS(PLACE_BITS)
    ) the_tags (
        .clk(clk), .rst(rst), .index(index), .replacement(replacement), .arrives(arrives), .arriving(arriving),
        .arriving_hit(arriving_hit), .line(door_line), .hit(door_hit), .look_up(looks), .flush(flushes),
        .flush_at(flush_at), .at(at), .replaces(replaces), .victim(victim)
    );

    cache_touched #(
        .FRAME_LINES(FRAME_LINES), .NUMBER_BITS(NUMBER_BITS)
    ) the_touched (
        .clk(clk), .rst(rst), .clear_on_first_touch(clear_on_first_touch), .misses(misses), .line(door_line),
        .first(touches)
    );

    always @(posedge clk) begin
        look_up_valid    <= looks & ~rst;
        look_up_miss     <= misses;
        look_up_replaced <= misses & replaces;
        look_up_x        <= door_x;
        look_up_y        <= door_y;
    end

    // ---- the fragment that is at the door in the next cycle ----

    wire next_valid = arrives | (door_valid & ~colour_gone);
    wire next_alive = arrives ? ~colour_dead : door_valid & ~colour_gone & ~door_dead;
    wire next_miss  = next_alive & ~(arrives ? arriving_hit : door_hit);
    wire [29:0] next_pixel = arrives ? {colour_y, colour_x} : {door_y, door_x};
    wire [NUMBER_BITS-1:0] next_line = arrives ? arriving : door_line;

    // ---- looked up and not read ----

    reg  evicted;                // what the oldest access replaces is out of the way
    reg  passes, moves, pops;    // in this cycle: nothing is in the way, the line moves to the write buffer; it is read
    wire waits, front_misses, front_fills, front_replaces, wants, full, misses_full, leaving;
    wire [29:0] front_pixel;
    wire [PLACE_BITS-1:0] front_at;
    wire [NUMBER_BITS-1:0] missed_line, front_victim;

    cache_queue #(
        .DEPTH(DEPTH), .MISSES(MISSES), .NUMBER_BITS(NUMBER_BITS), .PLACE_BITS(PLACE_BITS), .PIXEL_BITS(30)
    ) the_queue (
        .clk(clk), .rst(rst), .push(looks & ~hits), .push_misses(misses), .push_fills(misses & ~touches),
        .push_replaces(replaces), .push_victim(victim), .push_line(door_line), .push_at(at),
        .push_pixel({door_y, door_x}), .wants(wants), .line(missed_line), .waits(waits), .front_misses(front_misses),
        .front_fills(front_fills), .front_replaces(front_replaces), .front_at(front_at), .front_pixel(front_pixel),
        .victim(front_victim), .clears(passes | moves), .clears_clean(passes), .pops(pops), .full(full),
        .misses_full(misses_full), .ask(NONBLOCKING != 0 & next_miss), .asked(next_line), .leaving(leaving)
    );

    // ---- pixels that are being blended ----

    wire reads = pops | hits;
    wire blends, hazard, done_replaced;
    /* verilator lint_off UNUSEDSIGNAL */ // where it lies in its line is enough
    wire [29:0] done_pixel;
    /* verilator lint_on UNUSEDSIGNAL */
    wire [PLACE_BITS-1:0] known_at, done_at;

    // A blocking cache looks for hazards at the door, a non-blocking one before the read.
    cache_blends #(
        .BLEND_CYCLES(BLEND_CYCLES), .PIXEL_BITS(30), .PLACE_BITS(PLACE_BITS), .NEXT(NONBLOCKING == 0)
    ) the_blends (
        .clk(clk), .rst(rst), .read(reads), .read_pixel(hits ? {door_y, door_x} : front_pixel),
        .read_at(hits ? at : front_at), .known_at(known_at), .done_pixel(done_pixel), .done_at(done_at),
        .done_replaced(done_replaced), .install(pops & front_misses & through), .install_at(front_at), .any(blends),
        .ask(NONBLOCKING != 0 ? waits & ~evicted : next_alive & ~full),
        .asked(NONBLOCKING != 0 ? front_pixel : next_pixel), .hazard(hazard)
    );

    // ---- written through: each access has a place of the write FIFO ----

    reg  settled, settled_writes; // a blend was over in the cycle before
    reg  [9:0] settled_offset;
    reg  [PIXEL-1:0] settled_rgba;
    wire settles = settled & settled_writes;
    wire no_place, unsettled;
    wire [NUMBER_BITS-1:0] settled_line;

    always @(posedge clk)
        if (rst)
            settled <= 1'b0;
        else if (through) begin
            settled        <= blended_valid;
            settled_writes <= blended_writes;
            settled_offset <= offset_of(done_pixel[4:0], done_pixel[19:15]);
            settled_rgba   <= blended_rgba;
        end

    cache_places #(
        .WRITE_FIFO(WRITE_FIFO), .NUMBER_BITS(NUMBER_BITS), .OWN(NONBLOCKING == 0)
    ) the_places (
        .clk(clk), .rst(rst), .through(through), .take(looks), .take_line(door_line), .settle(settled),
        .settle_writes(settled_writes), .settle_line(settled_line), .granted(written_valid), .full(no_place),
        .ask(NONBLOCKING != 0 ? next_miss : waits & ~evicted), .asked(NONBLOCKING != 0 ? next_line : missed_line),
        .unsettled(unsettled)
    );

    // ---- evict, fill, read ----

    reg  write_pending; // the write buffer holds write_line
    reg  [NUMBER_BITS-1:0] write_line;
    reg  [LINES-1:0] dirty;
    reg  just_read;
    reg  [3:0] status;
    wire pending = write_pending & ~written_valid;
    wire soils   = blended_known & blended_known_writes & ~through;
    wire evicts  = front_replaces & (dirty[front_at] | (soils & known_at == front_at));
    wire came;

    always @* begin
        {passes, moves, pops} = 3'b0;
        status = `STATUS_IDLE;
        if (waits) begin
            if (!evicted) begin
                if (NONBLOCKING != 0 && front_misses && just_read)
                    status = `STATUS_IDLE; // whether that pixel is written is not known yet
                else if (NONBLOCKING != 0 && hazard)
                    status = `STATUS_STALLED_HAZARD;
                else if (evicts) begin
                    moves  = ~pending & ~blends;
                    status = moves && NONBLOCKING == 0 ? `STATUS_STALLED_FILL : `STATUS_STALLED_WRITE_BACK;
                end else if (NONBLOCKING == 0 && (unsettled || (pending && write_line == missed_line)))
                    status = `STATUS_STALLED_WRITE_BACK;
                else begin
                    passes = 1'b1;
                    status = `STATUS_STALLED_FILL;
                end
            end
            if (evicted || (passes && NONBLOCKING != 0)) begin
                pops   = ~front_fills | came;
                status = pops ? `STATUS_BUSY : `STATUS_STALLED_FILL;
            end
        end
    end

    always @(posedge clk) begin
        evicted       <= ~rst & ~pops & (evicted | passes | moves);
        just_read     <= reads;
        pixel_valid   <= ~rst & reads;
        fill_valid    <= ~rst & (NONBLOCKING != 0 ? wants : front_fills & (passes | moves));
        fill_address  <= address_of(missed_line, 10'b0);
        report_status <= rst ? `STATUS_IDLE : hits ? `STATUS_BUSY : status;
    end

    cache_lines #(
        .PIXEL(PIXEL), .LINE_PIXELS(LINE_PIXELS), .LINES(LINES), .PLACE_BITS(PLACE_BITS), .MISSES(MISSES)
    ) the_lines (
        .clk(clk), .rst(rst), .filled_valid(filled_valid), .filled_data(filled_data), .came(came),
        .install(pops & front_misses), .zeros(~front_fills), .read(reads), .at(hits | flushes ? at : front_at),
        .offset(hits ? offset_of(door_x[4:0], door_y[4:0]) : offset_of(front_pixel[4:0], front_pixel[19:15])),
        .pixel(pixel_rgba), .move(moves | flushes), .settle(settles), .settle_pixel(settled_rgba),
        .leaving(write_data), .write(blended_valid & blended_writes & ~done_replaced), .write_at(done_at),
        .write_offset(offset_of(done_pixel[4:0], done_pixel[19:15])), .write_pixel(blended_rgba)
    );

    // ---- the flush, and what leaves ----

    wire empty = ~next_valid & ~waits & ~looks & ~blends
                 & volume_divider_idle & slice_generator_idle & rasterizer_idle & texture_unit_idle;
    wire [NUMBER_BITS-1:0] moved_line = flushes ? victim : front_victim;

    // By set, in a set by way.
    function [PLACE_BITS-1:0] first_of(input [LINES-1:0] places);
        integer p;
        begin
            first_of = 0;
            for (p = LINES - 1; p >= 0; p = p - 1)
                if (places[p])
                    first_of = p[PLACE_BITS-1:0];
        end
    endfunction

    assign flushes = empty & ~pending & |dirty;

    always @* begin
        flush_at = 0;
        if (flushes)
            flush_at = first_of(dirty);
    end

    always @(posedge clk)
        if (rst)
            dirty <= 0;
        else begin
            if (soils)
                dirty[known_at] <= 1'b1;
            if (moves | flushes)
                dirty[flushes ? flush_at : front_at] <= 1'b0;
        end

    always @(posedge clk) begin
        write_valid   <= ~rst & (moves | flushes | settles);
        write_pending <= ~rst & (moves | flushes | pending);
        report_idle   <= ~rst & empty & ~|dirty & ~settles;
        if (moves | flushes) begin
            write_line    <= moved_line;
            write_address <= address_of(moved_line, 10'b0);
            write_bytes   <= LINE_BYTES[13:0];
        end
        if (settles) begin
            write_address <= address_of(settled_line, settled_offset);
            write_bytes   <= PIXEL_BYTES[13:0];
        end
    end

    // ---- whether the fragment at the door goes in the next cycle ----

    wire in_use    = pending & write_line == next_line; // what memory holds of its line is old
    wire blocked   = NONBLOCKING == 0 ? full | (next_alive & no_place)
                     : (next_alive & (full | no_place)) | (next_miss & (misses_full | leaving | unsettled | in_use));
    wire hazardous = NONBLOCKING == 0 & next_alive & ~blocked & hazard;

    always @(posedge clk) begin
        colour_hazard <= ~rst & hazardous;
        colour_gone   <= ~rst & next_valid & ~blocked & ~hazardous;
        colour_ready  <= rst | ~next_valid | (~blocked & ~hazardous);
    end
endmodule
