// slice_generator.vh - of slice_generator.v: its links (docs/timing.md, sections 4 and 13), and that a brick becomes its slices.
//
//: of slice_generator
//: proves the slice link: what is offered stays, unchanged, until it is taken; the brick link: a brick is taken only when none is at hand
//: proves each slice of a brick is offered once, in order, from k0 to k1 - 1, or in `under` back; `last` with the last, and only with it
//: proves a brick comes to its end: its set-up and its slices left never grow, and one of them shrinks in each cycle that the link is free
//: at
//: quick
//: without the values of planes and limits: what a slice's registers are given is any number
//: by induction 2
//: covers 14
//: shrinks slice_plane.vh s/ \* / ^ /
//: breaks 8 slice_generator.v s/push = ready_to_push && !slice_valid/push = ready_to_push/
//: breaks 10 slice_generator.v s/slice_last <= k_next == k_behind/slice_last <= k == k_behind/
//: breaks 8 slice_generator.v s/k <= k_next;/k <= k_next + 15'd1;/

// ---- what is asked of the divider: slices that there are; registers that hold still ----

reg        formal_under;
reg [15:0] formal_setup;
always @(posedge clk) {formal_under, formal_setup} <= {under, slice_setup_cycles};
always @*
    if (started) begin
        `REQUIRE (rst || !brick_valid || brick_k0 <= brick_k1);
        `REQUIRE (under == formal_under && slice_setup_cycles == formal_setup);
    end

// ---- the link ----

always @(posedge clk)
    if (started && !$past(rst) && !rst && $past(slice_valid && !slice_ready)) begin
        assert (slice_valid);
        assert ($stable({slice_last, slice_k, slice_x0, slice_y0, slice_x1, slice_y1}));
        assert ($stable({slice_origin_x, slice_origin_y, slice_origin_z, slice_step_u_x, slice_step_u_y, slice_step_u_z}));
        assert ($stable({slice_step_v_x, slice_step_v_y, slice_step_v_z}));
        assert ($stable({slice_lo_x, slice_lo_y, slice_lo_z, slice_hi_x, slice_hi_y, slice_hi_z}));
    end

// ---- slices of the brick at hand: how many were offered, and of which brick ----

reg [14:0] formal_k0, formal_k1, formal_done;
always @(posedge clk)
    if (pop) begin
        {formal_k0, formal_k1} <= {brick_k0, brick_k1};
        formal_done <= 0;
    end else if (push)
        formal_done <= formal_done + 15'd1;

wire [14:0] formal_now   = under ? formal_k1 - 15'd1 - formal_done : formal_k0 + formal_done;
wire [14:0] formal_left  = formal_k1 - formal_k0 - formal_done; // slices
always @*
    if (started && !rst) begin
        assert (brick_ready || slice_valid || generating);
        if (generating) begin
            assert (formal_k0 < formal_k1 && formal_done < formal_k1 - formal_k0);
            assert (k == formal_now && k_behind == (under ? formal_k0 - 15'd1 : formal_k1));
            assert (setup_left <= slice_setup_cycles);
        end
        assert (report_idle == (brick_ready && !slice_valid));
    end

reg        formal_fresh, formal_over; // a slice was pushed in the cycle before; and it was the brick's last
reg [14:0] formal_pushed;
always @(posedge clk) begin
    formal_fresh  <= push && !rst;
    formal_over   <= formal_left == 15'd1;
    formal_pushed <= formal_now;
end
always @*
    if (started && formal_fresh) begin
        assert (slice_valid && slice_k == formal_pushed && slice_last == formal_over);
        assert (formal_over == brick_ready);
    end

// ---- it ends ----

always @(posedge clk)
    if (started && !$past(rst) && !rst && $past(generating) && generating) begin
        assert (formal_left <= $past(formal_left));
        assert (formal_left < $past(formal_left) || setup_left < $past(setup_left) || $past(slice_valid));
    end

always @*
    if (started && !rst) begin
        cover (push && slice_setup_cycles == 16'd2 && formal_done == 15'd1 && under);
        cover (slice_valid && slice_last && formal_done == 15'd2 && !under);
        cover (ready_to_push && slice_valid && !slice_ready);
        cover (pop && brick_k0 == brick_k1);
    end
