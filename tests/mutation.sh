#!/bin/sh
# mutation.sh - scripts/mutation --slice: mutants of a block are killed, and vectors that show too little let some live.
#   tests/mutation.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"
build=$(dirname "$vodr")

# says CODE WORDS: the last run ended so and says so on its last line
says() { # CODE WORDS
    problem=
    [ $code -eq "$1" ] || problem="exit code $code, not $1"
    tail -n 1 ../said | grep -qF -e "$2" || problem="$problem, it does not say '$2': $(cat ../said)"
    verdict "$2" "$problem"
}

"$root/scripts/mutation" --slice "$build" >../said 2>&1
code=$?
says 0 'alpha_blender-level1-nonblocking-slice | 67 |'
equal 'the mutants of three machines' "$(awk -F' [|] ' '$1 ~ /-slice$/ { sum += $2 } END { print sum }' ../said)" 201
expect 'a strobe that does not come is seen' 'const0 .*-wire blended_known .* | vectors | line [0-9]*, blended_valid$' "$build/mutation/alpha_blender-level1-nonblocking-slice/verdicts"

# What is planted is judged elsewhere: what was judged stays.
mkdir ../build
ln -s "$build/gen" "$build/tests" ../build

# Vectors of one case, and nothing beside them: most of what is to be seen is not shown.
cp -r "$root/vectors" ../vectors
awk '/^case / && cases++ { exit } { print } /^[01] / { cycles++ } END { print "end " cycles }' "$root/vectors/alpha_blender/level1.txt" \
    >../vectors/alpha_blender/level1.txt
VODR_VECTORS=$(cd .. && pwd)/vectors VODR_TRANSACTIONS=0 "$root/scripts/mutation" --slice "$(cd .. && pwd)/build" alpha_blender-level1 >../said 2>&1
code=$?
says 1 'mutants survive: vectors/BLOCK.c has to show what they do'

# The bench fails when the last line is missing, whatever the module does.
sed '$d' "$root/vectors/alpha_blender/level1.txt" >../vectors/alpha_blender/level1.txt
VODR_VECTORS=$(cd .. && pwd)/vectors "$root/scripts/mutation" --slice "$(cd .. && pwd)/build" alpha_blender-level1 >../said 2>&1
code=$?
says 1 'cannot be run'

"$root/scripts/mutation" "$build" no_block-level1 >../said 2>&1
code=$?
says 2 'there are no vectors of that name'
"$root/scripts/mutation" /nowhere >../said 2>&1
code=$?
says 2 '/nowhere/tests/mutation/mutants is not there'
end_checks
