#!/bin/sh
# cosim.sh - co-simulation from outside: faults planted in each block's Verilog are named with the right block, modules
# that do not fit are refused by port and width, what hangs is told.
#   tests/cosim.sh [--long] VODR    --long: a fault in every block
set -u
long=
if [ "${1:-}" = --long ]; then
    long=1
    shift
fi
# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"

# A volume whose voxels are all different from their neighbours; densities from an LFSR.
awk 'BEGIN { s = 1; for (i = 0; i < 8000; i++) { s = (s * 75 + 74) % 65537; printf "%c", 32 + s % 90 } }' >volume.raw
draw() { # OPTIONS...: two views' worth of bricks, misses, write-backs
    "$vodr" render volume.raw --dims 20x20x20 --type uint8 --view 30,20 --size 40x40 --set cache_bytes=512 "$@"
}

# ---- the same as in C ----

statistics() { # FILE: without what names the run and its speed
    sed -e '/"wall_s"/d' -e '/"fragments_per_s"/d' "$1"
}
draw --cycles --stats c.json --raw c.rgba >/dev/null
for blocks in all top pixel_cache,alpha_blender; do
    good "--rtl $blocks" draw --rtl "$blocks" --stats rtl.json --raw rtl.rgba
    same "--rtl $blocks draws the same bytes" c.rgba rtl.rgba
    statistics c.json >c.txt
    statistics rtl.json >rtl.txt
    same "--rtl $blocks counts the same" c.txt rtl.txt
done
others=volume_divider,slice_generator,rasterizer,alpha_blender,pixel_cache,frame_buffer
for filter in cardinal bspline; do
    draw --filter $filter --cycles --stats cubic.json --raw cubic.rgba >/dev/null
    good "--filter $filter, all in Verilog but the texture unit" draw --filter $filter --rtl $others --stats rtl.json --raw rtl.rgba
    same "--filter $filter draws the same bytes" cubic.rgba rtl.rgba
    statistics cubic.json >cubic.txt
    statistics rtl.json >rtl.txt
    same "--filter $filter counts the same" cubic.txt rtl.txt
    bad 2 "filter=$filter: texture_unit in Verilog takes nearest and linear only" draw --filter $filter --rtl texture_unit
done
good '--compare transactions' draw --rtl all --compare transactions --raw rtl.rgba
same '--compare transactions draws the same bytes' c.rgba rtl.rgba
good 'a block of somebody else' draw --rtl "alpha_blender=$root/docs/examples/over_blender.v" --raw rtl.rgba
same 'a block of somebody else draws the same bytes' c.rgba rtl.rgba

# ---- planted faults ----

