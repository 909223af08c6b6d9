// frame_buffer.v - the memory bus behind the pixel cache (the frame buffer of Figure 2; docs/timing.md, section 8):
// serves one transaction at a time, fills before writes before loads, and hands on what memory answers when it comes.
//
//   port     way  what it is
//   fill     in   strobe: a line is wanted
//   filled   out  strobe: it came; lines come in the order in which they were wanted
//   write    in   strobe: a line, or a pixel that is written through, with its data. One line at a time waits, or
//                 WRITE_FIFO pixels do
//   written  out  strobe: the oldest write has the bus
//   load     in   link: so many bytes of a brick are wanted; out: its ready, the strobe that its last burst has the
//                 bus, its data, a beat at a time
//   memory   out  to the memory itself: a beat is read or written at an address, the beat's first byte's; answers come
//            in   latency - 2 cycles after what they answer is seen: mem_latency_cycles or dram_tcas_cycles, 3 or more
//   report   out  status and idle
//
//   fill ──► FIFO ──┐                  ┌──────────────┐     ┌───────────────┐
//   write ─► FIFO ──┼─► grant ────────►│ wait: DRAM's │────►│ a beat a cycle│──► memory_read, _write, _address
//   load ──────────►┘   when the bus   │ refresh, row │     └───────────────┘     ▲
//                       is free        └──────────────┘             │             │
//            its data ──► sending: a shift register, a beat a cycle ┼─────────────┘ memory_write_data
//                                                                   ▼
//   filled ◄── a line from its beats ◄──┐    what arrives ◄── in flight: a delay line as long as the latency
//   load_data ◄─────────────────────────┴─── memory_read_data
`include "vodr_hw.vh"
`include "status.vh"

