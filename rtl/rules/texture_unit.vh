// What a texture unit can count on: no state and no traffic of a machine breaks it (docs/table-mutation.md).
// One that has a texture memory never draws `whole`, one that has none always does.
(* keep *) wire rules =
    (TEXTURE_BYTES > MEM_BUS_BYTES ? !whole && (rst || !fetch_valid) : whole && (rst || !read)) &&
    (!fragment_valid || (!fragment_x[14] && !fragment_y[14]));      // a frame has up to 16384x16384 pixels
