// volume_divider.vh - of volume_divider.v: the brick link, and the walk over boxes (docs/timing.md, sections 2 and 3).
//
//: of volume_divider
//: proves the brick link: what is offered stays, unchanged, until it is taken; `fresh` is up in its first cycle, and only then
//: proves each brick with a fragment is offered once: it waits while another is offered; when no box is left nothing is offered any more
//: proves the turns of the three loops stay within the bricks of their axes
//: at
//: without what a box's bound is, and whether it has a fragment: any; products
//: hole that every brick is visited, and in visibility order: the order of three loops over 16-bit counters is beyond a bound; tests/test_volume_divider.c and lock-step compare it
//: by induction 2
//: covers 14
//: shrinks box_bound.v /^\);/,$c\);\nwire nothing = clk;\nendmodule
//: shrinks slice_probe.v /^\);/,$c\);\nwire nothing = clk;\nendmodule
//: shrinks volume_divider.v s/ \* / ^ /
//: breaks 12 volume_divider.v s/push += state == PUSH && !brick_valid/push = state == PUSH/
//: breaks 12 volume_divider.v s/brick_fresh <= push/brick_fresh <= offered/
//: breaks 12 volume_divider.v s/more_2  = at_2 . 16'd1 != /more_2  = at_2 != /

// ---- registers hold still; what is asked of the probe ----

reg [47:0] formal_bricks;
reg [22:0] formal_held;
always @(posedge clk) begin
    formal_bricks <= {bricks_x, bricks_y, bricks_z};
    formal_held   <= {nest_0, nest_1, nest_2, brick_setup_cycles, skip_empty};
end
wire [15:0] formal_of_0 = of_axis(nest_0, bricks_x, bricks_y, bricks_z), formal_of_1 = of_axis(nest_1, bricks_x, bricks_y, bricks_z),
            formal_of_2 = of_axis(nest_2, bricks_x, bricks_y, bricks_z);
always @*
    if (started) begin
        `REQUIRE (bricks_x != 0 && bricks_y != 0 && bricks_z != 0);
        `REQUIRE (formal_bricks == {bricks_x, bricks_y, bricks_z});
        `REQUIRE (formal_held == {nest_0, nest_1, nest_2, brick_setup_cycles, skip_empty});
        `REQUIRE (state == PROBE || !(found || exhausted)); // slice_probe's: only while it is probing
    end

// ---- the link ----

always @(posedge clk)
    if (started && !$past(rst) && !rst) begin
        if ($past(brick_valid && !brick_ready)) begin
            assert (brick_valid && !brick_fresh);
            assert ($stable({brick_number, brick_lo_x, brick_lo_y, brick_lo_z, brick_hi_x, brick_hi_y, brick_hi_z}));
            assert ($stable({brick_x0, brick_y0, brick_x1, brick_y1, brick_k0, brick_k1}));
        end
        if (brick_valid && !$past(brick_valid))
            assert (brick_fresh);
        if (brick_fresh) begin // it is the box that was at hand, and that is gone
            assert ($past(state == PUSH) && state != PUSH && brick_number == $past(number));
            assert ({brick_k0, brick_k1} == $past({k0, k1}));
        end
        if ($past(state == PUSH) && !brick_fresh)
            assert (state == PUSH && $stable({number, lo_x, lo_y, lo_z, hi_x, hi_y, hi_z}));
        if ($past(state == DONE))
            assert (state == DONE && !brick_fresh);
    end

// ---- the walk ----

always @*
    if (started && !rst) begin
        assert (!brick_fresh || brick_valid);
        assert (level <= BRICK);
        assert (at_0 < formal_of_0 && at_1 < formal_of_1 && at_2 < formal_of_2);
        assert (level == BRICK || at_2 == 0);
        assert (level != SLAB || at_1 == 0);
        assert (!report_idle || (state == DONE && !brick_valid));
        cover (push && at_2 == 16'd1);
        cover (state == PUSH && brick_valid && !brick_ready);
        cover (report_idle && at_2 == 16'd0);
    end
