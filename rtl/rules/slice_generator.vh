// What a slice generator can count on: no state and no traffic of a machine breaks it (docs/table-mutation.md).
// A volume has up to 32768 voxels along an edge, a frame up to 16384 pixels, and slices.
(* keep *) wire rules =
    blend != 2'd3 &&                            // there is no such blend
    (!brick_valid || (brick_x0 < brick_x1 && brick_x1 <= 15'd16384 && brick_y0 < brick_y1 && brick_y1 <= 15'd16384 &&
                      brick_k0 <= brick_k1 && brick_k1 <= 15'd16384 && brick_lo_x < brick_hi_x && brick_hi_x <= 16'd32768 &&
                      brick_lo_y < brick_hi_y && brick_hi_y <= 16'd32768 && brick_lo_z < brick_hi_z && brick_hi_z <= 16'd32768)) &&
    (brick_ready || rst || (x0 < x1 && x1 <= 15'd16384 && y0 < y1 && y1 <= 15'd16384 && k < 15'd16384 &&
                            lo_x < hi_x && hi_x <= 16'd32768 && lo_y < hi_y && hi_y <= 16'd32768 && lo_z < hi_z && hi_z <= 16'd32768));
