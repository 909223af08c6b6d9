// cache_touched.vh - of cache_touched.v: of one line, any, exactly the first miss of a frame is told
// (clear_on_first_touch; docs/architecture.md, section 9).
//
//: of cache_touched
//: proves a line's first miss since reset is told, and no other, whatever words of the table held before
//: at FRAME_LINES=256 NUMBER_BITS=8
//: at FRAME_LINES=4 NUMBER_BITS=6
//: quick
//: by induction 1
//: covers 6
//: breaks 5 cache_touched.v s/.used.word. . touched.word. : 64.b0./touched[word]/
//: breaks 5 cache_touched.v s/. .64.b1 << line.5:0..;/;/

(* anyconst *) reg [NUMBER_BITS-1:0] formal_line;
reg formal_missed, formal_clears;
always @(posedge clk) begin
    formal_missed <= !rst && (formal_missed || (misses && line == formal_line));
    formal_clears <= clear_on_first_touch;
end
wire [WORD_BITS-1:0] formal_word = WORDS > 1 ? formal_line[6 +: WORD_BITS] : 0;

always @*
    if (started) begin
        `REQUIRE (clear_on_first_touch == formal_clears);
        `REQUIRE (!misses || line < 64 * WORDS);
        assume (formal_line < 64 * WORDS);
        if (clear_on_first_touch)
            assert (formal_missed == (used[formal_word] && touched[formal_word][formal_line[5:0]]));
        if (misses && line == formal_line)
            assert (first == (clear_on_first_touch && !formal_missed));
        cover (!rst && first && line == formal_line && used == {WORDS{1'b1}});
        cover (!rst && misses && line == formal_line && !first && clear_on_first_touch);
    end
