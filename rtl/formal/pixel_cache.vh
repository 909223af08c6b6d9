// pixel_cache.vh - of pixel_cache.v, with all that it consists of: one pixel, any, is followed through the cache, the blender
// and the memory behind (docs/architecture.md, section 9; docs/timing.md, section 7).
//
// The blender answers when it must, with any pixel; memory takes writes in order, whenever it likes, and answers fills in
// order, whenever it likes, with what it held when the fill was wanted: fills go before the writes that wait.
//
//: of pixel_cache
//: proves a pixel that is read is what was last blended, from its first miss on, however often its line has left and come back
//: proves no pixel is read while a blend of it is under way; no dirty line is lost: when the cache is idle memory has what was last blended
//: proves fills and writes never exceed what the frame buffer has room for
//: at FB_BITS=2 LINE_W=2 CACHE_BYTES=2 WAYS=1 BLEND_CYCLES=3 WRITE_FIFO=2
//: by bounded 18
//: solver abc
//: covers 24
//: without all but 8 pixels of a row, in 4 lines, and one bit of each, and line_of(), which numbers lines; the cache does not look at what pixels are
//: shrinks pixel_cache.v s/^( +input +.14:0. +)colour_([xy]),/\1whole_\2,/
//: shrinks pixel_cache.v s/^( +input +.*)(filled_data|blended_rgba),/\1whole_\2,/
//: shrinks pixel_cache.v s/^ +localparam PIXEL  .*/wire [14:0] colour_x = {12'd0, whole_x[2:0]}, colour_y = 15'd0;\n&/
//: shrinks pixel_cache.v s/^ +localparam PIXEL  .*/&\nwire [PIXEL-1:0] blended_rgba = whole_blended_rgba[0]; wire [2*PIXEL-1:0] filled_data = {7'd0, whole_filled_data[8], 7'd0, whole_filled_data[0]};/
//: shrinks pixel_cache.v s/^( +localparam NUMBER_BITS =).*/\1 6;/
//: shrinks pixel_cache.v /function .NUMBER_BITS-1:0. line_of/,/endfunction/d
//: shrinks pixel_cache.v s/arriving = line_of.*/arriving = {4'd0, colour_x[2:1]};/
//: hole which line a pixel has, line_of(), is not proved: a product of two 16-bit registers; vectors and lock-step compare its addresses
//: hole a hit gives what was last written is bounded for the whole cache; of its parts, cache_lines and cache_tags, it is proved by induction
//: hole a non-blocking cache, several ways and BLEND_CYCLES over 3 as a whole: their bounded proofs were not run to the end; their parts are proved
//: breaks 20 pixel_cache.v s/evicts  = front_replaces . .dirty/evicts  = front_replaces \& 1'b0 \& (dirty/
//: breaks 20 pixel_cache.v s/if .soils.$/if (1'b0)/

localparam FORMAL_FILLS = NONBLOCKING != 0 ? NONBLOCKING_MISSES : 1;

// ---- registers hold still; what the frame, the texture unit and the blender do ----

(* anyconst *) reg formal_index, formal_policy, formal_clear, formal_layout;
(* anyconst *) reg [1:0] formal_replacement;
reg [BLEND_CYCLES:1] formal_read, formal_wrote; // so many cycles ago; whether it is written
always @(posedge clk) begin
    formal_read  <= rst ? 0 : {formal_read, reads};
    formal_wrote <= {formal_wrote, blended_known && blended_known_writes};
end

