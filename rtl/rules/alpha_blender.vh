// What an alpha blender can count on: no state and no traffic of a machine breaks it (docs/table-mutation.md).
function premultiplied(input [PIXEL-1:0] pixel); // no channel above alpha; in mip nothing beyond a density of 12 bits
    premultiplied = blend == `VODR_BLEND_MIP ? pixel >> 17 == 0 && pixel[15:12] == 0
                    : pixel[0 +: FB_BITS] <= pixel[3*FB_BITS +: FB_BITS] && pixel[FB_BITS +: FB_BITS] <= pixel[3*FB_BITS +: FB_BITS] &&
                      pixel[2*FB_BITS +: FB_BITS] <= pixel[3*FB_BITS +: FB_BITS];
endfunction
localparam [BITS:0] RULE_WAITING = NONBLOCKING != 0 ? DEPTH : 1; // a blocking cache reads one pixel at a time
(* keep *) wire rules =
    blend != 2'd3 &&                            // there is no such blend
    !(rst && pixel_valid) &&                    // in reset no valid is up
    (rst || !pixel_valid || count != 0) &&      // a pixel is read for a fragment that waits for it
    (!pixel_valid || (premultiplied(pixel_rgba) && premultiplied(source))) &&
    (rst || (count <= RULE_WAITING && left <= RULE_WAITING));