# fault BLOCK FILE SED OPTIONS...: the block's Verilog with a change that sed makes in one of its files
fault() {
    block=$1 file=$2 edit=$3
    shift 3
    rm -rf planted
    mkdir planted
    cp "$root"/rtl/*.v "$root"/rtl/*.vh planted
    sed -e "$edit" "$root/rtl/$file" >"planted/$file"
    problem=
    cmp -s "$root/rtl/$file" "planted/$file" && problem='the edit changes nothing'
    draw --rtl "$block=planted/$block.v" -o planted.png "$@" >../out 2>../err
    code=$?
    [ $code -eq 1 ] || problem="$problem, exit code $code"
    grep -qE "^vodr: $block differs in cycle [0-9]+, port [a-z_0-9]+: expected .*, got .* \(brick [0-9]+.*\.gtkw\$" ../err ||
        problem="$problem, said: $(cat ../err)"
    [ -s planted-differs.fst ] && [ -s planted-differs.gtkw ] || problem="$problem, no waveform"
    rm -rf planted planted-differs.*
    verdict "planted in $block: $edit" "$problem"
}

fault alpha_blender alpha_blender.v 's/<< (FB_BITS - 1)/<< (FB_BITS - 2)/'
fault pixel_cache cache_tags.v 's/ages\[w\*WAY_BITS +: WAY_BITS\] == LAST/ages[w*WAY_BITS +: WAY_BITS] + 1 == LAST/'
fault pixel_cache pixel_cache.v "s/dirty\[known_at\] <= 1'b1/dirty[known_at] <= 1'b0/"
fault pixel_cache cache_blends.v 's/pixels\[i\] == asked/pixels[i] == ~asked/' --set blend_cycles=24
fault volume_divider volume_divider.v "s/then_x = brick_index(turn_of(2'd0/then_x = brick_index(turn_of(2'd1/"
# A reset that is forgotten: what Verilator starts with zeros would not show it.
fault frame_buffer frame_buffer.v "0,/since_refresh <= 20'd0;/s//since_refresh <= since_refresh;/" --set memory=dram
if [ "$long" ]; then
    fault texture_unit texture_filter.vh 's/<< GUARD_BITS >> 1/<< GUARD_BITS >> 2/'
    fault rasterizer slice_rows.vh "s/steps_past(limit - at_0 - 64'sd1, growth)/& + 15'd1/"
    fault slice_generator slice_plane.vh "s/border_of = (/border_of = 64'd1 + (/"
    fault frame_buffer frame_buffer.v \
        's/bus_free & fill_here;/bus_free \& fill_here \& ~write_here;/; s/bus_free & ~fill_here & write_here/bus_free \& write_here/'
fi

# ---- modules that do not fit ----

# brings CODE WORDS SED: the blender of somebody else with a change
brings() {
    sed -e "$3" "$root/docs/examples/over_blender.v" >mine.v
    bad "$1" "$2" draw --rtl alpha_blender=mine.v
}
brings 2 'mine.v: module alpha_blender has no port blended_known; it must have this output, of 1 bit' \
    's/blended_known\([,; ]\)/blended_now\1/'
brings 2 'mine.v: port blended_rgba of module alpha_blender has 31 bits; this output must have 32' \
    's/output reg \[31:0\] blended_rgba/output reg [30:0] blended_rgba/; s/blended_rgba  <= result/blended_rgba  <= result[30:0]/'
brings 2 'mine.v: input coffee of module alpha_blender is neither a port of this block nor a register' \
    's/input             rst,/input             rst, coffee,/'
brings 2 'mine.v: register dim_x is 20, which the 3 bits of module alpha_blender cannot hold' \
    's/input             rst,/input             rst, input [2:0] dim_x,/'
brings 2 'Circular combinational logic' 's/wire waits = takes/wire waits = (waits \& rst) | takes/'
brings 2 'alpha_blender' 's/^module alpha_blender/module beta_blender/'
brings 2 'syntax error' 's/^module/modul/'
bad 2 'none.v: cannot be read' draw --rtl alpha_blender=none.v
bad 2 'brick_setup_cycles=1: volume_divider in Verilog takes' draw --rtl all --set brick_setup_cycles=1
for words in '' blender all,pixel_cache pixel_cache,pixel_cache pixel_cache= 'alpha_blender,'; do
    bad 2 '--rtl' draw --rtl "$words"
done
bad 2 '--compare' draw --rtl all --compare nothing
bad 2 '--compare' draw --compare cycles

# ---- a slice generator that never ends its first slice, and one that is slower by design ----
mkdir hangs slow
sed -e "s/setup_left - 16'd1;/setup_left;/" "$root/rtl/slice_generator.v" >hangs/slice_generator.v
sed -e "s/<= slice_setup_cycles;/<= slice_setup_cycles + 16'd5;/" "$root/rtl/slice_generator.v" >slow/slice_generator.v
bad 1 'volume_divider offers on link brick since cycle' draw --rtl slice_generator=hangs/slice_generator.v --compare transactions
good 'a slower block' draw --rtl slice_generator=slow/slice_generator.v --compare transactions --raw slow.rgba
same 'a slower block draws the same bytes' c.rgba slow.rgba
verdict 'a slower block differs in cycles' "$(draw --rtl slice_generator=slow/slice_generator.v 2>&1 | grep -q differs || echo 'it does not')"

end_checks
