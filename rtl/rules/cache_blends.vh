// Slots are taken in turn; the one that is next is over (docs/table-mutation.md).
localparam [SLOT_BITS:0] RULE_SLOTS = BLEND_CYCLES;
(* keep *) wire rules = rst || ({1'b0, now} < RULE_SLOTS);
