#!/bin/sh
# vectors.sh - the vectors that are kept are what is generated, byte by byte; the blocks in Verilog replay them under
# Icarus Verilog; and what is wrong with vectors is found and told.
#   tests/vectors.sh VODR [HEADERS]    a line a check, then "N passed, N failed"; exit 1 when any failed
# Without HEADERS, the folder of vodr_hw.vh, nothing is replayed, and level 2 is left out.
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
headers=
[ $# -lt 2 ] || headers=$(cd "$2" && pwd) || exit 2
begin_checks "$0" "$1"
kept=$root/vectors

# ---- what is kept ----

# shellcheck disable=SC2086 # a block and its options
while read -r file what; do
    "$vodr" vectors generate $what >../generated 2>../err
    same "generated: $file" "$kept/$file" ../generated
    good "checked: $file" "$vodr" vectors check "${what%% *}" <"$kept/$file"
done <<END
$(grep -v '^#' "$kept/list.txt")
END
equal 'SHA256SUMS' "$(cd "$kept" && sha256sum --quiet -c SHA256SUMS 2>&1)" ''
equal 'SHA256SUMS names every file' "$(sed 's/.*  //' "$kept/SHA256SUMS" | sort)" \
    "$(cd "$kept" && find . -name 'level*.txt' -o -name frames.txt | sed 's|^\./||' | sort)"

# ---- under Icarus Verilog ----

replays() { # VECTORS [FILE.v]...
    "$root/scripts/vectors-bench" "$headers" ../bench "$@" >../out 2>../err
}

# fails NAME WORDS VECTORS [FILE.v]...: it says WORDS, and FAIL
fails() {
    name=$1
    words=$2
    shift 2
    replays "$@"
    code=$?
    problem=
    [ $code -eq 1 ] || problem="exit code $code, not 1"
    grep -qF -e "$words" ../out || problem="$problem, it does not say '$words': $(tail -n 3 ../out)"
    verdict "replayed: $name" "$problem"
}

blender=$kept/alpha_blender/level1.txt
if [ -z "$headers" ]; then
    :
elif command -v iverilog >/dev/null; then
    for file in "$kept"/*/level*.txt; do
        replays "$file"
        verdict "replayed: ${file#"$kept/"}" "$([ "$(tail -n 1 ../out)" = PASS ] || tail -n 3 ../out ../err)"
    done
    sed 's/\[c\*FB_BITS +: FB_BITS\] + scale/[c*FB_BITS +: FB_BITS] - scale/' "$root/rtl/alpha_blender.v" >faulty.v
    cmp -s faulty.v "$root/rtl/alpha_blender.v" && verdict 'a fault was planted' 'there is none'
    fails 'a fault in the Verilog' 'blended_rgba is' "$blender" faulty.v
    head -n 3000 "$blender" >short.txt
    fails 'no last line' 'the last line is missing' short.txt
    sed 'N;$!P;$!D;$s/.*\n//' "$blender" >short.txt # but its last cycle
    fails 'a cycle is missing' 'cycles are missing' short.txt
    sed '100s/ [^ ]*$//' "$blender" >short.txt
    fails 'a column is missing' 'line 10' short.txt
    sed '/^module/,/^endmodule/s/blended_valid *=.*;/blended_valid = 1'"'"'bx;/' "$root/rtl/alpha_blender.v" >faulty.v
    fails 'an output is unknown' 'blended_valid is x' "$blender" faulty.v
    rm -f faulty.v short.txt
else
    echo 'skip replay under Icarus Verilog: iverilog is not installed'
fi

# ---- what is wrong with vectors ----

# checked CODE WORDS [BLOCK]: what stands in the file `bad`
checked() {
    # shellcheck disable=SC2094 # it is read alone
    bad "$1" "$2" "$vodr" vectors check "${3:-alpha_blender}" <bad
}

sed -n '1,/^0 .* | .* 1 [01] [0-9a-f]\{8\} /p' "$blender" >some
row=$(wc -l <some)
cycles=$(grep -c '^[01] ' some)
echo "end $cycles" >>some
good 'some lines' "$vodr" vectors check alpha_blender <some
edited() { # SED CODE WORDS [BLOCK]
    sed "$1" some >bad
    shift
    checked "$@"
}
edited '1s/vodr-vectors 1/vodr-vectors 2/' 2 'line 1: the version must be 1'
edited '1s/vodr-vectors/vectors/' 2 "line 1: vectors begin with 'vodr-vectors 1"
edited '1s/block=alpha_blender/block=blender/' 2 "line 1: block= must be followed by a block's name, not 'blender'"
edited '1s/level=1/level=/' 2 'line 1: level=1|2 seed=NUMBER must follow'
edited '1s/machine=/machine=ways=3,/' 2 'line 1: '
edited '1s/blended_rgba:32/blended_rgba:31/' 2 'by this case'"'"'s machine the header must have'
edited '' 2 'line 1: these are vectors of alpha_blender, not of rasterizer' rasterizer
edited '2s/case/box/' 2 "line 2: a line 'case ...'"
edited '3d' 2 "line 3: a line 'machine ...' must stand here"
edited '3s/$/ colour=red/' 2 "line 3: the machine has no parameter 'colour'"
edited '4s/height_px=[0-9]*/height_px=-4/' 2 'line 4: '
edited '4s/height_px/width_px/' 2 'line 4: height_px=NUMBER must stand here'
edited '5s/volume.*/volume 4x4/' 2 'line 5: the volume must be WxHxD'
edited '6s/registers.*/registers 3/' 2 'line 6: register blend must be'
edited '6s/registers.*/registers 11/' 2 'line 6: register blend must be'
edited '7s/^1/0/' 2 'line 7: rst must be 1'
edited "${row}s/ [^ ]*\$//" 2 "line $row: the line ends before column report_idle"
edited "${row}s/\$/ 0/" 2 "line $row: the line goes on"
edited "${row}s/ |//" 2 "line $row: a bar must stand"
edited "${row}s/ [^ ]*\$/ g/" 2 "line $row: column report_idle is 'g', not 1 digits of a number of 1 bit"
edited "${row}s/ [^ ]*\$/ 2/" 2 "line $row: column report_idle is '2'"
edited "${row}s/ [^ ]*\$/ 00/" 2 "line $row: column report_idle is '00'"
edited '8s/ 0 x |/ 1 00000000 |/' 2 'line 8: pixel_valid is 1, but no fragment waits for its pixel'
# shellcheck disable=SC2016 # sed's last line
edited '$d' 2 "the last line, 'end NUMBER', is missing"
# shellcheck disable=SC2016
edited '$s/.*/end 1/' 2 "it ends after $cycles cycles, but says 1"
# shellcheck disable=SC2016
edited '$s/.*/end/' 2 "the last line must be 'end NUMBER'"
sed '$p' some >bad
checked 2 'something follows the last line'
: >bad
checked 2 'line 1: there are no vectors'
printf 'vodr-vectors' >bad
checked 2 "vectors begin with"
head -c 100000 /dev/zero >bad
checked 2 'line 1: vectors begin with'
edited "${row}s/\(.*\) \([0-9a-f]\{8\}\) \([^ ]*\) \([^ ]*\)\$/\1 x \3 \4/" 1 "line $row: column blended_rgba: expected"
edited "${row}s/ 0\$/ 1/; ${row}t; ${row}s/ 1\$/ 0/" 1 "line $row: column report_idle: expected"
rm -f some bad

# A device that answers nothing it should know, and one that leaves the rest as it is.
"$vodr" vectors generate alpha_blender | sed 's/^\([01] .*|\).*/\1 x x x x x x x/' >../device
bad 1 'line 7: column blended_known: expected 0, got x' "$vodr" vectors check alpha_blender <../device
"$vodr" vectors generate rasterizer --seed 9 >../device
good 'another seed' "$vodr" vectors check rasterizer <../device
verdict 'another seed is other vectors' "$(cmp -s ../device "$kept/rasterizer/level1.txt" && echo 'they are the same')"
for block in ${headers:+$(sed '/^#/d; s|/.*||' "$kept/list.txt" | sort -u)}; do
    lines=$("$vodr" vectors generate "$block" --level 2 --seed 5 | grep -c '^0 ')
    verdict "level 2 of $block" "$([ "$lines" -ge 1000000 ] || echo "$lines cycles")"
done

# ---- the command ----

bad 2 "vectors 'make': must be generate or check" "$vodr" vectors make alpha_blender
bad 2 "vectors generate 'blender': must be volume_divider, " "$vodr" vectors generate blender
bad 2 "needs" "$vodr" vectors generate
bad 2 "--level '3': must be 1 or 2" "$vodr" vectors generate rasterizer --level 3
bad 2 "--seed '-1': must be 0 to" "$vodr" vectors generate rasterizer --seed -1
bad 2 "--set 'ways': must be PARAM=VALUE" "$vodr" vectors generate rasterizer --set ways
bad 2 "--set 'ways=3': " "$vodr" vectors generate rasterizer --set ways=3
bad 2 'vectors check takes no options' "$vodr" vectors check rasterizer --level 2 </dev/null

end_checks
