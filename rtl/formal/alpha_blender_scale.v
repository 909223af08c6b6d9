// alpha_blender_scale.v - of alpha_blender.v: what docs/architecture.md, section 7 says of scale(u, v), for every product:
// it is u*v/M to nearest. And so premultiplied colours stay so: no channel exceeds alpha, no sum exceeds M.
//
// Products: any number up to M*M, and with an a below alpha, a*v below alpha*v.
//
//: of alpha_blender_scale
//: proves scale(u, v) is u*v/M to nearest; of premultiplied colours no channel of a blend exceeds its alpha, no alpha exceeds M
//: at FB_BITS=8
//: at FB_BITS=16
//: by induction 1
//: covers 2
//: breaks 2 formal/alpha_blender_scale.v s/>> FB_BITS\)\) >>/>> (FB_BITS - 1))) >>/
module alpha_blender_scale #(
    parameter FB_BITS = 8
) (
    input                 clk,
    input [2*FB_BITS-1:0] product, alpha_product,              // u*v, alpha*v
    input   [FB_BITS-1:0] near, near_alpha
);
    localparam [FB_BITS-1:0]   M  = ~0;
    localparam [2*FB_BITS-1:0] MM = M * M;

    function [FB_BITS-1:0] scaled(input [2*FB_BITS-1:0] of);
        reg [2*FB_BITS-1:0] t;
        begin
            t = of + (1 << (FB_BITS - 1));
            scaled = (t + (t >> FB_BITS)) >> FB_BITS;
        end
    endfunction

    wire   [FB_BITS-1:0] s = scaled(product), s_alpha = scaled(alpha_product);
    // Twice the product, and 2*M times the result: M apart at most, with room for both.
    wire [2*FB_BITS+3:0] twice = {3'd0, product, 1'b0};
    wire [2*FB_BITS+3:0] back  = ({{(FB_BITS+3){1'b0}}, s, 1'b0} << FB_BITS) - {{(FB_BITS+3){1'b0}}, s, 1'b0};
    wire   [2*FB_BITS:0] most  = (M - near_alpha) * M;            // alpha_product: of a factor M - near_alpha
    wire     [FB_BITS:0] sum = near + s, sum_alpha = near_alpha + s_alpha;

    always @* begin
        assume (product <= MM && alpha_product <= MM);
        assert (back <= twice + M && twice <= back + M);
        if (near <= near_alpha && product <= alpha_product && alpha_product <= most)
            assert (sum <= sum_alpha && sum_alpha <= M);
        cover (s == M && product != MM);
        cover (near <= near_alpha && product < alpha_product && alpha_product == most && sum == sum_alpha);
    end
endmodule
