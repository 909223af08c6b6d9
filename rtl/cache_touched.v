// cache_touched.v - which lines of the frame missed before in this frame (clear_on_first_touch; docs/architecture.md,
// section 9).
//
//   misses, line   in   a line misses
//   first          out  then: for the first time in this frame, so that it is zeros and need not be read
//
//   line ─┬─► words of 64 bits, one a line ──┬──► first
//         └─► used: words written since reset┘
module cache_touched #(
    parameter FRAME_LINES = 1,
    parameter NUMBER_BITS = 24
) (
    input                   clk,
    input                   rst,
    input                   clear_on_first_touch,
    input                   misses,
    /* verilator lint_off UNUSEDSIGNAL */ // numbers beyond the frame's lines do not come
    input [NUMBER_BITS-1:0] line,
    /* verilator lint_on UNUSEDSIGNAL */
    output reg              first
);
    localparam WORDS     = FRAME_LINES > 64 ? FRAME_LINES / 64 : 1;
    localparam WORD_BITS = WORDS > 1 ? $clog2(WORDS) : 1;

    reg         [63:0] touched [0:WORDS-1];
    reg    [WORDS-1:0] used;
    wire [WORD_BITS-1:0] word = WORDS > 1 ? line[6 +: WORD_BITS] : 0;

    always @*
        first = misses & clear_on_first_touch & ~(used[word] & touched[word][line[5:0]]);

    always @(posedge clk)
        if (rst)
            used <= 0;
        else if (first) begin
            used[word]    <= 1'b1;
            touched[word] <= (used[word] ? touched[word] : 64'b0) | (64'b1 << line[5:0]);
        end
endmodule
