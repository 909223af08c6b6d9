// What a pixel cache can count on: no state and no traffic of a machine breaks it (docs/table-mutation.md).
// A frame has up to 16384x16384 pixels.
(* keep *) wire rules =
    replacement != 2'd3 &&                      // there is no such replacement
    (!colour_valid || (!colour_x[14] && !colour_y[14])) &&
    (rst || !door_valid || (!door_x[14] && !door_y[14])) &&
    (rst || !waits || (!front_pixel[14] && !front_pixel[29])) &&
    // Without clear_on_first_touch every miss fills; and what replaces nothing finds nothing dirty.
    (rst || !waits || clear_on_first_touch || front_fills == front_misses) &&
    (rst || !waits || NONBLOCKING != 0 || front_replaces || !(dirty[front_at] | (soils & known_at == front_at))) &&
    lines_across <= (fb_layout == `VODR_FB_LAYOUT_TILED ? 16'd512 : 16'd16384 >> W_BITS);
