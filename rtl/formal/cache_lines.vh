// cache_lines.vh - of cache_lines.v: one pixel of one line, any, is what was put there last; lines come in order.
//
//: of cache_lines
//: proves a read gives what was last written or installed at that place and pixel; a line that leaves has it too
//: proves lines that came are installed in their order, each once; their FIFO never over- or underflows
//: at PIXEL=2 LINE_PIXELS=2 LINES=4 PLACE_BITS=2 MISSES=3
//: at PIXEL=2 LINE_PIXELS=1 LINES=2 PLACE_BITS=1 MISSES=1
//: quick
//: by induction 1
//: covers 8
//: breaks 8 cache_lines.v s/lines.at. <= 0/lines[at] <= lines[at]/
//: breaks 8 cache_lines.v s/pixel <= filled.first.*/pixel <= lines[at][offset*PIXEL +: PIXEL];/
//: breaks 8 cache_lines.v s/first <= after.first./first <= first/

// ---- what is asked of the cache ----

always @*
    if (started && !rst) begin
        `REQUIRE (!takes || came);
        `REQUIRE (!filled_valid || count != MISSES);
        `REQUIRE (!install || (read && !move)); // a miss is read as it is installed
        `REQUIRE (offset < LINE_PIXELS && write_offset < LINE_PIXELS);
    end

// ---- one pixel ----

(* anyconst *) reg [PLACE_BITS-1:0] formal_at;
(* anyconst *) reg [9:0] formal_offset;
always @* assume (formal_at < LINES && formal_offset < LINE_PIXELS);
reg             formal_known; // it was put there
reg [PIXEL-1:0] formal_value;
wire            formal_read = read && at == formal_at && offset == formal_offset;
reg             formal_was_read, formal_left, formal_was_written;
reg [PIXEL-1:0] formal_was;

always @(posedge clk) begin
    if (rst)
        formal_known <= 1'b0;
    else if (install && at == formal_at) begin
        formal_known <= 1'b1;
        formal_value <= takes ? filled[first][formal_offset*PIXEL +: PIXEL] : 0;
    end else if (write && write_at == formal_at && write_offset == formal_offset) begin
        formal_known <= 1'b1;
        formal_value <= write_pixel;
    end
    formal_was_read <= !rst && formal_read && (formal_known || install);
    formal_left     <= !rst && move && !settle && at == formal_at && formal_known;
    formal_was      <= !install ? formal_value : takes ? filled[first][formal_offset*PIXEL +: PIXEL] : 0;
end

always @*
    if (started) begin
        if (formal_known)
            assert (lines[formal_at][formal_offset*PIXEL +: PIXEL] == formal_value);
        if (formal_was_read)
            assert (pixel == formal_was);
        if (formal_left)
            assert (leaving[formal_offset*PIXEL +: PIXEL] == formal_was);
    end

// ---- one line that came ----

(* anyseq *) reg formal_pick;
reg                         formal_tracked;
reg [PIXEL*LINE_PIXELS-1:0] formal_line;
reg           [MISS_BITS:0] formal_ahead;
wire                        formal_met = formal_tracked && takes && formal_ahead == 0;
always @(posedge clk)
    if (rst)
        formal_tracked <= 1'b0;
    else if (!formal_tracked || formal_met) begin
        formal_tracked <= filled_valid && formal_pick;
        formal_line    <= filled_data;
        formal_ahead   <= count - takes;
    end else
        formal_ahead <= formal_ahead - takes;

wire [MISS_BITS+1:0] formal_sum  = first + formal_ahead;
wire [MISS_BITS+1:0] formal_slot = formal_sum >= MISSES ? formal_sum - MISSES : formal_sum;
wire [MISS_BITS+1:0] formal_end  = first + count;
always @*
    if (started && !rst) begin
        assert (count <= MISSES && first < MISSES && last < MISSES);
        assert (last == (formal_end >= MISSES ? formal_end - MISSES : formal_end));
        if (formal_tracked) begin
            assert (formal_ahead < count && filled[formal_slot] == formal_line);
            if (formal_met)
                assert (filled[first] == formal_line);
        end
        cover (formal_met && count == MISSES);
        cover (formal_was_read && write && write_at == formal_at);
        cover (formal_left && formal_was == {PIXEL{1'b1}});
    end