always @* begin
    assume ({index, write_policy, clear_on_first_touch, fb_layout, replacement}
            == {formal_index, formal_policy, formal_clear, formal_layout, formal_replacement});
    assume (replacement != 2'd3);
    assume (!colour_valid || !texture_unit_idle);
    if (started) begin
        assume (blended_known == formal_read[2]);
        assume (blended_valid == formal_read[BLEND_CYCLES-1]);
        if (BLEND_CYCLES == 3)
            assume (blended_writes == blended_known_writes);
        else
            assume (blended_writes == formal_wrote[BLEND_CYCLES-3]);
    end
end

// ---- a pixel, and what was last blended into it ----

(* anyconst *) reg [2:0] formal_x;
(* anyconst *) reg formal_first;
reg  [PIXEL-1:0] formal_truth;
wire [29:0]      formal_pixel   = {27'd0, formal_x};
wire [47:0]      formal_address = {45'd0, formal_x[2:1], 1'b0}; // of its line; a pixel has a byte
wire             formal_offset  = formal_x[0];
wire             formal_ends    = blended_valid && done_pixel == formal_pixel; // a blend of it
always @* if (formal_clear) assume (formal_first == 0);

reg formal_was_read;
always @(posedge clk) begin
    if (rst)
        formal_truth <= formal_first;
    else if (formal_ends && blended_writes)
        formal_truth <= blended_rgba;
    formal_was_read <= !rst && reads && (hits ? {door_y, door_x} : front_pixel) == formal_pixel;
end

// ---- memory: writes that wait, fills that were wanted; of them what there is of the pixel ----

localparam FORMAL_WRITES = WRITE_FIFO > 1 ? WRITE_FIFO : 1;
reg [PIXEL-1:0] formal_memory;
reg [FORMAL_WRITES-1:0] formal_write_is; // of each that waits, the oldest lowest: it has the pixel
reg [PIXEL-1:0] formal_write_value [0:FORMAL_WRITES-1];
reg [3:0] formal_writes, formal_fills;
reg [FORMAL_FILLS-1:0] formal_fill_is;
reg [PIXEL-1:0] formal_fill_value [0:FORMAL_FILLS-1];

wire formal_line_write = write_bytes != 1;
wire formal_is = formal_line_write ? write_address == formal_address : write_address == {45'd0, formal_x};
wire [PIXEL-1:0] formal_value = formal_line_write && formal_offset ? write_data[2*PIXEL-1:PIXEL] : write_data[PIXEL-1:0];
wire [PIXEL-1:0] formal_memory_now = written_valid && formal_write_is[0] ? formal_write_value[0] : formal_memory;
wire [3:0] formal_writes_left = formal_writes - written_valid, formal_fills_left = formal_fills - filled_valid;
integer formal_i;

always @(posedge clk)
    if (rst) begin
        formal_memory <= formal_first;
        formal_writes <= 0;
        formal_fills  <= 0;
    end else begin
        formal_memory <= formal_memory_now;
        formal_writes <= formal_writes_left + write_valid;
        formal_fills  <= formal_fills_left + fill_valid;
        if (written_valid) begin
            formal_write_is <= formal_write_is >> 1;
            for (formal_i = 1; formal_i < FORMAL_WRITES; formal_i = formal_i + 1)
                formal_write_value[formal_i-1] <= formal_write_value[formal_i];
        end
        if (write_valid) begin
            formal_write_is[formal_writes_left]    <= formal_is;
            formal_write_value[formal_writes_left] <= formal_value;
        end
        if (filled_valid) begin
            formal_fill_is <= formal_fill_is >> 1;
            for (formal_i = 1; formal_i < FORMAL_FILLS; formal_i = formal_i + 1)
                formal_fill_value[formal_i-1] <= formal_fill_value[formal_i];
        end
        if (fill_valid) begin
            formal_fill_is[formal_fills_left]    <= fill_address == formal_address;
            formal_fill_value[formal_fills_left] <= formal_memory_now;
        end
    end

always @*
    if (started) begin
        assume (!written_valid || formal_writes != 0);
        assume (!filled_valid || formal_fills != 0);
        if (filled_valid && formal_fill_is[0])
            assume (filled_data[formal_offset*PIXEL +: PIXEL] == formal_fill_value[0]);
    end

// ---- what must hold ----

always @*
    if (started && !rst) begin
        if (formal_was_read) begin
            assert (pixel_valid && pixel_rgba == formal_truth);
            assert (!formal_ends);
        end
        if (report_idle && formal_writes == 0)
            assert (formal_memory == formal_truth);
        assert (!report_idle || (dirty == 0 && !write_valid));
        assert (!fill_valid || formal_fills_left < FORMAL_FILLS);
        assert (!write_valid || formal_writes_left < (through ? WRITE_FIFO : 1));
        assert (!colour_gone || door_valid);
        assert (!colour_ready || !door_valid || colour_gone);
    end

// ---- reached ----

reg [1:0] formal_misses; // of the pixel's line
always @(posedge clk)
    formal_misses <= rst ? 0 : formal_misses + (misses && door_line == formal_address >> 1 && formal_misses != 3);
always @*
    if (started && !rst) begin
        cover (formal_was_read && formal_misses == 2 && formal_truth == 1 && formal_first == 0 && !through);
        cover (formal_was_read && formal_misses == 2 && formal_truth == 1 && formal_first == 0 && through);
        cover (report_idle && formal_memory == 1 && formal_first == 0 && formal_clear);
        cover (colour_hazard && !through || NONBLOCKING != 0 && hazard && !through);
    end
