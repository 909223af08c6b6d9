// cache_places.vh - of cache_places.v: places of the write FIFO are taken in turn and released once (docs/timing.md,
// section 7, "Written through").
//
//: of cache_places
//: proves an access never takes a place that is taken, and the queue of writes never over- or underflows
//: proves an access settles with its own line, in order, once; its place is released when it is not written, or its write has the bus
//: proves a line is told as unsettled from the look-up of an access to it until its place is released
//: at WRITE_FIFO=3 NUMBER_BITS=3 OWN=0
//: at WRITE_FIFO=4 NUMBER_BITS=3 OWN=1
//: at WRITE_FIFO=1 NUMBER_BITS=3 OWN=0
//: by induction 2
//: covers 12
//: breaks 10 cache_places.v s/kept.writing.first_write.. = 1.b0/kept[first_write] = 1'b0/
//: breaks 10 cache_places.v s/kept.next. . .take . next == taking../kept[taking])/
//: breaks 10 cache_places.v s/settling <= after.settling./settling <= settling/

// Of the accesses that took places and were not released the oldest are settled, and of those that will be written; the
// rest is not. Accesses in turn have the places from formal_first on.
reg [PLACE_BITS:0] formal_open, formal_writes; // taken and not settled; settled, to be written and not granted
reg formal_full;
always @(posedge clk) begin
    formal_open   <= rst ? 0 : formal_open + (through && take) - (through && settle);
    formal_writes <= rst ? 0 : formal_writes + (through && settle && settle_writes) - (through && granted);
    formal_full   <= !rst && full;
end

// ---- what is asked of the cache ----

reg formal_through;
always @(posedge clk) formal_through <= through;
always @*
    if (started && !rst) begin
        `REQUIRE (through == formal_through);
        `REQUIRE (!take || !formal_full);
        `REQUIRE (!settle || !through || formal_open != 0);
        `REQUIRE (!granted || !through || formal_writes != 0);
    end

// ---- all places ----

function [PLACE_BITS:0] formal_at(input [PLACE_BITS:0] from, input [PLACE_BITS:0] steps);
    formal_at = from + steps >= WRITE_FIFO ? from + steps - WRITE_FIFO : from + steps;
endfunction

reg [WRITE_FIFO-1:0] formal_taken; // what the two queues say of each place
integer formal_i;
always @* begin
    formal_taken = 0;
    for (formal_i = 0; formal_i < WRITE_FIFO; formal_i = formal_i + 1) begin
        if (formal_i < formal_open)
            formal_taken[formal_at(settling, formal_i)] = 1'b1;
        if (formal_i < formal_writes)
            formal_taken[writing[formal_at(first_write, formal_i)]] = 1'b1;
    end
end

function [PLACE_BITS:0] formal_ones(input [WRITE_FIFO-1:0] of);
    integer n;
    begin
        formal_ones = 0;
        for (n = 0; n < WRITE_FIFO; n = n + 1)
            formal_ones = formal_ones + of[n];
    end
endfunction

always @*
    if (started && !rst && through) begin
        assert (taken == formal_taken && formal_ones(taken) == formal_open + formal_writes); // no place twice
        assert (formal_open + formal_writes <= WRITE_FIFO);
        assert (settling < WRITE_FIFO && taking < WRITE_FIFO && first_write < WRITE_FIFO && last_write < WRITE_FIFO);
        assert (formal_at(settling, formal_open) == taking && formal_at(first_write, formal_writes) == last_write);
        assert (formal_full == taken[taking]);
        assert (!take || !taken[taking]);
    end

generate
    genvar formal_w;
    for (formal_w = 0; formal_w < WRITE_FIFO; formal_w = formal_w + 1) begin : formal_write
        always @*
            if (started && !rst && through && formal_w < formal_writes)
                assert (writing[formal_at(first_write, formal_w)] < WRITE_FIFO);
    end
endgenerate

// ---- one access, any ----

localparam [1:0] NONE = 0, OPEN = 1, WRITES = 2;
(* anyseq *) reg formal_pick;
reg             [1:0] formal_state;
reg    [PLACE_BITS:0] formal_ahead; // of those as open, or as much to be written, as it
reg  [PLACE_BITS-1:0] formal_place;
reg [NUMBER_BITS-1:0] formal_line;
wire formal_settles = formal_state == OPEN && settle && formal_ahead == 0;
wire formal_ends    = (formal_settles && !settle_writes) || (formal_state == WRITES && granted && formal_ahead == 0);
always @(posedge clk)
    if (rst)
        formal_state <= NONE;
    else if (through) begin
        if (formal_state == NONE || formal_ends) begin
            formal_state <= take && formal_pick ? OPEN : NONE;
            formal_ahead <= formal_open - settle;
            formal_place <= taking;
            formal_line  <= take_line;
        end else if (formal_settles) begin
            formal_state <= WRITES;
            formal_ahead <= formal_writes - granted;
        end else
            formal_ahead <= formal_ahead - (formal_state == OPEN ? settle : granted);
    end

always @*
    if (started && !rst && through && formal_state != NONE) begin
        assert (formal_state <= WRITES && taken[formal_place] && lines[formal_place] == formal_line);
        if (formal_state == OPEN)
            assert (formal_ahead < formal_open && formal_at(settling, formal_ahead) == formal_place);
        if (formal_state == WRITES)
            assert (formal_ahead < formal_writes && writing[formal_at(first_write, formal_ahead)] == formal_place);
        if (formal_settles)
            assert (settle_line == formal_line);
        if (ask && asked == formal_line && !formal_ends && !(OWN != 0 && own == formal_place))
            assert (unsettled);
        cover (formal_state == WRITES && formal_ends);
        cover (formal_state == OPEN && formal_ends && full || WRITE_FIFO == 1 && formal_ends);
    end
