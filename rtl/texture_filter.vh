// texture_filter.vh - the arithmetic of the reconstruction filter (docs/architecture.md, section 6): functions for the
// module that includes it, which has DENSITY_BITS, WEIGHT_BITS and GUARD_BITS.

// verilator lint_off UNUSEDSIGNAL
// Fraction bits are dropped: that is the rounding.

localparam VALUE_BITS = DENSITY_BITS + GUARD_BITS; // a density with its guard bits; no interpolation leaves them

// a + floor((b - a)*weight / 2^WEIGHT_BITS): between a and b, so that the sum needs no more bits than they have.
function [VALUE_BITS-1:0] lerp;
    input [VALUE_BITS-1:0] a, b;
    input [WEIGHT_BITS-1:0] weight;
    reg [VALUE_BITS+WEIGHT_BITS:0] difference, product; // two's complement, with room for the product
    begin
        difference = {{(WEIGHT_BITS + 1){1'b0}}, b} - {{(WEIGHT_BITS + 1){1'b0}}, a};
        product = difference * {{(VALUE_BITS + 1){1'b0}}, weight};
        lerp = a + product[WEIGHT_BITS +: VALUE_BITS];
    end
endfunction

// The pair of voxels that are neighbours along x, with their guard bits, interpolated.
function [VALUE_BITS-1:0] lerp_pair;
    input [2*DENSITY_BITS-1:0] pair;
    input [WEIGHT_BITS-1:0] weight;
    lerp_pair = lerp({{GUARD_BITS{1'b0}}, pair[0 +: DENSITY_BITS]} << GUARD_BITS,
                     {{GUARD_BITS{1'b0}}, pair[DENSITY_BITS +: DENSITY_BITS]} << GUARD_BITS, weight);
endfunction

// Eight voxels, x fastest, and the weights of the three axes, x lowest: along x, y, z, and rounded to nearest once.
function [DENSITY_BITS-1:0] trilinear;
    input [8*DENSITY_BITS-1:0] voxels;
    input [3*WEIGHT_BITS-1:0] weights;
    reg [WEIGHT_BITS-1:0] weight_x, weight_y, weight_z;
    reg [VALUE_BITS-1:0] y0, y1;
    reg [VALUE_BITS:0] sum;
    begin
        {weight_z, weight_y, weight_x} = weights;
        y0 = lerp(lerp_pair(voxels[0 +: 2*DENSITY_BITS], weight_x),
                  lerp_pair(voxels[2*DENSITY_BITS +: 2*DENSITY_BITS], weight_x), weight_y);
        y1 = lerp(lerp_pair(voxels[4*DENSITY_BITS +: 2*DENSITY_BITS], weight_x),
                  lerp_pair(voxels[6*DENSITY_BITS +: 2*DENSITY_BITS], weight_x), weight_y);
        sum = {1'b0, lerp(y0, y1, weight_z)} + ({{VALUE_BITS{1'b0}}, 1'b1} << GUARD_BITS >> 1);
        trilinear = sum[GUARD_BITS +: DENSITY_BITS];
    end
endfunction
// verilator lint_on UNUSEDSIGNAL
