// lerp_alone.v - the texture unit's interpolation of two densities (rtl/texture_filter.vh) as a module, for lerp.c.
module lerp_alone (
    input   [7:0] first,
    input   [7:0] second,
    input   [7:0] share, // of the second
    output [11:0] result
);
    localparam DENSITY_BITS = 8, WEIGHT_BITS = 8, GUARD_BITS = 4;

    `include "texture_filter.vh"

    assign result = lerp_pair({second, first}, share);
endmodule
