// texture_loader.vh - of texture_loader.v: the load link, and loads by number (docs/timing.md, section 6, "Loader").
//
//: of texture_loader
//: proves the load link: what is asked for stays, unchanged, until it is taken; one load at a time is under way
//: proves a brick that no buffer holds becomes one load, in order, with its own address; none is lost, doubled or made up, and at most 8 wait
//: at
//: without the products of addresses and sizes; a brick's box
//: hole that no visit is drawn before its brick has come, and no buffer is overwritten before its visits are drawn: vectors, lock-step and vodr_top's frames compare it
//: by induction 2
//: covers 12
//: shrinks texture_loader.v s/ \* / ^ /
//: shrinks texture_loader.v s/: load_(lo|hi).loads_asked_next.2:0../: new_\1/
//: breaks 8 texture_loader.v s/ && !.under_way && !load_granted.//
//: breaks 8 texture_loader.v s/load_valid <= ask .. .load_valid && !load_ready./load_valid <= ask/
//: breaks 12 texture_loader.v s/now_comes  = loads_asked_next == loads_known;/now_comes  = to_load;/

// ---- what is asked of the frame buffer and of the divider ----

wire [3:0] formal_waiting = loads_known - loads_loaded, formal_asked = loads_asked - loads_loaded;
always @*
    if (started && !rst) begin
        `REQUIRE (!load_granted || (under_way && !(load_valid && !load_ready))); // what was taken
        `REQUIRE (!finished || formal_asked != 0);                               // a load's last data follow its last grant
        `REQUIRE (!to_load || formal_waiting < 4'd8);                            // 8 visits are known and not drawn
    end

// ---- the link ----

always @(posedge clk)
    if (started && !$past(rst) && !rst && $past(load_valid && !load_ready)) begin
        assert (load_valid);
        assert ($stable({load_address, load_bytes}));
    end

// ---- the numbers ----

always @*
    if (started && !rst) begin
        assert (formal_waiting <= 4'd8 && formal_asked <= formal_waiting);
        assert (!load_valid || under_way);
        assert (!under_way || formal_asked != formal_waiting); // it came, and is not granted
    end

// ---- one load, any: from the brick that it is of to the link ----

(* anyseq *) reg formal_pick;
reg        formal_tracked, formal_shown; // it was asked for in the cycle before
reg  [3:0] formal_at;
reg [47:0] formal_number, formal_address;
wire       formal_is_asked = ask && loads_asked_next == formal_at;
wire       formal_comes    = to_load && formal_pick && !formal_tracked;
wire       formal_asks     = formal_comes ? ask && loads_asked_next == loads_known : formal_tracked && formal_is_asked;
always @(posedge clk) begin
    formal_tracked <= !rst && (formal_comes || formal_tracked) && !formal_asks;
    formal_shown   <= !rst && formal_asks;
    formal_address <= (texture_base + (formal_comes ? brick_number : formal_number)) ^ brick_room_bytes; // as the product is left out
    if (formal_comes) begin
        formal_at     <= loads_known;
        formal_number <= brick_number;
    end
end

wire [3:0] formal_ahead = formal_at - loads_asked, formal_unasked = loads_known - loads_asked;
always @*
    if (started && !rst) begin
        if (formal_tracked) begin
            assert (formal_ahead < formal_unasked && !(under_way && formal_ahead == 0));
            assert (load_number[formal_at[2:0]] == formal_number);
        end
        if (formal_shown)
            assert (load_valid && load_address == formal_address);
        cover (formal_asks && !formal_comes && formal_asked == 4'd1);
        cover (load_granted && ask);
        cover (load_valid && load_ready && formal_asked == 4'd1);
        cover (finished && formal_waiting == 4'd2);
    end
