// box_bound.v - where a box of voxels can appear: a rectangle of pixels and a range of slices (docs/timing.md, section 2).
// Part of volume_divider.
//
//   step          of the bounding: 1 to 8 the sums, 9 to 24 the quotients, 25 the edges; the bound stands from 26 on
//   lo_*, hi_*    the box, half-open, voxels
//   clip_*        pixels that there are
//   bound_*       rows derived from the view, for x, y, z and k
//   x0 .. k1      the bound; some: it is not empty
//
//                 row by row: z, k, x, y, each its least, then its greatest
//                  +--------+     +-------------+     +------------------+
//   bound_* ------>| select |---->| 3 products, |--+->| nearest, farthest |---+
//   lo_*, hi_* --->|        |     | a sum       |  |  +------------------+   v
//                  +--------+     +-------------+  |  +------------------------+
//                                                  +->| 6 edges: shift, or one |--> x0, y0, x1, y1, k0, k1
//                                                     | bit of a quotient a    |
//                                                     | cycle; cut             |
//                                                     +------------------------+
module box_bound (
    input                    clk,
    input              [4:0] step,
    input                    perspective,
    input             [14:0] slices,
    input             [14:0] centre_x, centre_y,
    input             [15:0] lo_x, lo_y, lo_z, hi_x, hi_y, hi_z,
    input             [14:0] clip_x0, clip_y0, clip_x1, clip_y1,

    input signed      [31:0] bound_x_m_x, bound_x_m_y, bound_x_m_z,
    input signed      [31:0] bound_y_m_x, bound_y_m_y, bound_y_m_z,
    input signed      [31:0] bound_z_m_x, bound_z_m_y, bound_z_m_z,
    input signed      [31:0] bound_k_m_x, bound_k_m_y, bound_k_m_z,
    input signed      [52:0] bound_x_lo, bound_x_hi, bound_y_lo, bound_y_hi,
    input signed      [52:0] bound_z_lo, bound_z_hi, bound_k_lo, bound_k_hi,
    input              [4:0] bound_x_fraction, bound_y_fraction, bound_k_fraction,

    output            [14:0] x0, y0, x1, y1, k0, k1,
    output                   some
);
    // m times the border of the box that makes the sum least, or greatest.
    function signed [52:0] product(input signed [31:0] m, input [15:0] lo, input [15:0] hi, input is_greatest);
        product = m * $signed({37'd0, m[31] ^ is_greatest ? hi : lo});
    endfunction

    // ---- a sum a cycle ----

    wire greatest = ~step[0];
    reg signed [52:0] sum;

    always @* begin : summing
        reg signed [31:0] m_x, m_y, m_z;
        reg signed [52:0] constant;
        m_x = 32'sd0;
        m_y = 32'sd0;
        m_z = 32'sd0;
        constant = 53'sd0;
        sum = 53'sd0;
        if (step >= 5'd1 && step <= 5'd8) begin
            case (step)
                5'd1, 5'd2: begin
                    m_x = bound_z_m_x;
                    m_y = bound_z_m_y;
                    m_z = bound_z_m_z;
                    constant = greatest ? bound_z_hi : bound_z_lo;
                end
                5'd3, 5'd4: begin
                    m_x = bound_k_m_x;
                    m_y = bound_k_m_y;
                    m_z = bound_k_m_z;
                    constant = greatest ? bound_k_hi : bound_k_lo;
                end
                5'd5, 5'd6: begin
                    m_x = bound_x_m_x;
                    m_y = bound_x_m_y;
                    m_z = bound_x_m_z;
                    constant = greatest ? bound_x_hi : bound_x_lo;
                end
                default: begin
                    m_x = bound_y_m_x;
                    m_y = bound_y_m_y;
                    m_z = bound_y_m_z;
                    constant = greatest ? bound_y_hi : bound_y_lo;
                end
            endcase
            sum = constant + product(m_x, lo_x, hi_x, greatest) + product(m_y, lo_y, hi_y, greatest) +
                  product(m_z, lo_z, hi_z, greatest);
        end
    end

    // ---- what becomes of it ----

    reg signed [52:0] nearest, farthest; // depths; a box that is not in front of the eye throughout is bounded by the clip

    always @(posedge clk)
        if (step == 5'd1)
            nearest <= sum;
        else if (step == 5'd2)
            farthest <= sum;

    wire divide = perspective && step >= 5'd9 && step <= 5'd24;
    wire finish = perspective && step == 5'd25;

    box_bound_edge #(.END(0)) edge_k0 (
        .clk(clk), .take(step == 5'd3), .divide(1'b0), .finish(1'b0), .perspective(1'b0), .sum(sum),
        .fraction(bound_k_fraction), .nearest(53'sd0), .farthest(51'd0), .centre(15'd0), .from(15'd0), .to(slices), .edge_px(k0));
    box_bound_edge #(.END(1)) edge_k1 (
        .clk(clk), .take(step == 5'd4), .divide(1'b0), .finish(1'b0), .perspective(1'b0), .sum(sum),
        .fraction(bound_k_fraction), .nearest(53'sd0), .farthest(51'd0), .centre(15'd0), .from(15'd0), .to(slices), .edge_px(k1));
    box_bound_edge #(.END(0)) edge_x0 (
        .clk(clk), .take(step == 5'd5), .divide(divide), .finish(finish), .perspective(perspective), .sum(sum),
        .fraction(bound_x_fraction), .nearest(nearest), .farthest(farthest[50:0]), .centre(centre_x), .from(clip_x0), .to(clip_x1), .edge_px(x0));
    box_bound_edge #(.END(1)) edge_x1 (
        .clk(clk), .take(step == 5'd6), .divide(divide), .finish(finish), .perspective(perspective), .sum(sum),
        .fraction(bound_x_fraction), .nearest(nearest), .farthest(farthest[50:0]), .centre(centre_x), .from(clip_x0), .to(clip_x1), .edge_px(x1));
    box_bound_edge #(.END(0)) edge_y0 (
        .clk(clk), .take(step == 5'd7), .divide(divide), .finish(finish), .perspective(perspective), .sum(sum),
        .fraction(bound_y_fraction), .nearest(nearest), .farthest(farthest[50:0]), .centre(centre_y), .from(clip_y0), .to(clip_y1), .edge_px(y0));
    box_bound_edge #(.END(1)) edge_y1 (
        .clk(clk), .take(step == 5'd8), .divide(divide), .finish(finish), .perspective(perspective), .sum(sum),
        .fraction(bound_y_fraction), .nearest(nearest), .farthest(farthest[50:0]), .centre(centre_y), .from(clip_y0), .to(clip_y1), .edge_px(y1));

    assign some = k0 < k1 && x0 < x1 && y0 < y1 && !(perspective && farthest <= 53'sd0);
endmodule
