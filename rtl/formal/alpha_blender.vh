// alpha_blender.vh - of alpha_blender.v: fragments meet their own pixels, in order, once; results come when they are due
// (docs/architecture.md, section 7).
//
//: of alpha_blender
//: proves no fragment is lost, doubled or overtaken on its way to the blend; the FIFO of colours never over- or underflows
//: proves a blend's result comes BLEND_CYCLES - 1 cycles after the read, and whether it is written two cycles after it
//: at BLEND_CYCLES=4
//: at BLEND_CYCLES=3 NONBLOCKING=1 NONBLOCKING_FIFO=3
//: quick
//: by induction 4
//: without the product of a blend, which alpha_blender_blend.vh is about
//: shrinks alpha_blender.v s|scale = y.*|scale = a ^ b;|
//: covers 12
//: breaks 8 alpha_blender.v s/pushes = goes & ~waiting_dead/pushes = goes/
//: breaks 8 alpha_blender.v s/rgba.0. +<= result/rgba[0] <= pixel_rgba/

// ---- what is asked of the cache ----

always @*
    if (started && !rst) begin
        `REQUIRE (!takes || !waiting || colour_gone); // its door has one place
        `REQUIRE (!colour_gone || waiting);
        `REQUIRE (!pixel_valid || count != 0);
        `REQUIRE (left <= DEPTH);
        `REQUIRE (blend != 2'd3);
    end

// ---- one fragment, any: followed from the door to its pixel ----

localparam [1:0] NONE = 0, DOOR = 1, QUEUE = 2;

(* anyseq *) reg formal_pick;
reg        [1:0] formal_place;
reg  [PIXEL-1:0] formal_rgba;
reg   [BITS:0] formal_ahead;
wire             formal_met = formal_place == QUEUE && formal_ahead == 0 && pixel_valid;

always @(posedge clk)
    if (rst)
        formal_place <= NONE;
    else if (formal_place == NONE || formal_met) begin
        formal_place <= takes && formal_pick && !colour_dead ? DOOR : NONE;
        formal_rgba  <= colour_rgba;
    end else if (formal_place == DOOR && goes) begin
        formal_place <= QUEUE;
        formal_ahead <= count - pixel_valid;
    end else if (formal_place == QUEUE)
        formal_ahead <= formal_ahead - pixel_valid;

// How many have been gone for good and not met theirs: dead ones never wait.
reg          formal_dead;
reg [BITS:0] formal_alive;
always @(posedge clk) begin
    if (takes)
        formal_dead <= colour_dead;
    formal_alive <= rst ? 0 : formal_alive + (waiting && colour_gone && !formal_dead) - pixel_valid;
end

wire [BITS-1:0] formal_at = first + formal_ahead[BITS-1:0];

always @*
    if (started) begin
        if (formal_place == DOOR)
            assert (waiting && !waiting_dead && waiting_rgba == formal_rgba);
        if (formal_place == QUEUE) begin
            assert (formal_ahead < count);
            assert (colours[formal_at] == formal_rgba);
        end
        assert (count <= DEPTH && count == formal_alive && (!waiting || waiting_dead == formal_dead));
        if (!rst) begin
            assert (last == first + count[BITS-1:0]);
            if (formal_met)
                assert (source == formal_rgba);
        end
    end

// ---- one result, any: followed to the cache ----

(* anyseq *) reg formal_pick_result;
reg  [7:0]       formal_age; // cycles since its read, 0: none is followed
reg  [PIXEL-1:0] formal_result;
reg              formal_writes;

always @(posedge clk)
    if (rst)
        formal_age <= 0;
    else if (formal_age == 0 || formal_age == BLEND_CYCLES - 1) begin
        formal_age    <= pixel_valid && formal_pick_result ? 2 : 0;
        formal_result <= result;
        formal_writes <= writes;
    end else
        formal_age <= formal_age + 1;

always @*
    if (started) begin
        assert (formal_age != 1 && formal_age < BLEND_CYCLES);
        if (formal_age != 0) begin
            assert (valid[formal_age - 2] && written[formal_age - 2] == formal_writes && rgba[formal_age - 2] == formal_result);
            if (formal_age == 2)
                assert (blended_known && blended_known_writes == formal_writes);
            if (formal_age == BLEND_CYCLES - 1)
                assert (blended_valid && blended_writes == formal_writes && blended_rgba == formal_result);
        end
    end

// ---- reached ----

always @*
    if (started && !rst) begin
        cover (formal_met && formal_place == QUEUE && count == DEPTH);
        cover (blended_valid && blended_writes && blended_rgba[0] && blend == `VODR_BLEND_UNDER);
        cover (pixel_valid && blend == `VODR_BLEND_UNDER && !writes);
        cover (pixel_valid && blend == `VODR_BLEND_MIP && !writes);
        cover (waiting && waiting_dead && goes);
    end
