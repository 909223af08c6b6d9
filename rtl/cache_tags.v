// cache_tags.v - which lines the pixel cache holds, and which one a miss replaces (docs/architecture.md, section 9).
//
//   arrives, arriving   in   a fragment comes to the door: the number of its line
//   arriving_hit        out  the cache will hold that line in the next cycle
//   line, hit           out  registered: of the fragment at the door
//   look_up             in   the fragment at the door is looked up: what is known of lines changes
//   at                  out  then: the place of its line, which a miss gives it
//   replaces, victim    out  then: a miss puts it in the place of another line
//   flush, flush_at     in   when nothing is looked up: `at` is this place, and `victim` the line that it holds
//
//   arriving ─► set ─► tags of all ways ─► = ─► line, hit, way ──► at
//                         ▲   valid              │ set
//                         └──────── a miss ◄── order of ways, shift register
//
// A place is a set and a way of it. What lies in the memories of a set counts for ways that are valid, valid bits for
// sets that were used since reset: memories need no reset.
`include "vodr_hw.vh"

module cache_tags #(
    parameter SETS        = 16,
    parameter WAYS        = 4,
    parameter NUMBER_BITS = 24,
    parameter PLACE_BITS  = 6
) (
    input                        clk,
    input                        rst,
    input                        index,
    input                  [1:0] replacement,

    input                        arrives,
    input      [NUMBER_BITS-1:0] arriving,
    output reg                   arriving_hit,

    output reg [NUMBER_BITS-1:0] line,
    output reg                   hit,

    input                        look_up,
    input                        flush,
    input       [PLACE_BITS-1:0] flush_at,
    output      [PLACE_BITS-1:0] at,
    output reg                   replaces,
    output reg [NUMBER_BITS-1:0] victim
);
    localparam SET_BITS = SETS > 1 ? $clog2(SETS) : 1;
    localparam WAY_BITS = WAYS > 1 ? $clog2(WAYS) : 1;
    localparam [WAY_BITS-1:0] LAST = {WAY_BITS{WAYS != 1}};
    localparam [15:0] SEED = 16'hACE1, TAPS = 16'hB400;

    reg [WAYS*NUMBER_BITS-1:0] tags  [0:SETS-1];
    reg    [WAYS*WAY_BITS-1:0] order [0:SETS-1]; // of each way: how many were used, or filled, after it
    reg             [WAYS-1:0] valid [0:SETS-1];
    reg             [SETS-1:0] used;
    reg                 [15:0] shifts;

    reg  [SET_BITS-1:0] set;
    reg  [WAY_BITS-1:0] hit_way, way;
    wire [SET_BITS-1:0] flush_set;
    wire [WAY_BITS-1:0] flush_way;
    wire [SET_BITS-1:0] at_set = flush ? flush_set : set;
    wire [WAY_BITS-1:0] at_way = flush ? flush_way : way;
    generate
        if (WAYS == 1) begin : direct_mapped
            assign at        = at_set;
            assign flush_set = flush_at;
            assign flush_way = 1'b0;
        end else if (SETS == 1) begin : fully_associative
            assign at        = at_way;
            assign flush_set = 1'b0;
            assign flush_way = flush_at;
        end else begin : set_associative
            assign at = {at_set, at_way};
            assign {flush_set, flush_way} = flush_at;
        end
    endgenerate

    // ---- a fragment arrives ----

    // A line's set: its number's lowest digit in base SETS, or the exclusive or of all digits.
    function [SET_BITS-1:0] set_of(input [NUMBER_BITS-1:0] number, input exclusive_or);
        reg [NUMBER_BITS-1:0] rest;
        integer digit;
        begin
            set_of = number[SET_BITS-1:0];
            rest   = number >> SET_BITS;
            if (exclusive_or)
                for (digit = SET_BITS; digit < NUMBER_BITS; digit = digit + SET_BITS) begin
                    set_of = set_of ^ rest[SET_BITS-1:0];
                    rest   = rest >> SET_BITS;
                end
            if (SETS == 1)
                set_of = 0;
        end
    endfunction

    // Whether a set holds a line, and in which way.
    function [WAY_BITS:0] found_in(input [WAYS-1:0] ways, input [WAYS*NUMBER_BITS-1:0] numbers,
                                   input [NUMBER_BITS-1:0] number);
        integer w;
        begin
            found_in = 0;
            for (w = 0; w < WAYS; w = w + 1)
                if (ways[w] && numbers[w*NUMBER_BITS +: NUMBER_BITS] == number)
                    found_in = {1'b1, w[WAY_BITS-1:0]};
        end
    endfunction

    wire                misses = look_up & ~hit;
    reg  [SET_BITS-1:0] arriving_set;
    reg  [WAY_BITS-1:0] arriving_way;

    // What is looked up in this cycle is in the cache from the next on.
    always @* begin
        arriving_set = 0;
        arriving_way = 0;
        arriving_hit = 1'b0;
        if (arrives) begin
            arriving_set = set_of(arriving, index);
            if (used[arriving_set])
                {arriving_hit, arriving_way} = found_in(valid[arriving_set], tags[arriving_set], arriving);
            if (misses && arriving == line) begin
                arriving_hit = 1'b1;
                arriving_way = way;
            end else if (misses && replaces && arriving == victim)
                arriving_hit = 1'b0;
        end
    end

    always @(posedge clk)
        if (arrives) begin
            line    <= arriving;
            set     <= arriving_set;
            hit     <= arriving_hit;
            hit_way <= arriving_way;
        end

    // ---- a miss takes a place ----

    // The invalid way of lowest number; the oldest when all are valid.
    function [WAY_BITS-1:0] oldest(input [WAYS-1:0] ways, input [WAYS*WAY_BITS-1:0] ages);
        integer w;
        begin
            oldest = 0;
            for (w = WAYS - 1; w >= 0; w = w - 1)
                if (&ways ? ages[w*WAY_BITS +: WAY_BITS] == LAST : ~ways[w])
                    oldest = w[WAY_BITS-1:0];
        end
    endfunction

    wire [WAYS-1:0] set_valid = used[set] ? valid[set] : 0;
    wire     [15:0] shifted = (shifts >> 1) ^ (shifts[0] ? TAPS : 16'd0);

    always @* begin
        way      = hit_way;
        replaces = 1'b0;
        if (misses) begin
            replaces = &set_valid;
            if (replaces && replacement == `VODR_REPLACEMENT_RANDOM)
                way = shifted[WAY_BITS-1:0] & LAST;
            else
                way = oldest(set_valid, order[set]);
        end
    end

    always @* begin
        victim = 0;
        if (misses | flush)
            victim = tags[at_set][at_way*NUMBER_BITS +: NUMBER_BITS];
    end

    always @(posedge clk)
        if (rst) begin
            used   <= 0;
            shifts <= SEED;
        end else if (misses) begin
            used[set]       <= 1'b1;
            valid[set]      <= set_valid | ({{(WAYS-1){1'b0}}, 1'b1} << way);
            tags[set][way*NUMBER_BITS +: NUMBER_BITS] <= line;
            if (replaces && replacement == `VODR_REPLACEMENT_RANDOM)
                shifts <= shifted;
        end

    // ---- the order of ways ----

    // The way becomes the newest; those that were newer, all when it was invalid, are one older.
    function [WAYS*WAY_BITS-1:0] newest(input [WAYS*WAY_BITS-1:0] ages, input [WAY_BITS-1:0] now, input was_invalid);
        integer w;
        begin
            newest = ages;
            for (w = 0; w < WAYS; w = w + 1)
                if (was_invalid || ages[w*WAY_BITS +: WAY_BITS] < ages[now*WAY_BITS +: WAY_BITS])
                    newest[w*WAY_BITS +: WAY_BITS] = ages[w*WAY_BITS +: WAY_BITS] + 1'b1;
            newest[now*WAY_BITS +: WAY_BITS] = 0;
        end
    endfunction

    always @(posedge clk)
        if (look_up && (!hit || (replacement == `VODR_REPLACEMENT_LRU && order[set][way*WAY_BITS +: WAY_BITS] != 0)))
            order[set] <= newest(order[set], way, ~hit & ~replaces);
endmodule
