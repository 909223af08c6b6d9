// status.vh - what report_status says: idle, busy, or stalled and why, as vodr_stall of cmodel/vodr.h counts the causes.
`ifndef STATUS_VH
`define STATUS_VH

`define STATUS_IDLE                  4'd0
`define STATUS_BUSY                  4'd1
`define STATUS_STALLED_DIVIDER       4'd2
`define STATUS_STALLED_SLICE         4'd3
`define STATUS_STALLED_TEXTURE_LOAD  4'd4
`define STATUS_STALLED_FRAGMENT_FIFO 4'd5
`define STATUS_STALLED_CACHE         4'd6
`define STATUS_STALLED_HAZARD        4'd7
`define STATUS_STALLED_WRITE_BACK    4'd8
`define STATUS_STALLED_FILL          4'd9
`define STATUS_STALLED_DRAM_ROW      4'd10
`define STATUS_STALLED_DRAM_REFRESH  4'd11

`endif
