// bench.v - replays vectors of a block (docs/vectors.md) against its module, with no C: plain Verilog-2005. Which block, its
// ports and parameters are in bench_ports.vh, which scripts/vectors-bench makes of the vectors' first line.
//
//   +vectors=FILE   what is replayed; one line is a cycle: inputs, a bar, what outputs are after it
//
// `PASS` or `FAIL` is the last line. It fails when an output differs or is unknown (x in vectors means any), and when lines
// or the last line are missing. Registers hold still in a case; at a case's beginning rst is up, for some cycles, in which
// its table is written.
`timescale 1ns / 1ns

module bench;
    localparam RESET_CYCLES = 2;

    reg clk = 0;
    reg rst = 1;

    integer        file, fields, line = 1, cycles = 0, failures = 0, expected_cycles, i;
    reg [8*64-1:0] word; // the first word of a line; of the line of a cycle it is rst
    reg [8*256-1:0] name;
    reg            over = 0;

    `include "bench_ports.vh"

    // ---- reading ----

    task fail(input [8*64-1:0] why);
        begin
            $display("line %0d: %0s", line, why);
            failures = failures + 1;
            over     = 1;
        end
    endtask

    task skip_line;
        begin
            i = $fgetc(file);
            while (i != "\n" && i != -1)
                i = $fgetc(file);
            line = line + 1;
        end
    endtask

    task tick; // outputs have settled when it is over
        begin
            #1 clk = 1;
            #1 clk = 0;
        end
    endtask

    task read_table;
        integer entries;
        begin
            fields = $fscanf(file, "%d", entries);
            table_write(entries);
        end
    endtask

    task run_cycle;
        begin
            rst = word == "1";
            read_cycle;
            if (fields != COLUMNS - 1)
                fail("a column is missing, or is no number");
            else begin
                tick;
                check_cycle;
                cycles = cycles + 1;
            end
        end
    endtask

    initial begin
        if (!$value$plusargs("vectors=%s", name))
            name = "/dev/stdin";
        file = $fopen(name, "r");
        if (file == 0)
            fail("the vectors cannot be read");
        else
            skip_line;
        while (!over) begin
            fields = $fscanf(file, "%s", word);
            if (fields != 1)
                fail("the last line is missing");
            else if (word == "0" || word == "1")
                run_cycle;
            else if (word == "registers") begin
                read_registers;
                for (i = 0; i < RESET_CYCLES; i = i + 1)
                    tick;
            end else if (word == "table")
                read_table;
            else if (word == "end") begin
                fields = $fscanf(file, "%d", expected_cycles);
                if (fields != 1 || expected_cycles != cycles)
                    fail("cycles are missing, by the last line");
                over = 1;
            end else if (word == "case")
                rst = 1;
            else if (word != "machine" && word != "view" && word != "volume" && word != "voxels")
                fail("there is no such line");
            if (!over)
                skip_line;
            if (failures >= 10)
                over = 1;
        end
        $display("%0s: %0d cycles", `BENCH_BLOCK, cycles);
        if (failures == 0)
            $display("PASS");
        else
            $display("FAIL");
        $finish;
    end
endmodule
