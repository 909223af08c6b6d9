// cache_queue.v - accesses that were looked up and not read, in order: all of them in a non-blocking cache, the one miss
// under way in a blocking one (docs/timing.md, section 7). Misses among them have a queue of their own beside it, of the
// lines that they replace: a line must not be asked for while it is leaving.
//
//   push_*                   in   an access: whether it misses, its line is to be filled, replaces another (the victim);
//                                 its line, that line's place, its pixel
//   wants                    out  the cycle after: its line is to be asked for; line: of the last miss
//   waits, front_*           out  the oldest access; victim: of the oldest miss
//   clears                   in   what the oldest replaces, if anything, is out of the way, or moves there
//   clears_clean             in   so it does, and is no older in memory
//   pops                     in   the oldest is read
//   full, misses_full        out  in the next cycle there is no room for an access, for a miss
//   ask, asked, leaving      in, in, out  whether this line will be leaving in the next cycle
//
//   push ──► │ ... │ access │ access │ front ──► evict, fill, read
//     └────► │ ... │ victim │ victim ──► = asked? ──► leaving
module cache_queue #(
    parameter DEPTH       = 1,
    parameter MISSES      = 1,
    parameter NUMBER_BITS = 24,
    parameter PLACE_BITS  = 6,
    parameter PIXEL_BITS  = 30
) (
    input                        clk,
    input                        rst,

    input                        push,
    input                        push_misses,
    input                        push_fills,
    input                        push_replaces,
    input      [NUMBER_BITS-1:0] push_victim,
    input      [NUMBER_BITS-1:0] push_line,
    input       [PLACE_BITS-1:0] push_at,
    input       [PIXEL_BITS-1:0] push_pixel,
    output reg                   wants,
    output reg [NUMBER_BITS-1:0] line,

    output                       waits,
    output                       front_misses,
    output                       front_fills,
    output                       front_replaces,
    output      [PLACE_BITS-1:0] front_at,
    output      [PIXEL_BITS-1:0] front_pixel,
    output     [NUMBER_BITS-1:0] victim,
    input                        clears,
    input                        clears_clean,
    input                        pops,

    output                       full,
    output                       misses_full,
    input                        ask,
    input      [NUMBER_BITS-1:0] asked,
    output reg                   leaving
);
    localparam DEPTH_BITS = DEPTH > 1 ? $clog2(DEPTH) : 1;
    localparam MISS_BITS  = MISSES > 1 ? $clog2(MISSES) : 1;
    localparam [31:0] ALL = DEPTH, ALL_MISSES = MISSES, LAST_MISS = MISSES - 1;

    // ---- accesses ----

    reg [PLACE_BITS+PIXEL_BITS+2:0] accesses [0:(1<<DEPTH_BITS)-1];
    reg  [DEPTH_BITS-1:0] first, last; // the oldest, and where the next goes
    reg    [DEPTH_BITS:0] count;
    wire   [DEPTH_BITS:0] count_next = count + {{DEPTH_BITS{1'b0}}, push} - {{DEPTH_BITS{1'b0}}, pops};

    assign waits = count != 0;
    assign full  = count_next == ALL[DEPTH_BITS:0];
    assign {front_misses, front_fills, front_replaces, front_at, front_pixel} = accesses[first];

    always @(posedge clk)
        if (rst) begin
            first <= 0;
            last  <= 0;
            count <= 0;
        end else begin
            count <= count_next;
            if (push) begin
                accesses[last] <= {push_misses, push_fills, push_replaces, push_at, push_pixel};
                last           <= last + 1'b1;
            end
            if (pops)
                first <= first + 1'b1;
        end

    // ---- misses ----

    function [MISS_BITS-1:0] after(input [MISS_BITS-1:0] miss);
        after = miss == LAST_MISS[MISS_BITS-1:0] ? 0 : miss + 1'b1;
    endfunction

    reg [NUMBER_BITS-1:0] victims [0:MISSES-1];
    reg      [MISSES-1:0] leaves;      // of each: it replaces a line which is not yet out of the way
    reg   [MISS_BITS-1:0] first_miss, last_miss;
    reg     [MISS_BITS:0] miss_count;
    wire                  miss_pushes = push & push_misses;
    wire                  miss_pops   = pops & front_misses;
    wire    [MISS_BITS:0] misses_next = miss_count + {{MISS_BITS{1'b0}}, miss_pushes} - {{MISS_BITS{1'b0}}, miss_pops};

    assign victim      = victims[first_miss];
    assign misses_full = misses_next == ALL_MISSES[MISS_BITS:0];

    always @(posedge clk)
        if (rst) begin
            first_miss <= 0;
            last_miss  <= 0;
            miss_count <= 0;
            leaves     <= 0;
            wants      <= 1'b0;
        end else begin
            miss_count <= misses_next;
            wants      <= miss_pushes & push_fills;
            if (miss_pops)
                first_miss <= after(first_miss);
            if (front_misses & clears)
                leaves[first_miss] <= 1'b0;
            if (miss_pushes) begin
                line               <= push_line;
                victims[last_miss] <= push_victim;
                leaves[last_miss]  <= push_replaces;
                last_miss          <= after(last_miss);
            end
        end

    integer i;
    always @* begin
        i       = 0;
        leaving = 1'b0;
        if (ask) begin
            leaving = miss_pushes & push_replaces & push_victim == asked;
            for (i = 0; i < MISSES; i = i + 1)
                if (leaves[i] && victims[i] == asked &&
                    !(front_misses && clears_clean && i[MISS_BITS-1:0] == first_miss))
                    leaving = 1'b1;
        end
    end
endmodule
