#!/bin/sh
# synth.sh - scripts/synth --check: a block that grew is found, one that did not is not, and what it is asked is checked.
#   tests/synth.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"
mkdir -p ../build
ln -s "$(dirname "$vodr")/gen" ../build/gen
cp -r "$root/rtl" ../rtl
sed 's/^endmodule/(* keep *) reg [63:0] extra; always @(posedge clk) extra <= {extra[62:0], rst};\nendmodule/' \
    "$root/rtl/alpha_blender.v" >../grown.v
echo 'module alpha_blender(' >../broken.v
row=$(grep '^alpha_blender |' "$root/rtl/synthesis.txt")

# says CODE WORDS RTL TABLE ARGUMENT...: scripts/synth ends so and says so on its last line
says() {
    want=$1
    words=$2
    cp "$3" ../rtl/alpha_blender.v
    table=$4
    shift 4
    VODR_RTL=$(cd ../rtl && pwd) VODR_SYNTHESIS=$table "$root/scripts/synth" "$@" >../said 2>&1
    code=$?
    problem=
    [ $code -eq "$want" ] || problem="exit code $code, not $want"
    tail -n 1 ../said | grep -qF -e "$words" || problem="$problem, it does not say '$words': $(cat ../said)"
    verdict "$words" "$problem"
}

as_is=$root/rtl/alpha_blender.v
build=$(cd .. && pwd)/build
head -n 3 "$root/rtl/synthesis.txt" >../empty.txt
sed '2s/Yosys [0-9.]*/Yosys 0.1/' "$root/rtl/synthesis.txt" >../other.txt
# A hundredth less than there is: growth that is let through.
awk -F' [|] ' -v OFS=' | ' '{ if ($1 == "alpha_blender") $2 = int($2 / 1.01); print }' "$root/rtl/synthesis.txt" >../less.txt
cells=$(echo "$row" | cut -d'|' -f 3 | tr -d ' ')

says 0 'nothing has grown' "$as_is" "$root/rtl/synthesis.txt" --check "$build" alpha_blender
says 0 'nothing has grown' "$as_is" "$(pwd)/../less.txt" --check "$build" alpha_blender
says 1 "alpha_blender has grown from $cells flip-flops to $((cells + 64)), over 2 %" ../grown.v "$root/rtl/synthesis.txt" \
    --check "$build" alpha_blender
says 1 'alpha_blender has no row in' "$as_is" "$(pwd)/../empty.txt" --check "$build" alpha_blender
says 1 'a block cannot be synthesised' ../broken.v "$root/rtl/synthesis.txt" --check "$build" alpha_blender
says 3 'its figures cannot be compared' "$as_is" "$(pwd)/../other.txt" --check "$build" alpha_blender
says 2 'cannot be read' "$as_is" /nowhere/synthesis.txt --check "$build" alpha_blender
says 2 "there is no row 'blender'; there are: volume_divider, " "$as_is" "$root/rtl/synthesis.txt" --check "$build" blender
says 2 'usage: scripts/synth' "$as_is" "$root/rtl/synthesis.txt" --check
says 2 '/nowhere/gen/vodr_hw.vh is not there' "$as_is" "$root/rtl/synthesis.txt" /nowhere
end_checks
