// cache_queue.vh - of cache_queue.v: accesses are read in the order in which they were looked up, once each, misses with
// the line that they replace (docs/timing.md, section 7).
//
//: of cache_queue
//: proves the queues of accesses and of misses never over- or underflow, and there are as many misses in the one as in the other
//: proves an access leaves the queue unchanged, in order, once; a miss meets the line that it replaces
//: proves a line is told as leaving from the push of the miss that replaces it until it is out of the way
//: at DEPTH=4 MISSES=3 NUMBER_BITS=3 PLACE_BITS=2 PIXEL_BITS=3
//: at DEPTH=1 MISSES=1 NUMBER_BITS=3 PLACE_BITS=2 PIXEL_BITS=3
//: quick
//: by induction 2
//: covers 10
//: breaks 8 cache_queue.v s/miss_pops += pops . front_misses/miss_pops = pops/
//: breaks 8 cache_queue.v s/first_miss <= after.first_miss./first_miss <= first_miss + 1'b1/
//: breaks 8 cache_queue.v s/leaves.last_miss. +<= push_replaces/leaves[last_miss] <= 1'b0/

// ---- what is asked of the cache ----

reg formal_full, formal_misses_full;
always @(posedge clk) {formal_full, formal_misses_full} <= {!rst && full, !rst && misses_full};
always @*
    if (started && !rst) begin
        `REQUIRE (!push || !formal_full);
        `REQUIRE (!(push && push_misses) || !formal_misses_full);
        `REQUIRE (!pops || waits);
        `REQUIRE (!clears || waits);
        `REQUIRE (!clears_clean || clears);
    end

// ---- how many misses there are among the first accesses ----

reg [DEPTH_BITS:0] formal_misses [0:DEPTH];
reg [PLACE_BITS+PIXEL_BITS+2:0] formal_access;
integer formal_i;
always @* begin
    formal_misses[0] = 0;
    for (formal_i = 0; formal_i < DEPTH; formal_i = formal_i + 1) begin
        formal_access = accesses[(first + formal_i) % (1 << DEPTH_BITS)];
        formal_misses[formal_i + 1] = formal_misses[formal_i] + formal_access[PLACE_BITS+PIXEL_BITS+2];
    end
end

wire [MISS_BITS+1:0] formal_end = first_miss + miss_count;
always @*
    if (started && !rst) begin
        assert (count <= DEPTH && miss_count <= MISSES);
        assert (last == ((first + count) & ((1 << DEPTH_BITS) - 1)));
        assert (first_miss < MISSES && last_miss < MISSES);
        assert (last_miss == (formal_end >= MISSES ? formal_end - MISSES : formal_end));
        assert (miss_count == formal_misses[count]);
    end

// ---- one access, any ----

(* anyseq *) reg formal_pick;
reg                             formal_tracked, formal_leaves;
reg [PLACE_BITS+PIXEL_BITS+2:0] formal_pushed;
reg           [NUMBER_BITS-1:0] formal_victim;
reg              [DEPTH_BITS:0] formal_ahead;
wire formal_front  = formal_tracked && formal_ahead == 0;
wire formal_misses_too = formal_pushed[PLACE_BITS+PIXEL_BITS+2];
always @(posedge clk)
    if (rst)
        formal_tracked <= 1'b0;
    else if (!formal_tracked || (formal_front && pops)) begin
        formal_tracked <= push && formal_pick;
        formal_pushed  <= {push_misses, push_fills, push_replaces, push_at, push_pixel};
        formal_victim  <= push_victim;
        formal_ahead   <= count - pops;
        formal_leaves  <= push_misses && push_replaces;
    end else begin
        formal_ahead  <= formal_ahead - pops;
        formal_leaves <= formal_leaves && !(formal_front && clears);
    end

wire [MISS_BITS+1:0] formal_sum  = first_miss + formal_misses[formal_ahead];
wire [MISS_BITS+1:0] formal_miss = formal_sum >= MISSES ? formal_sum - MISSES : formal_sum;
always @*
    if (started && !rst && formal_tracked) begin
        assert (formal_ahead < count && (!formal_leaves || formal_misses_too));
        assert (accesses[(first + formal_ahead) & ((1 << DEPTH_BITS) - 1)] == formal_pushed);
        if (formal_misses_too)
            assert (victims[formal_miss] == formal_victim && leaves[formal_miss] == formal_leaves);
        if (formal_front) begin
            assert (waits && {front_misses, front_fills, front_replaces, front_at, front_pixel} == formal_pushed);
            if (formal_misses_too)
                assert (victim == formal_victim);
        end
        if (formal_leaves && ask && asked == formal_victim && !(formal_front && clears_clean))
            assert (leaving);
        cover (formal_front && formal_misses_too && pops && count == DEPTH);
        cover (formal_leaves && formal_ahead != 0 && leaving || DEPTH == 1 && leaving);
    end
