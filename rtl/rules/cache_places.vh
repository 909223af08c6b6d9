// Places are within the FIFO (docs/table-mutation.md).
localparam [PLACE_BITS:0] RULE_PLACES = WRITE_FIFO;
(* keep *) wire rules = rst || ({1'b0, taking} < RULE_PLACES && {1'b0, settling} < RULE_PLACES && {1'b0, first_write} < RULE_PLACES &&
    {1'b0, last_write} < RULE_PLACES);
