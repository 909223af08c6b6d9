// started.vh - what every file of properties here begins with: the first cycle is one of reset, and nothing is asserted
// in it; reset may come again at any time.
reg started = 1'b0;
always @(posedge clk) started <= 1'b1;
always @* if (!started) assume (rst);
