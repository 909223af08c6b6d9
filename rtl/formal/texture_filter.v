// texture_filter.v - of texture_filter.vh: lerp is what docs/architecture.md, section 6 says, for all its operands.
//
//: of texture_filter_proof
//: proves lerp(a, b, w) is a + floor((b - a)*w / 2^weight_bits), and lies between a and b; at w = 0 it is a
//: at DENSITY_BITS=4 GUARD_BITS=2 WEIGHT_BITS=8
//: at DENSITY_BITS=8 GUARD_BITS=4 WEIGHT_BITS=8
//: at DENSITY_BITS=12 GUARD_BITS=6 WEIGHT_BITS=12
//: by induction 1
//: covers 2
//: breaks 2 texture_filter.vh s/lerp = a . product.WEIGHT_BITS/lerp = a + product[(WEIGHT_BITS - 1)/
//: breaks 2 texture_filter.vh s/lerp = a . product/lerp = b + product/
//: quick
module texture_filter_proof #(
    parameter DENSITY_BITS = 8,
    parameter GUARD_BITS   = 4,
    parameter WEIGHT_BITS  = 8
) (
    input                               clk,
    input [DENSITY_BITS+GUARD_BITS-1:0] a, b,
    input             [WEIGHT_BITS-1:0] w
);
    `include "texture_filter.vh"

    // By the definition of floor: f*2^W <= (b - a)*w < (f + 1)*2^W, where f = lerp - a.
    localparam BITS = VALUE_BITS + WEIGHT_BITS + 2;
    wire [VALUE_BITS-1:0]  result = lerp(a, b, w);
    wire signed [BITS-1:0] difference = $signed({1'b0, b}) - $signed({1'b0, a});
    wire signed [BITS-1:0] exact = difference * $signed({1'b0, w});
    wire signed [BITS-1:0] least = ($signed({1'b0, result}) - $signed({1'b0, a})) <<< WEIGHT_BITS;

    always @* begin
        assert (least <= exact && exact - least < (1 << WEIGHT_BITS));
        assert (a <= b ? a <= result && result <= b : b <= result && result <= a);
        if (w == 0)
            assert (result == a);
        cover (a > b && result == b && w == 1);
        cover (a < b && result == b - 1'b1 && &w);
    end
endmodule
