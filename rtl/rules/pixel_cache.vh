// What a pixel cache can count on: no state and no traffic of a machine breaks it (docs/table-mutation.md).
// A frame has up to 16384x16384 pixels.
(* keep *) wire rules =
    replacement != 2'd3 &&                      // there is no such replacement
    (!colour_valid || (!colour_x[14] && !colour_y[14])) &&
    (!door_valid || (!door_x[14] && !door_y[14])) &&
    (rst || !waits || (!front_pixel[14] && !front_pixel[29])) &&
    lines_across <= (fb_layout == `VODR_FB_LAYOUT_TILED ? 16'd512 : 16'd16384 >> W_BITS);
