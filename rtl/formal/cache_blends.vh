// cache_blends.vh - of cache_blends.v: it is the shift register that its header draws (docs/timing.md, section 7, "Hazard").
//
//: of cache_blends
//: proves the slots are a shift register of the reads of the last BLEND_CYCLES cycles: what was read when is told when it is due
//: proves a pixel whose blend is under way is a hazard, and no other; a line that was replaced meanwhile is told
//: at BLEND_CYCLES=4 PIXEL_BITS=3 PLACE_BITS=2 NEXT=1
//: at BLEND_CYCLES=5 PIXEL_BITS=3 PLACE_BITS=2 NEXT=0
//: at BLEND_CYCLES=3 PIXEL_BITS=3 PLACE_BITS=2 NEXT=0
//: by induction 1
//: covers 8
//: breaks 8 cache_blends.v s/now - 2/now - 1/
//: breaks 8 cache_blends.v s/live.done. <= 1.b0/live[done] <= live[done]/
//: breaks 8 cache_blends.v s/i.SLOT_BITS-1:0. == done/i[SLOT_BITS-1:0] == now/

// The shift register itself: of age 1, read in the cycle before, to BLEND_CYCLES - 1.
reg [BLEND_CYCLES-1:1] formal_live, formal_gone; // gone: another line took its place
reg [PIXEL_BITS-1:0]   formal_pixel [0:BLEND_CYCLES-1];
reg [PLACE_BITS-1:0]   formal_place [0:BLEND_CYCLES-1];
integer formal_i;
always @(posedge clk) begin
    formal_live <= rst ? 0 : {formal_live, read};
    formal_pixel[1] <= read_pixel;
    formal_place[1] <= read_at;
    formal_gone[1]  <= 1'b0;
    for (formal_i = 2; formal_i < BLEND_CYCLES; formal_i = formal_i + 1) begin
        formal_pixel[formal_i] <= formal_pixel[formal_i-1];
        formal_place[formal_i] <= formal_place[formal_i-1];
        formal_gone[formal_i]  <= formal_gone[formal_i-1] || (install && install_at == formal_place[formal_i-1]);
    end
end

genvar formal_a;
generate
    for (formal_a = 1; formal_a < BLEND_CYCLES; formal_a = formal_a + 1) begin : formal_age
        wire [SLOT_BITS:0] slot = now >= formal_a ? now - formal_a : now + BLEND_CYCLES - formal_a;
        always @*
            if (started) begin
                assert (live[slot] == formal_live[formal_a]);
                if (formal_live[formal_a])
                    assert (pixels[slot] == formal_pixel[formal_a] && places[slot] == formal_place[formal_a]
                            && replaced[slot] == formal_gone[formal_a]);
            end
    end
endgenerate

reg formal_hazard;
always @* begin
    formal_hazard = NEXT != 0 && read && read_pixel == asked;
    for (formal_i = 1; formal_i < BLEND_CYCLES; formal_i = formal_i + 1)
        if (formal_live[formal_i] && formal_pixel[formal_i] == asked && !(NEXT != 0 && formal_i == BLEND_CYCLES - 1))
            formal_hazard = 1'b1;
    if (started) begin
        assert (now < BLEND_CYCLES && !live[now]);
        assert (any == |formal_live);
        if (formal_live[2])
            assert (known_at == formal_place[2]);
        if (formal_live[BLEND_CYCLES-1])
            assert (done_pixel == formal_pixel[BLEND_CYCLES-1] && done_at == formal_place[BLEND_CYCLES-1]
                    && done_replaced == formal_gone[BLEND_CYCLES-1]);
        if (ask)
            assert (hazard == formal_hazard);
        if (!rst) begin
            cover (&formal_live && ask && !hazard);
            cover (hazard && NEXT == 0 || hazard && !read);
            cover (formal_live[BLEND_CYCLES-1] && done_replaced);
        end
    end
end
