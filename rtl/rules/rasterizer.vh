// What a rasterizer can count on: no state and no traffic of a machine breaks it (docs/table-mutation.md).
// A frame has up to 16384 pixels along an edge.
(* keep *) wire rules =
    (!slice_valid || (slice_x0 < slice_x1 && slice_x1 <= 15'd16384 && slice_y0 < slice_y1 && slice_y1 <= 15'd16384)) &&
    (rst || !fragment_valid || (!slice_ready && !fragment_x[14] && !fragment_y[14] && fragment_x < x_end && fragment_y < y1)) &&
    (rst || slice_ready || (x0 < x1 && x1 <= 15'd16384 && y1 <= 15'd16384));
