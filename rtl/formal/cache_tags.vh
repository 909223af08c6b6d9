// cache_tags.vh - of cache_tags.v: what it holds, and which line leaves (docs/architecture.md, section 9).
//
// Two lines, any two, are followed: whether each is held, and which of them was used, or filled, last.
//
//: of cache_tags
//: proves no two ways of a set hold one line; a line lies in its own set; ways fill from the lowest on
//: proves the ages of valid ways are a permutation; LRU and FIFO replace the line used, or filled, longest ago
//: proves a look-up hits just when the line was filled and has not been replaced since; the line in the way is the one said
//: at SETS=2 WAYS=4 NUMBER_BITS=4 PLACE_BITS=3
//: at SETS=1 WAYS=4 NUMBER_BITS=3 PLACE_BITS=2
//: at SETS=4 WAYS=1 NUMBER_BITS=5 PLACE_BITS=2
//: at SETS=4 WAYS=2 NUMBER_BITS=6 PLACE_BITS=3
//: by induction 2
//: covers 10
//: breaks 6 cache_tags.v s/misses && arriving == line/misses \&\& arriving == victim/
//: breaks 8 cache_tags.v s/ages.w.WAY_BITS .: WAY_BITS. == LAST/ages[w*WAY_BITS +: WAY_BITS] == 0/
//: breaks 8 cache_tags.v s/replacement == .VODR_REPLACEMENT_LRU/0/

// ---- what is asked of the door ----

reg formal_fresh; // a fragment is at the door that was not looked up
always @(posedge clk) formal_fresh <= !rst && (arrives || (formal_fresh && !look_up));

reg       formal_index;
reg [1:0] formal_replacement;
always @(posedge clk) {formal_index, formal_replacement} <= {index, replacement};

always @*
    if (started) begin
        `REQUIRE (rst || !look_up || formal_fresh);
        `REQUIRE (rst || !look_up || !flush);
        `REQUIRE (index == formal_index && replacement == formal_replacement); // registers hold still
        `REQUIRE (replacement != 2'd3);
    end

// ---- each set ----

genvar formal_s, formal_v, formal_w;
generate
    for (formal_s = 0; formal_s < SETS; formal_s = formal_s + 1) begin : formal_set
        wire          [WAYS-1:0] ways = used[formal_s] ? valid[formal_s] : 0;
        wire [WAYS*WAY_BITS-1:0] ages = order[formal_s];
        always @*
            if (started)
                assert ((ways & (ways + 1'b1)) == 0); // from the lowest on
        for (formal_v = 0; formal_v < WAYS; formal_v = formal_v + 1) begin : way
            wire [NUMBER_BITS-1:0] tag = tags[formal_s][formal_v*NUMBER_BITS +: NUMBER_BITS];
            wire    [WAY_BITS-1:0] age = ages[formal_v*WAY_BITS +: WAY_BITS];
            always @*
                if (started && ways[formal_v]) begin
                    assert (set_of(tag, index) == formal_s);
                    assert (ways[age] || WAYS == 1); // less than there are valid ways
                end
            for (formal_w = 0; formal_w < formal_v; formal_w = formal_w + 1) begin : pair
                always @*
                    if (started && ways[formal_v] && ways[formal_w]) begin
                        assert (tags[formal_s][formal_w*NUMBER_BITS +: NUMBER_BITS] != tag);
                        assert (ages[formal_w*WAY_BITS +: WAY_BITS] != age);
                    end
            end
        end
    end
endgenerate

// ---- the line at the door ----

wire                formal_in;
wire [WAY_BITS-1:0] formal_way;
assign {formal_in, formal_way} = found_in(used[set] ? valid[set] : 0, tags[set], line);

always @*
    if (started && formal_fresh)
        assert (set == set_of(line, index) && hit == formal_in && (!hit || hit_way == formal_way));

// ---- two lines ----

(* anyconst *) reg [NUMBER_BITS-1:0] formal_a, formal_b;
reg  formal_has_a, formal_has_b, formal_a_last; // filled and not replaced; a was used, or filled, after b
wire formal_used_a = look_up && line == formal_a && (!hit || replacement == `VODR_REPLACEMENT_LRU);
wire formal_used_b = look_up && line == formal_b && (!hit || replacement == `VODR_REPLACEMENT_LRU);
always @* assume (formal_a != formal_b);

always @(posedge clk) begin
    formal_has_a <= !rst && ((look_up && line == formal_a) || (formal_has_a && !(misses && replaces && victim == formal_a)));
    formal_has_b <= !rst && ((look_up && line == formal_b) || (formal_has_b && !(misses && replaces && victim == formal_b)));
    if (formal_used_a || formal_used_b)
        formal_a_last <= formal_used_a;
end

wire [SET_BITS-1:0] formal_set_a = set_of(formal_a, index), formal_set_b = set_of(formal_b, index);
wire                formal_in_a, formal_in_b;
wire [WAY_BITS-1:0] formal_way_a, formal_way_b;
assign {formal_in_a, formal_way_a} = found_in(used[formal_set_a] ? valid[formal_set_a] : 0, tags[formal_set_a], formal_a);
assign {formal_in_b, formal_way_b} = found_in(used[formal_set_b] ? valid[formal_set_b] : 0, tags[formal_set_b], formal_b);

always @*
    if (started) begin
        assert (formal_in_a == formal_has_a && formal_in_b == formal_has_b);
        if (formal_in_a && formal_in_b && formal_set_a == formal_set_b)
            assert (formal_a_last == (order[formal_set_a][formal_way_a*WAY_BITS +: WAY_BITS]
                                      < order[formal_set_b][formal_way_b*WAY_BITS +: WAY_BITS]));
        if (!rst && look_up && line == formal_a)
            assert (hit == formal_has_a);
        if (!rst && misses && replaces && victim == formal_a) begin
            assert (formal_has_a && line != formal_a);
            if (replacement != `VODR_REPLACEMENT_RANDOM && formal_has_b && formal_set_a == formal_set_b)
                assert (!formal_a_last); // b, any other line of the set, came later
        end
        if (!rst && look_up && line == formal_a && hit)
            assert (at == (SETS == 1 ? formal_way_a : WAYS == 1 ? formal_set_a : {formal_set_a, formal_way_a}));
    end

// ---- reached ----

always @*
    if (started && !rst) begin
        cover (misses && replaces && replacement == `VODR_REPLACEMENT_LRU);
        cover (misses && replaces && replacement == `VODR_REPLACEMENT_FIFO);
        cover (misses && replaces && replacement == `VODR_REPLACEMENT_RANDOM && index);
        cover (look_up && hit && formal_has_b && line == formal_a);
        cover (arrives && misses && arriving == line);
    end
