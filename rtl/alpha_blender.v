// alpha_blender.v - blends each pixel that is read with the fragment that it was read for (Figure 2 of the paper;
// docs/architecture.md, "Blend"; docs/timing.md, section 7).
//
//   port     way  what it is
//   colour   in   a link that this block listens to: a fragment on its way from texture unit to pixel cache,
//                 and the cache's answer: whether it moves, whether the one before the cache is gone
//   pixel    in   strobe: the pixel of the oldest fragment that is gone and lives, as it was read
//   blended  out  strobes: the cycle after, whether it is written; BLEND_CYCLES - 1 after the read, the pixel
//   report   out  status and idle
//
//   colour ──► waiting ──gone──► colours: a FIFO ──► blend ──► a shift register ──► blended
//                                                      ▲  └──────────────────────► blended_known
//                                                pixel ┘
`include "vodr_hw.vh"
`include "status.vh"

module alpha_blender #(
    parameter FB_BITS          = `VODR_DEFAULT_FB_BITS,
    parameter BLEND_CYCLES     = `VODR_DEFAULT_BLEND_CYCLES,
    parameter NONBLOCKING      = `VODR_DEFAULT_NONBLOCKING,
    parameter NONBLOCKING_FIFO = `VODR_DEFAULT_NONBLOCKING_FIFO
) (
    input                      clk,
    input                      rst,
    input                [1:0] blend,

    input                      colour_valid,
    input                      colour_dead,
    input      [4*FB_BITS-1:0] colour_rgba,
    input                      colour_ready,
    input                      colour_gone,
    input                      colour_hazard,

    input                      pixel_valid,
    input      [4*FB_BITS-1:0] pixel_rgba,

    output                     blended_known,
    output                     blended_known_writes,
    output                     blended_valid,
    output                     blended_writes,
    output     [4*FB_BITS-1:0] blended_rgba,

    output reg           [3:0] report_status,
    output reg                 report_idle
);
    localparam PIXEL   = 4 * FB_BITS;
    localparam WRITTEN = 16;                  // mip: the bit that says that there is a density
    localparam STAGES  = BLEND_CYCLES - 2;    // registers from a pixel that was read to what became of it
    // Between look-up and read lie one fragment of a blocking cache, those of its FIFO of a non-blocking one.
    localparam DEPTH   = NONBLOCKING != 0 ? NONBLOCKING_FIFO + 1 : 2;
    localparam BITS    = $clog2(DEPTH);

    // ---- arithmetic ----

    // a*b over the largest value, rounded to nearest, without a division.
    function [FB_BITS-1:0] scale(input [FB_BITS-1:0] a, input [FB_BITS-1:0] b);
        reg [2*FB_BITS-1:0] x;
        /* verilator lint_off UNUSEDSIGNAL */ // the rounded-off half of y
        reg [2*FB_BITS-1:0] y;
        /* verilator lint_on UNUSEDSIGNAL */
        begin
            x = a * b + ({{(2*FB_BITS-1){1'b0}}, 1'b1} << (FB_BITS - 1));
            y = x + (x >> FB_BITS);
            scale = y[2*FB_BITS-1:FB_BITS];
        end
    endfunction

    // One in front of another. No sum exceeds the largest value: both are premultiplied.
    function [PIXEL-1:0] composite(input [PIXEL-1:0] near, input [PIXEL-1:0] far);
        reg [FB_BITS-1:0] through;
        integer c;
        begin
            through = ~near[3*FB_BITS +: FB_BITS];
            for (c = 0; c < 4; c = c + 1)
                composite[c*FB_BITS +: FB_BITS] =
                    near[c*FB_BITS +: FB_BITS] + scale(far[c*FB_BITS +: FB_BITS], through);
        end
    endfunction

    // ---- fragments that wait for their pixel ----

    reg              waiting, waiting_dead; // before the cache
    reg  [PIXEL-1:0] waiting_rgba;
    reg  [PIXEL-1:0] colours [0:(1<<BITS)-1];
    reg   [BITS-1:0] first, last;           // the oldest, and where the next goes
    reg     [BITS:0] count;

    wire             takes  = colour_valid & colour_ready;
    wire             goes   = waiting & colour_gone;
    wire             pushes = goes & ~waiting_dead;
    wire             waits  = takes | (waiting & ~goes); // in the next cycle
    wire    [BITS:0] left   = count + {{BITS{1'b0}}, pushes} - {{BITS{1'b0}}, pixel_valid};

    always @(posedge clk)
        if (rst) begin
            waiting <= 1'b0;
            first   <= 0;
            last    <= 0;
            count   <= 0;
        end else begin
            waiting <= waits;
            if (takes) begin
                waiting_dead <= colour_dead;
                waiting_rgba <= colour_rgba;
            end
            if (pushes) begin
                colours[last] <= waiting_rgba;
                last <= last + 1'b1;
            end
            if (pixel_valid)
                first <= first + 1'b1;
            count <= left;
        end

    // ---- the blend ----

    wire [PIXEL-1:0] source = colours[first];
    reg  [PIXEL-1:0] result;
    reg              writes;

    always @* begin
        result = pixel_rgba;
        writes = 1'b0;
        if (pixel_valid)
            case (blend)
                `VODR_BLEND_OVER: begin
                    result = composite(source, pixel_rgba);
                    writes = 1'b1;
                end
                `VODR_BLEND_UNDER:
                    if (~&pixel_rgba[3*FB_BITS +: FB_BITS]) begin
                        result = composite(pixel_rgba, source);
                        writes = 1'b1;
                    end
                default:
                    if (~pixel_rgba[WRITTEN] || source[15:0] > pixel_rgba[15:0]) begin
                        result = source;
                        writes = 1'b1;
                    end
            endcase
    end

    // ---- results on their way to the cache ----

    reg [STAGES-1:0] valid, written;
    reg  [PIXEL-1:0] rgba [0:STAGES-1];
    integer i;

    always @(posedge clk) begin
        valid      <= rst ? 0 : valid << 1;
        valid[0]   <= pixel_valid & ~rst;
        written    <= written << 1;
        written[0] <= writes;
        rgba[0]    <= result;
        for (i = 1; i < STAGES; i = i + 1)
            rgba[i] <= rgba[i-1];
    end

    assign blended_known        = valid[0];
    assign blended_known_writes = written[0];
    assign blended_valid        = valid[STAGES-1];
    assign blended_writes       = written[STAGES-1];
    assign blended_rgba         = rgba[STAGES-1];

    // ---- report ----

    always @(posedge clk) begin
        report_idle   <= rst | (~waits & (left == 0));
        report_status <= rst | ~waiting ? `STATUS_IDLE
                         : goes         ? `STATUS_BUSY
                         : colour_hazard ? `STATUS_STALLED_HAZARD : `STATUS_STALLED_CACHE;
    end
endmodule
