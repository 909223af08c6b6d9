// slice_plane.vh - functions of a slice, the same plane in every brick (docs/architecture.md, sections 2 and 3). Its
// numerators are A(x, y) = origin + x*step_u + y*step_v on each axis, in both projections:
//
//   parallel      origin = k*step_s     step_u, step_v as in the registers
//   perspective   origin = z*step_s     step_u, step_v of the registers times z, z = (depth_first + k*depth_step) >> 16
//
// The view was checked: 1 <= z < 2^24 on each of its slices, and a product's 64 bits are all it has. Each function is
// combinational; to be included inside a module none of whose signals has the name of an argument or a local here.

// z of a slice, from depth_first and depth_step: what is left of a depth's 41 bits without its fraction and, as it is
// positive, its sign.
function [23:0] slice_depth(input [63:0] depth_at_0, input [63:0] depth_growth, input [14:0] slice_number);
    /* verilator lint_off UNUSEDSIGNAL */ // the fraction, and copies of the sign
    reg [63:0] depth;
    /* verilator lint_on UNUSEDSIGNAL */
    begin
        depth = depth_at_0 + depth_growth * {49'd0, slice_number};
        slice_depth = depth[39:16];
    end
endfunction

// The slice's origin on an axis, from step_s.
function [63:0] slice_origin(input in_perspective, input [23:0] slice_z, input [14:0] slice_number,
                             input [63:0] axis_step_s);
    slice_origin = axis_step_s * {40'd0, in_perspective ? slice_z : {9'd0, slice_number}};
endfunction

// The slice's step_u or step_v on an axis, from the register of that name.
function [63:0] slice_step(input in_perspective, input [23:0] slice_z, input [63:0] axis_step);
    if (in_perspective)
        slice_step = axis_step * {40'd0, slice_z};
    else
        slice_step = axis_step;
endfunction

// The numerator at which a position reaches a border between voxels, from base and shift: position >= voxel exactly
// when A >= border_of().
function [63:0] border_of(input [15:0] voxel, input [63:0] axis_base, input [4:0] scale);
    border_of = ({24'd0, voxel, 24'd0} - axis_base) << scale;
endfunction
