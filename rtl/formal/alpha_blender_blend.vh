// alpha_blender_blend.vh - of alpha_blender.v: the arithmetic, for every pixel and every fragment (docs/architecture.md, section 7).
//
// A product is the RTL's own: what is shown is what becomes of it.
//
//: of alpha_blender
//: proves in over, under and mip a pixel becomes, channel by channel, what docs/architecture.md says, and is written when it says so
//: at FB_BITS=8
//: at FB_BITS=16
//: hole the multiplier itself: that a product of two numbers of fb_bits is right is Yosys's and the tool's, and what tests/test_exhaustive.c compares
//: by induction 1
//: covers 8
//: breaks 6 alpha_blender.v s/through = ~near/through = near/
//: breaks 6 alpha_blender.v s/<< .FB_BITS - 1../<< (FB_BITS - 2))/
//: breaks 6 alpha_blender.v s/source.15:0. > pixel_rgba/source[15:0] >= pixel_rgba/

localparam [FB_BITS-1:0] FORMAL_MOST = ~0;

wire [FB_BITS-1:0] formal_source_a = source[3*FB_BITS +: FB_BITS], formal_pixel_a = pixel_rgba[3*FB_BITS +: FB_BITS];
wire [FB_BITS-1:0] formal_past_source = ~formal_source_a, formal_past_pixel = ~formal_pixel_a;
wire formal_over = blend == `VODR_BLEND_OVER, formal_under = blend == `VODR_BLEND_UNDER;

// scale() of the document, of a product.
function [FB_BITS-1:0] formal_scaled(input [2*FB_BITS-1:0] product);
    reg [2*FB_BITS+1:0] t;
    begin
        t = product + (1 << (FB_BITS - 1));
        formal_scaled = (t + (t >> FB_BITS)) >> FB_BITS;
    end
endfunction

always @*
    assert (formal_past_source == FORMAL_MOST - formal_source_a && formal_past_pixel == FORMAL_MOST - formal_pixel_a);

genvar formal_c;
generate
    for (formal_c = 0; formal_c < 4; formal_c = formal_c + 1) begin : formal_channel
        wire [FB_BITS-1:0]   of_source = source[formal_c*FB_BITS +: FB_BITS];
        wire [FB_BITS-1:0]   of_pixel  = pixel_rgba[formal_c*FB_BITS +: FB_BITS];
        wire [FB_BITS-1:0]   now       = result[formal_c*FB_BITS +: FB_BITS];
        wire [2*FB_BITS-1:0] over      = of_pixel * formal_past_source;
        wire [2*FB_BITS-1:0] under     = of_source * formal_past_pixel;
        always @* begin
            assume (over <= FORMAL_MOST * FORMAL_MOST && under <= FORMAL_MOST * FORMAL_MOST); // factors are at most M
            if (pixel_valid && formal_over)
                assert (now == of_source + formal_scaled(over));
            if (pixel_valid && formal_under)
                assert (now == (formal_pixel_a == FORMAL_MOST ? of_pixel : of_pixel + formal_scaled(under)));
        end
    end
endgenerate

always @*
    if (pixel_valid) begin
        assert (writes == (formal_over || (formal_under && formal_pixel_a != FORMAL_MOST)
                           || (!formal_over && !formal_under && (!pixel_rgba[WRITTEN] || source[15:0] > pixel_rgba[15:0]))));
        if (!formal_over && !formal_under)
            assert (result == (writes ? source : pixel_rgba));
    end

always @* begin
    cover (pixel_valid && formal_over && (result == ~0) && source != ~0);
    cover (pixel_valid && formal_under && writes && result[FB_BITS-1:0] == FORMAL_MOST - 1);
    cover (pixel_valid && formal_under && !writes);
    cover (pixel_valid && blend == `VODR_BLEND_MIP && !writes);
end
