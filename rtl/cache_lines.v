// cache_lines.v - the pixels of the cache's lines, and of lines that came from memory and wait for their miss's turn.
//
//   filled_*       in   a line came; came: out, one waits
//   install, zeros in   a miss's line takes its place `at`: the line that came first, or zeros
//   read, at, offset    in   a pixel is read, of the new line when it is installed; pixel: out, registered
//   move           in   the line at `at` leaves
//   settle         in   this pixel alone leaves, written through
//   leaving        out  registered: what leaves
//   write, ...     in   a pixel that was blended is written
//
//   filled ──► came: a FIFO ──► lines ──┬──► leaving
//                                 ▲     └──► pixel
//                         write ──┘
module cache_lines #(
    parameter PIXEL       = 32,  // bits
    parameter LINE_PIXELS = 16,
    parameter LINES       = 64,
    parameter PLACE_BITS  = 6,
    parameter MISSES      = 1
) (
    input                               clk,
    input                               rst,

    input                               filled_valid,
    input       [PIXEL*LINE_PIXELS-1:0] filled_data,
    output                              came,

    input                               install,
    input                               zeros,
    input                               read,
    input              [PLACE_BITS-1:0] at,
    input                         [9:0] offset,
    output reg              [PIXEL-1:0] pixel,

    input                               move,
    input                               settle,
    input                   [PIXEL-1:0] settle_pixel,
    output reg  [PIXEL*LINE_PIXELS-1:0] leaving,

    input                               write,
    input              [PLACE_BITS-1:0] write_at,
    input                         [9:0] write_offset,
    input                   [PIXEL-1:0] write_pixel
);
    localparam MISS_BITS = MISSES > 1 ? $clog2(MISSES) : 1;
    localparam [31:0] LAST = MISSES - 1;

    reg [PIXEL*LINE_PIXELS-1:0] lines  [0:LINES-1];
    reg [PIXEL*LINE_PIXELS-1:0] filled [0:MISSES-1];
    reg         [MISS_BITS-1:0] first, last;
    reg           [MISS_BITS:0] count;
    wire                        takes = install & ~zeros;

    function [MISS_BITS-1:0] after(input [MISS_BITS-1:0] miss);
        after = miss == LAST[MISS_BITS-1:0] ? 0 : miss + 1'b1;
    endfunction

    assign came = count != 0;

    always @(posedge clk)
        if (rst) begin
            first <= 0;
            last  <= 0;
            count <= 0;
        end else begin
            count <= count + {{MISS_BITS{1'b0}}, filled_valid} - {{MISS_BITS{1'b0}}, takes};
            if (filled_valid) begin
                filled[last] <= filled_data;
                last         <= after(last);
            end
            if (takes)
                first <= after(first);
        end

    // A line that is installed goes before a pixel of the line that was there.
    always @(posedge clk) begin
        if (write)
            lines[write_at][write_offset*PIXEL +: PIXEL] <= write_pixel;
        if (takes)
            lines[at] <= filled[first];
        else if (install)
            lines[at] <= 0;
    end

    always @(posedge clk)
        if (takes)
            pixel <= filled[first][offset*PIXEL +: PIXEL];
        else if (install)
            pixel <= 0;
        else if (read)
            pixel <= lines[at][offset*PIXEL +: PIXEL];

    always @(posedge clk) begin
        if (move)
            leaving <= lines[at];
        if (settle)
            leaving[PIXEL-1:0] <= settle_pixel;
    end
endmodule
