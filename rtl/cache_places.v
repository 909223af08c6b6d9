// cache_places.v - places of the write FIFO of a cache that writes through (docs/timing.md, section 7): each access takes
// the next at its look-up, and releases it when its pixel turns out not to be written, or has been.
//
//   take, take_line       in   an access is looked up, and its line
//   settle, settle_writes in   the blend of the oldest access that was not settled is over: whether its pixel is written
//   settle_line           out  its line
//   granted               in   the oldest write that had not the bus has it
//   full                  out  in the next cycle there is no place for another access
//   ask, asked, unsettled in, in, out  a line for which an access holds a place, but the last that took one (OWN)
//
//           take            settle        writes: their places, in order
//            ▼                ▼                 ┌──────────┐
//   places │...│ line, taken │...│ ──writes──►  │ 3  5  6  │ ──granted──► released
//                              └── or not ──────┴──────────┴────────────► released
module cache_places #(
    parameter WRITE_FIFO  = 16,
    parameter NUMBER_BITS = 24,
    parameter OWN         = 1
) (
    input                        clk,
    input                        rst,
    input                        through,

    input                        take,
    input      [NUMBER_BITS-1:0] take_line,
    input                        settle,
    input                        settle_writes,
    output     [NUMBER_BITS-1:0] settle_line,
    input                        granted,
    output                       full,

    input                        ask,
    input      [NUMBER_BITS-1:0] asked,
    output reg                   unsettled
);
    localparam PLACE_BITS = WRITE_FIFO > 1 ? $clog2(WRITE_FIFO) : 1;
    localparam [31:0] LAST = WRITE_FIFO - 1;

    reg [NUMBER_BITS-1:0] lines   [0:WRITE_FIFO-1];
    reg  [PLACE_BITS-1:0] writing [0:WRITE_FIFO-1]; // places whose write has not the bus
    reg  [WRITE_FIFO-1:0] taken, kept;              // kept: not released in this cycle
    reg  [PLACE_BITS-1:0] taking, own, settling;    // the place of the next access, of the last, of the next to settle
    reg  [PLACE_BITS-1:0] first_write, last_write;

    function [PLACE_BITS-1:0] after(input [PLACE_BITS-1:0] place);
        after = place == LAST[PLACE_BITS-1:0] ? 0 : place + 1'b1;
    endfunction

    assign settle_line = lines[settling];
    wire [PLACE_BITS-1:0] next = take ? after(taking) : taking;
    assign full        = through & (kept[next] | (take & next == taking));

    always @* begin
        kept = taken;
        if (through) begin
            if (settle & ~settle_writes)
                kept[settling] = 1'b0;
            if (granted)
                kept[writing[first_write]] = 1'b0;
        end
    end

    always @(posedge clk)
        if (rst) begin
            taken       <= 0;
            taking      <= 0;
            settling    <= 0;
            first_write <= 0;
            last_write  <= 0;
        end else if (through) begin
            taken <= kept;
            if (take) begin
                taken[taking] <= 1'b1;
                lines[taking] <= take_line;
                own           <= taking;
                taking        <= next;
            end
            if (settle)
                settling <= after(settling);
            if (settle & settle_writes) begin
                writing[last_write] <= settling;
                last_write          <= after(last_write);
            end
            if (granted)
                first_write <= after(first_write);
        end

    integer i;
    always @* begin
        i         = 0;
        unsettled = 1'b0;
        if (through & ask)
            for (i = 0; i < WRITE_FIFO; i = i + 1)
                if (kept[i] && lines[i] == asked && !(OWN != 0 && i[PLACE_BITS-1:0] == own))
                    unsettled = 1'b1;
    end
endmodule
