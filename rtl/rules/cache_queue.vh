// The queue's counts and places are within it (docs/table-mutation.md).
localparam [DEPTH_BITS:0] RULE_DEPTH = DEPTH;
localparam [MISS_BITS:0] RULE_MISSES = MISSES;
(* keep *) wire rules = rst || (count <= RULE_DEPTH && miss_count <= RULE_MISSES && {1'b0, first_miss} < RULE_MISSES &&
    {1'b0, last_miss} < RULE_MISSES && {1'b0, miss_count} <= {1'b0, count} && (!pops || waits));
