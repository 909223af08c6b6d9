#!/bin/sh
# prove.sh - scripts/prove: a property that the Verilog breaks is found, a broken variant that nothing breaks, a cover that is
# not reached, and what it is asked is checked.
#   tests/prove.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"
mkdir -p ../build ../rtl ../scripts
ln -s "$(dirname "$vodr")/gen" ../build/gen
cp "$root"/scripts/prove "$root"/scripts/prove-one ../scripts
cp "$root"/rtl/*.v "$root"/rtl/*.vh ../rtl
build=$(cd .. && pwd)/build
as_is=s/nothing/nothing/

# says CODE WORDS PROPERTY_EDIT RTL_EDIT ARGUMENT...: of a copy of the repository, with cache_touched and its properties edited,
# scripts/prove ends so and says so
says() {
    want=$1
    words=$2
    rm -rf ../rtl/formal
    cp -r "$root/rtl/formal" ../rtl
    sed -i -E "$3" ../rtl/formal/cache_touched.vh
    sed -E "$4" "$root/rtl/cache_touched.v" >../rtl/cache_touched.v
    shift 4
    ../scripts/prove "$@" >../said 2>&1
    code=$?
    problem=
    [ $code -eq "$want" ] || problem="exit code $code, not $want"
    grep -qF -e "$words" ../said || problem="$problem, it does not say '$words': $(cat ../said)"
    verdict "$words" "$problem"
}

row=$(sed -n 's/^\(cache_touched[^|]*\) |.*/\1/p' "$root/rtl/formal/proofs.txt" | head -n 1)
says 0 '1 passed, 0 failed' "$as_is" "$as_is" "$build" "$row"
same 'the row is what it was' "$root/rtl/formal/proofs.txt" ../rtl/formal/proofs.txt
says 1 'not true: Assert failed' "$as_is" 's/used <= 0/used <= used/' "$build" "$row"
says 1 'not inductive in 1 steps' 's/ == .used.formal_word.*/ == formal_missed);/' "$as_is" "$build" "$row"
says 1 'Unreached cover statement' 's/cover .!rst \&\& first/cover (rst \&\& first \&\& !clear_on_first_touch/' "$as_is" "$build" "$row"
says 1 'it holds when cache_touched.v is broken by' 's/breaks 5 .*/breaks 5 cache_touched.v s|endmodule|endmodule  |/' "$as_is" "$build" "$row"
says 1 'changes nothing in cache_touched.v' 's/breaks 5 .*/breaks 5 cache_touched.v s|nowhere|there|/' "$as_is" "$build" "$row"
says 1 'it has no broken variant' 's/^.*breaks 5.*$//' "$as_is" "$build" "$row"
says 1 'it asserts nothing' '/assert/d' "$as_is" "$build" "$row"
says 1 'Yosys cannot read it' "$as_is" 's/else if/els if/' "$build" "$row"
says 1 'make prove' 's/^.*at FRAME_LINES=4 .*$/\/\/: at FRAME_LINES=8 NUMBER_BITS=6/' "$as_is" --quick "$build"
says 2 "there is no proof 'touched'; there are: " "$as_is" "$as_is" "$build" touched
says 2 'usage: scripts/prove' "$as_is" "$as_is" --quick
says 2 '/nowhere/gen/vodr_hw.vh is not there' "$as_is" "$as_is" /nowhere
end_checks
