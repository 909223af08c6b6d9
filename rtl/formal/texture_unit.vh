// texture_unit.vh - of texture_unit.v: fragments through its slots (docs/timing.md, section 6).
//
//: of texture_unit
//: proves no fragment is lost, doubled, made up or overtaken from its acceptance to the colour link; it comes with its own pixel and its own density's colour
//: proves the colour link: what is offered stays, unchanged, until it is taken; never more than FRAGMENT_ROOM fragments are accepted and not gone
//: at DENSITY_BITS=2 WEIGHT_BITS=1 GUARD_BITS=0 FB_BITS=2 MEM_BUS_BYTES=1 TEXTURE_BYTES=2 FRAGMENT_ROOM=3
//: at DENSITY_BITS=2 WEIGHT_BITS=1 GUARD_BITS=0 FB_BITS=2 MEM_BUS_BYTES=1 TEXTURE_BYTES=2 FRAGMENT_ROOM=1
//: quick
//: without the loader: when a brick is there is any cycle's; where a voxel lies, and what the filter makes of voxels: any number
//: by induction 2
//: covers 14
//: shrinks texture_loader.v /^\);/,$c\);\nwire nothing = clk;\nendmodule
//: shrinks texture_unit.v s/ \* (plane_bytes|row_bytes)/ ^ \1/
//: shrinks texture_unit.v s/linear . trilinear.voxels, weight. : //
//: breaks 10 texture_unit.v s/fragment_ready +<= there_next && .*/fragment_ready <= there_next;/
//: breaks 12 texture_unit.v s/show = .!colour_valid .. colour_ready. && /show = /
//: breaks 12 texture_unit.v s/at_once && ripe == 0 . colour : shaded/ripe == 0 ? colour : shaded/

// ---- registers hold still; what is asked of the pixel cache and of the memory of `whole` ----

(* anyconst *) reg [7:0] formal_latency;
(* anyconst *) reg       formal_whole;
reg [3:0] formal_fetched; // fragments accepted and not filtered
reg       formal_holds;   // one waits before the cache
wire      formal_moves = colour_valid && colour_ready;
always @(posedge clk) begin
    formal_fetched <= rst ? 0 : formal_fetched + accept - filtering;
    formal_holds   <= !rst && (formal_moves || (formal_holds && !colour_gone));
end
always @* begin
    `REQUIRE (texture_latency_cycles == formal_latency && formal_latency >= 8'd3);
    `REQUIRE (whole == formal_whole && !table_write);
    if (started && !rst) begin
        `REQUIRE (!colour_gone || formal_holds);
        `REQUIRE (!formal_moves || !formal_holds || colour_gone); // its door has one place
        `REQUIRE (!whole || !voxels_valid || formal_fetched != 0);
    end
end

// ---- the slots: those that wait for voxels, that are unripe, that are ripe; then what is shown, then the door ----

function [3:0] formal_slot; // so many slots on
    input [3:0] at, steps;
    formal_slot = at + steps >= FRAGMENT_ROOM ? at + steps - FRAGMENT_ROOM : at + steps;
endfunction

always @*
    if (started && !rst) begin
        assert (shown_at < FRAGMENT_ROOM && count <= FRAGMENT_ROOM);
        assert (ripe_at == formal_slot(shown_at, ripe));
        assert (filtered_at == formal_slot(ripe_at, unripe));
        assert (accepted_at == formal_slot(filtered_at, formal_fetched));
        assert (count == formal_fetched + unripe + ripe + colour_valid + formal_holds);
        assert (!fragment_ready || count != FRAGMENT_ROOM);
        assert (!at_once || unripe == 0);
        assert (whole ? !read : read == (formal_fetched != 0) && formal_fetched <= 4'd1);
        assert (report_idle == (count == 0));
    end

// ---- the colour link ----

always @(posedge clk)
    if (started && !$past(rst) && !rst && $past(colour_valid && !colour_ready)) begin
        assert (colour_valid);
        assert ($stable({colour_x, colour_y, colour_dead, colour_rgba}));
    end

// ---- one fragment, any: followed from its acceptance to the link ----

(* anyseq *) reg  formal_pick;
reg               formal_tracked, formal_filtered, formal_shown; // shown in the cycle before
reg         [3:0] formal_ahead, formal_before; // fragments that are shown, or filtered, before it
reg        [29:0] formal_place;
reg [4*FB_BITS:0] formal_colour;
wire formal_takes = accept && formal_pick && !formal_tracked;
wire formal_meets = formal_tracked && !formal_filtered && filtering && formal_before == 0;
wire formal_shows = formal_tracked && show && formal_ahead == 0;
always @(posedge clk) begin
    formal_tracked <= !rst && (formal_takes || formal_tracked) && !formal_shows;
    formal_shown   <= !rst && formal_shows;
    if (formal_takes) begin
        formal_place    <= {fragment_y, fragment_x};
        formal_filtered <= 1'b0;
        formal_before   <= formal_fetched - filtering;
        formal_ahead    <= formal_fetched + unripe + ripe - show;
    end else begin
        formal_before <= formal_before - filtering;
        formal_ahead  <= formal_ahead - show;
        if (formal_meets) begin
            formal_filtered <= 1'b1;
            formal_colour   <= colour;
        end
    end
end

wire [3:0] formal_at = formal_slot(shown_at, formal_ahead);
always @*
    if (started && !rst) begin
        if (formal_tracked) begin
            assert (formal_ahead < formal_fetched + unripe + ripe);
            assert (place[formal_at[SLOT_BITS-1:0]] == formal_place);
            assert (formal_filtered == (formal_ahead < unripe + ripe));
            assert (!formal_filtered || shaded[formal_at[SLOT_BITS-1:0]] == formal_colour);
            assert (formal_filtered || formal_before == formal_ahead - unripe - ripe);
        end
        if (formal_shown) begin
            assert (colour_valid && {colour_y, colour_x} == formal_place);
            assert ({colour_dead, colour_rgba} == formal_colour);
        end
        cover (formal_shows && formal_filtered && formal_ahead == 0 && count == FRAGMENT_ROOM);
        cover (formal_shows && !formal_filtered);
        cover (formal_shown && whole && colour_rgba != 0);
        cover (fragment_valid && !fragment_ready && count == FRAGMENT_ROOM && !fragment_loading);
    end