module frame_buffer #(
    parameter FB_BITS            = `VODR_DEFAULT_FB_BITS,
    parameter LINE_W             = 16,
    parameter LINE_H             = 1,
    parameter MEM_BUS_BYTES      = `VODR_DEFAULT_MEM_BUS_BYTES,
    parameter NONBLOCKING        = `VODR_DEFAULT_NONBLOCKING,
    parameter NONBLOCKING_MISSES = `VODR_DEFAULT_NONBLOCKING_MISSES,
    parameter WRITE_FIFO         = `VODR_DEFAULT_WRITE_FIFO
) (
    input                                 clk,
    input                                 rst,

    input                                 memory, // fixed latency, or DRAM
    input                          [15:0] mem_latency_cycles,
    input                           [6:0] dram_banks,
    input                          [16:0] dram_row_bytes,
    input                           [7:0] dram_trcd_cycles,
    input                           [7:0] dram_tcas_cycles,
    input                           [7:0] dram_trp_cycles,
    input                          [19:0] dram_refresh_cycles,
    input                          [15:0] dram_trfc_cycles,
    input                          [12:0] texture_burst_bytes,

    input                                 fill_valid,
    input                          [47:0] fill_address,
    output reg                            filled_valid,
    output reg [LINE_W*LINE_H*FB_BITS*4-1:0] filled_data,

    input                                 write_valid,
    input                          [47:0] write_address,
    input                          [13:0] write_bytes,
    input      [LINE_W*LINE_H*FB_BITS*4-1:0] write_data,
    output reg                            written_valid,

    input                                 load_valid,
    input                          [47:0] load_address,
    input                          [31:0] load_bytes,
    output reg                            load_ready,
    output reg                            load_granted,
    output reg                            load_data_valid,
    output reg                      [8:0] load_data_bytes,
    output reg      [8*MEM_BUS_BYTES-1:0] load_data,

    output reg                            memory_read,
    output reg                            memory_write,
    output reg                     [47:0] memory_address,
    output reg                      [8:0] memory_write_bytes,
    output reg      [8*MEM_BUS_BYTES-1:0] memory_write_data,
    input           [8*MEM_BUS_BYTES-1:0] memory_read_data,

    output reg                      [3:0] report_status,
    output reg                            report_idle
);
    localparam PIXEL       = 4 * FB_BITS;
    localparam LINE        = LINE_W * LINE_H * PIXEL;
    localparam BEAT        = 8 * MEM_BUS_BYTES;
    localparam SENT        = LINE > BEAT ? LINE : BEAT;
    localparam LINE_BYTES  = LINE / 8;
    localparam PIXEL_BYTES = PIXEL / 8;
    localparam LAST_BEAT   = (LINE + BEAT - 1) / BEAT - 1; // of a line
    localparam FILLS       = NONBLOCKING != 0 ? NONBLOCKING_MISSES : 1; // that can wait
    localparam FILL_BITS   = FILLS > 1 ? $clog2(FILLS) : 1;
    localparam WRITE_BITS  = WRITE_FIFO > 1 ? $clog2(WRITE_FIFO) : 1;

    localparam [1:0] FILL = 0, WRITE = 1, LOAD = 2; // kinds of transactions

    // ---- what waits for the bus; what comes in this cycle can be granted in it ----

    reg         [47:0] fills [0:(1<<FILL_BITS)-1];
    reg  [FILL_BITS:0] fill_first, fill_end; // the oldest, and where the next goes; the highest bit counts rounds
    wire               fill_waits = fill_first != fill_end;
    wire               fill_here  = fill_waits | fill_valid;
    wire        [47:0] fill_next  = fill_waits ? fills[fill_first[FILL_BITS-1:0]] : fill_address;

    always @(posedge clk)
        if (rst) begin
            fill_first <= 0;
            fill_end   <= 0;
        end else begin
            if (fill_valid) begin
                fills[fill_end[FILL_BITS-1:0]] <= fill_address;
                fill_end <= fill_end + 1'b1;
            end
            if (grant_fill)
                fill_first <= fill_first + 1'b1;
        end

    reg          [47:0] write_addresses [0:(1<<WRITE_BITS)-1];
    reg     [PIXEL-1:0] pixels          [0:(1<<WRITE_BITS)-1];
    reg      [LINE-1:0] line;      // the line that waits,
    reg                 line_waits;
    reg  [WRITE_BITS:0] write_first, write_end;
    wire                write_waits   = write_first != write_end;
    wire                write_here    = write_waits | write_valid;
    wire         [47:0] write_next    = write_waits ? write_addresses[write_first[WRITE_BITS-1:0]] : write_address;
    wire                write_is_line = write_waits ? line_waits : write_bytes > PIXEL_BYTES[13:0];

    always @(posedge clk)
        if (rst) begin
            write_first <= 0;
            write_end   <= 0;
        end else begin
            if (write_valid) begin
                write_addresses[write_end[WRITE_BITS-1:0]] <= write_address;
                pixels[write_end[WRITE_BITS-1:0]] <= write_data[PIXEL-1:0];
                line_waits <= write_bytes > PIXEL_BYTES[13:0]; // lines and pixels do not wait together
                if (write_bytes > PIXEL_BYTES[13:0])
                    line <= write_data;
                write_end <= write_end + 1'b1;
            end
            if (grant_write)
                write_first <= write_first + 1'b1;
        end

    reg  [47:0] load_from; // what is left of a load under way
    reg  [31:0] load_left;
    wire        load_here  = ~load_ready | load_valid;
    wire [47:0] load_next  = load_ready ? load_address : load_from;
    wire [31:0] load_rest  = load_ready ? load_bytes : load_left;
    wire        load_ends  = load_rest <= {19'd0, texture_burst_bytes};
    wire [13:0] load_burst = load_ends ? load_rest[13:0] : {1'b0, texture_burst_bytes};
    wire        load_stays = load_here & ~(grant_load & load_ends);

    always @(posedge clk)
        if (rst)
            load_ready <= 1'b1;
        else begin
            load_ready <= ~load_stays;
            if (load_here) begin
                load_from <= grant_load ? load_next + {34'd0, load_burst} : load_next;
                load_left <= grant_load ? load_rest - {18'd0, load_burst} : load_rest;
            end
        end

    // ---- the grant ----

    reg  [13:0] left; // bytes of the transaction at hand; none: the bus is free
    wire        bus_free    = left == 0;
    wire        grant_fill  = bus_free & fill_here;
    wire        grant_write = bus_free & ~fill_here & write_here;
    wire        grant_load  = bus_free & ~fill_here & ~write_here & load_here;
    wire        grant       = bus_free & (fill_here | write_here | load_here);

    always @(posedge clk) begin
        written_valid <= grant_write & ~rst;
        load_granted  <= grant_load & load_ends & ~rst;
    end

    // ---- DRAM: how long the grant waits ----

    wire [47:0] granted    = fill_here ? fill_next : write_here ? write_next : load_next;
    wire [47:0] row        = granted & ~{31'd0, dram_row_bytes - 17'd1};
    reg  [47:0] rows [0:63];    // the row that each bank has open: its first address;
    reg  [63:0] open;           // whether it has one
    reg  [19:0] since_refresh;  // cycles since one began, or since the start
    reg         refreshed;      // one began: the first does so after dram_refresh_cycles
    wire        refresh_begins = dram_refresh_cycles != 0 && since_refresh == dram_refresh_cycles - 20'd1;
    reg   [5:0] bank;
    wire [47:0] row_there      = rows[bank];
    reg   [8:0] wait_row;
    reg  [15:0] wait_refresh;

    // A row's number, modulo banks.
    function [5:0] bank_of(input [21:6] address, input [16:6] row_bytes, input [6:0] banks);
        integer i;
        begin
            bank_of = 6'd0;
            for (i = 6; i <= 16; i = i + 1)
                if (row_bytes[i])
                    bank_of = address[i +: 6];
            for (i = 0; i < 6; i = i + 1)
                if (banks <= 7'd1 << i)
                    bank_of[i] = 1'b0;
        end
    endfunction

    always @*
        if (memory & grant)
            bank = bank_of(granted[21:6], dram_row_bytes[16:6], dram_banks);
        else
            bank = 6'd0;

    always @* begin
        wait_row     = 9'd0;
        wait_refresh = 16'd0;
        if (memory & grant) begin
            if (~open[bank])
                wait_row = {1'b0, dram_trcd_cycles};
            else if (row_there != row)
                wait_row = {1'b0, dram_trp_cycles} + {1'b0, dram_trcd_cycles};
            if (refreshed && since_refresh < {4'd0, dram_trfc_cycles})
                wait_refresh = dram_trfc_cycles - since_refresh[15:0];
        end
    end

    // A refresh closes all rows; nobody looks at them until the next grant. The first grant after one began waits for
    // its end, so that no other meets it.
    always @(posedge clk)
        if (rst) begin
            since_refresh <= 20'd0;
            refreshed     <= 1'b0;
            open          <= 64'd0;
        end else if (memory) begin
            since_refresh <= refresh_begins ? 20'd0 : since_refresh + 20'd1;
            if (refresh_begins) begin
                refreshed <= 1'b1;
                open      <= 64'd0;
            end else if (grant)
                open[bank] <= 1'b1;
            if (grant)
                rows[bank] <= row;
        end

    // ---- the transaction at hand: it waits, then moves a beat a cycle ----

    reg   [1:0] kind;
    reg  [47:0] address; // of the next beat
    reg   [8:0] row_left;
    reg  [15:0] refresh_left;
    wire  [1:0] kind_now     = ~grant ? kind : fill_here ? FILL : write_here ? WRITE : LOAD;
    wire [47:0] address_now  = grant ? granted : address;
    wire  [8:0] row_now      = grant ? wait_row : row_left;
    wire [15:0] refresh_now  = grant ? wait_refresh : refresh_left;
    wire [13:0] left_now     = ~grant     ? left
                             : fill_here  ? LINE_BYTES[13:0]
                             : write_here ? (write_is_line ? LINE_BYTES[13:0] : PIXEL_BYTES[13:0]) : load_burst;
    wire        moves        = left_now != 0 && row_now == 0 && refresh_now == 0;
    wire        moves_last   = left_now <= MEM_BUS_BYTES[13:0];
    wire  [8:0] beat_bytes   = moves_last ? left_now[8:0] : MEM_BUS_BYTES[8:0];
    wire        reads        = moves && kind_now != WRITE;
    wire [13:0] left_after   = ~moves ? left_now : moves_last ? 14'd0 : left_now - MEM_BUS_BYTES[13:0];

    always @(posedge clk)
        if (rst)
            left <= 14'd0;
        else begin
            left         <= left_after;
            kind         <= kind_now;
            address      <= moves ? address_now + {34'd0, MEM_BUS_BYTES[13:0]} : address_now;
            refresh_left <= refresh_now != 0 ? refresh_now - 16'd1 : 16'd0;
            row_left     <= refresh_now == 0 && row_now != 0 ? row_now - 9'd1 : row_now;
        end

    always @(posedge clk) begin
        memory_read  <= reads & ~rst;
        memory_write <= moves & ~reads & ~rst;
        if (moves) begin
            memory_address     <= address_now;
            memory_write_bytes <= beat_bytes;
        end
    end

    // ---- data of a write ----

    reg [SENT-1:0] sending; // what is left of it, the next beat lowest

    always @(posedge clk) begin : send
        reg [SENT-1:0] data;
        if (left_now != 0 && kind_now == WRITE) begin
            data = sending;
            if (grant) begin
                data = 0;
                if (write_is_line)
                    data[LINE-1:0] = write_waits ? line : write_data;
                else
                    data[PIXEL-1:0] = write_waits ? pixels[write_first[WRITE_BITS-1:0]] : write_data[PIXEL-1:0];
            end
            memory_write_data <= data[BEAT-1:0];
            sending <= moves ? data >> BEAT : data;
        end
    end

    // ---- data of reads: bytes of each beat in flight, at the place of the cycle in which it comes ----

    reg   [9:0] in_flight [0:65535]; // {of a fill, bytes}; no bytes: nothing comes
    reg  [15:0] place;
    reg         around;              // all places of the delay line were written
    reg  [15:0] flying;              // beats
    reg   [9:0] due;                 // what comes in this cycle
    reg  [13:0] filled_beats;        // of the line that comes
    wire [15:0] latency      = memory ? {8'd0, dram_tcas_cycles} : mem_latency_cycles;
    wire        last_place   = place == latency - 16'd2;
    wire [15:0] next_place   = last_place ? 16'd0 : place + 16'd1;
    wire        comes        = due[8:0] != 0;
    wire        fill_comes   = comes & due[9];
    wire        line_is_full = filled_beats == LAST_BEAT[13:0];
    wire [15:0] flying_after = flying + {15'd0, reads} - {15'd0, comes};

    always @(posedge clk)
        if (rst) begin
            place  <= 16'd0;
            around <= 1'b0;
            due    <= 10'd0;
            flying <= 16'd0;
        end else begin
            in_flight[place] <= reads ? {kind_now == FILL, beat_bytes} : 10'd0;
            place  <= next_place;
            around <= around | last_place;
            due    <= around | last_place ? in_flight[next_place] : 10'd0;
            flying <= flying_after;
        end

    // A line with a beat behind it, the oldest dropped.
    function [LINE-1:0] with_beat(input [LINE-1:0] beats, input [BEAT-1:0] beat);
        /* verilator lint_off UNUSEDSIGNAL */ // what is dropped, and of a beat what is beyond the line
        reg [LINE+BEAT-1:0] all;
        /* verilator lint_on UNUSEDSIGNAL */
        begin
            all = {beat, beats};
            with_beat = all[(LINE < BEAT ? LINE : BEAT) +: LINE];
        end
    endfunction

    always @(posedge clk) begin
        filled_valid    <= fill_comes & line_is_full & ~rst;
        load_data_valid <= comes & ~due[9] & ~rst;
        if (rst)
            filled_beats <= 14'd0;
        else if (fill_comes)
            filled_beats <= line_is_full ? 14'd0 : filled_beats + 14'd1;
        if (fill_comes)
            filled_data <= with_beat(filled_data, memory_read_data);
        if (comes) begin
            load_data       <= memory_read_data;
            load_data_bytes <= due[8:0];
        end
    end

    // ---- report ----

    wire [FILL_BITS:0]  fills_after  = fill_end - fill_first + {{FILL_BITS{1'b0}}, fill_valid}
                                     - {{FILL_BITS{1'b0}}, grant_fill};
    wire [WRITE_BITS:0] writes_after = write_end - write_first + {{WRITE_BITS{1'b0}}, write_valid}
                                     - {{WRITE_BITS{1'b0}}, grant_write};

    always @(posedge clk) begin
        report_idle   <= rst | (fills_after == 0 & writes_after == 0 & ~load_stays & left_after == 0
                                & flying_after == 0);
        report_status <= rst | left_now == 0 ? `STATUS_IDLE
                         : refresh_now != 0  ? `STATUS_STALLED_DRAM_REFRESH
                         : row_now != 0      ? `STATUS_STALLED_DRAM_ROW : `STATUS_BUSY;
    end
endmodule
