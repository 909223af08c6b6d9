// over_blender.v - an alpha blender of somebody else's: `over` at 8 bits a channel, before a blocking pixel cache.
// vodr render ... --rtl alpha_blender=docs/examples/over_blender.v holds it against the model (docs/cosimulation.md).
module alpha_blender (
    input             clk,
    input             rst,

    input             colour_valid, colour_dead, // a fragment is offered to the pixel cache; this block listens
    input      [31:0] colour_rgba,
    input             colour_ready,              // the cache takes it
    input             colour_gone,               // the one it took before is looked up in this cycle
    input             colour_hazard,             // it waits because its pixel is still being blended

    input             pixel_valid,               // the pixel of the oldest fragment that is gone
    input      [31:0] pixel_rgba,

    output reg        blended_known,             // the cycle after: is it written?
    output            blended_known_writes,
    output reg        blended_valid,             // blend_cycles - 1 = 3 after the read: the pixel
    output            blended_writes,
    output reg [31:0] blended_rgba,

    output reg  [3:0] report_status,             // 0 idle, 1 busy, 6 waits for the cache, 7 for a hazard
    output reg        report_idle
);
    // With a blocking cache no more than one fragment is gone and not read.
    reg        waiting, waiting_dead, reading;
    reg [31:0] waiting_rgba, source, result;

    wire takes = colour_valid & colour_ready;
    wire goes  = waiting & colour_gone;
    wire waits = takes | (waiting & ~goes);
    wire reads = (goes & ~waiting_dead) | (reading & ~pixel_valid);

    // (255 - a)*c/255, rounded to nearest
    function [7:0] fade(input [7:0] c, input [7:0] a);
        reg [15:0] x;
        begin
            x    = (8'd255 - a) * c + 16'd128;
            fade = (x + {8'd0, x[15:8]}) >> 8;
        end
    endfunction

    wire [7:0] a = source[31:24];

    always @(posedge clk) begin
        waiting <= ~rst & waits;
        reading <= ~rst & reads;
        if (takes) begin
            waiting_dead <= colour_dead;
            waiting_rgba <= colour_rgba;
        end
        if (goes & ~waiting_dead)
            source <= waiting_rgba;

        blended_known <= ~rst & pixel_valid;
        result        <= source + {fade(pixel_rgba[31:24], a), fade(pixel_rgba[23:16], a),
                                   fade(pixel_rgba[15:8], a), fade(pixel_rgba[7:0], a)};
        blended_valid <= ~rst & blended_known;
        blended_rgba  <= result;

        report_idle   <= rst | ~(waits | reads);
        report_status <= rst | ~waiting ? 4'd0 : goes ? 4'd1 : colour_hazard ? 4'd7 : 4'd6;
    end

    assign blended_known_writes = 1'b1;
    assign blended_writes       = 1'b1;
endmodule
