// cache_blends.v - the pixels that are being blended: the reads of the last BLEND_CYCLES cycles (docs/timing.md,
// section 7). A shift register whose contents stand still: a read goes into the slot of its cycle, slots are taken in
// turn, and a slot's distance from the one that is next says how long ago it was.
//
//   read, read_pixel, read_at   in   a pixel is read in this cycle: which, and the place of its line
//   known_at                    out  of the pixel read two cycles ago: the place of its line
//   done_pixel, done_at         out  of the pixel whose blend is over in the next cycle
//   install, install_at         in   another line takes this place: what is being blended there is of the line before
//   done_replaced               out  that has happened to it
//   any                         out  a blend is under way
//   ask, asked, hazard          in, in, out  whether this pixel's blend is under way; NEXT: or will be in the next cycle
//
//            ┌──────────── BLEND_CYCLES slots ────────────┐
//   read ──► │ now │ done │  ...  │ known │ one cycle ago │ ──► = asked? ──► hazard
//            └────────────────────────────────────────────┘
module cache_blends #(
    parameter BLEND_CYCLES = 4,
    parameter PIXEL_BITS   = 30,
    parameter PLACE_BITS   = 6,
    parameter NEXT         = 1
) (
    input                       clk,
    input                       rst,

    input                       read,
    input      [PIXEL_BITS-1:0] read_pixel,
    input      [PLACE_BITS-1:0] read_at,

    output     [PLACE_BITS-1:0] known_at,
    output     [PIXEL_BITS-1:0] done_pixel,
    output     [PLACE_BITS-1:0] done_at,
    output                      done_replaced,
    output                      any,

    input                       install,
    input      [PLACE_BITS-1:0] install_at,

    input                       ask,
    input      [PIXEL_BITS-1:0] asked,
    output reg                  hazard
);
    localparam SLOT_BITS = $clog2(BLEND_CYCLES);
    localparam [31:0] LAST = BLEND_CYCLES - 1, BACK = BLEND_CYCLES - 2;

    reg [BLEND_CYCLES-1:0] live, replaced;
    reg   [PIXEL_BITS-1:0] pixels [0:BLEND_CYCLES-1];
    reg   [PLACE_BITS-1:0] places [0:BLEND_CYCLES-1];
    reg    [SLOT_BITS-1:0] now;

    wire   [SLOT_BITS-1:0] done  = now == LAST[SLOT_BITS-1:0] ? 0 : now + 1'b1;
    wire   [SLOT_BITS-1:0] known = now < 2 ? now + BACK[SLOT_BITS-1:0] : now - 2;

    assign known_at   = places[known];
    assign done_pixel = pixels[done];
    assign done_at    = places[done];
    assign any        = |live;
    assign done_replaced = replaced[done];

    always @(posedge clk)
        if (rst) begin
            now  <= 0;
            live <= 0;
        end else begin
            now        <= done;
            live[now]  <= read;
            live[done] <= 1'b0;
            if (read) begin
                pixels[now] <= read_pixel;
                places[now] <= read_at;
            end
        end

    integer j;
    // Whatever lies in slots that are not live may be marked too.
    always @(posedge clk) begin
        if (install)
            for (j = 0; j < BLEND_CYCLES; j = j + 1)
                if (places[j] == install_at)
                    replaced[j] <= 1'b1;
        if (read)
            replaced[now] <= 1'b0;
    end

    integer i;
    always @* begin
        i      = 0;
        hazard = 1'b0;
        if (ask) begin
            for (i = 0; i < BLEND_CYCLES; i = i + 1)
                if (live[i] && pixels[i] == asked && !(NEXT != 0 && i[SLOT_BITS-1:0] == done))
                    hazard = 1'b1;
            if (NEXT != 0 && read && read_pixel == asked)
                hazard = 1'b1;
        end
    end
endmodule
