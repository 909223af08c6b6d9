#!/bin/sh
# sweep.sh - `vodr sweep` from outside: rows that `vodr render` counts too, files that go on where they stopped, fronts,
# plots, refusals.
#   tests/sweep.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"

# The values of column $1 of file $2, a line each. Columns before the one asked for hold no comma but in quotes.
column() {
    sed '/^#/d' "$2" | awk -v name="$1" '
        {
            line = $0; n = 0
            while (line != "") {
                if (match(line, /^"([^"]|"")*"/)) { value = substr(line, 2, RLENGTH - 2); line = substr(line, RLENGTH + 1) }
                else { match(line, /^[^,]*/); value = substr(line, 1, RLENGTH); line = substr(line, RLENGTH + 1) }
                field[++n] = value
                sub(/^,/, "", line)
            }
            if (NR == 1) { for (i = 1; i <= n; i++) if (field[i] == name) at = i } else print field[at]
            for (i = 1; i <= n; i++) field[i] = ""
        }'
}

i=0
while [ $i -lt 256 ]; do
    printf '\000\020\040\100\200\300\377\177\010\030\050\110\210\310\350\170'
    i=$((i + 1))
done >v.raw # 16x16x16 voxels
head -c 512 v.raw >w.raw # 8x8x8
raw='v.raw --dims 16x16x16'
over='--over line_px=16x1,4x4 --over cache_bytes=512,1024,4096 --over view=orbit:9:10'

# ---- rows ----
# shellcheck disable=SC2086
{
    good "54 points" "$vodr" sweep $raw $over --cycles -o full.csv
    verdict "a row a point, in order" \
        "$([ "$(column point full.csv | tr '\n' ' ')" = "$(seq 0 53 | tr '\n' ' ')" ] || echo "it is not so")"
    sed -n 's/^# //p' full.csv | sed '/^objective/d' >head.json
    if command -v python3 >/dev/null; then
        verdict "the head is JSON" "$(python3 -m json.tool head.json 2>&1 >/dev/null)"
    fi
    expect "it names the volume's content" "$(sha256sum v.raw | cut -d' ' -f1)" head.json
    good "the same point by render" "$vodr" render $raw --set line_px=4x4 --set cache_bytes=1024 --view 80,10 --cycles \
        --stats one.json
    for name in fragments hits misses evictions fb_read_bytes texture_load_bytes offchip_bytes energy_pj onchip_bits \
        cache_tag_bits frame_sha256; do
        # point 38 = line_px 1, cache_bytes 1, view 2
        want=$(sed -n "s/^ *\"$name\": \"\{0,1\}\([^\",]*\).*/\1/p" one.json)
        got=$(column $name full.csv | sed -n 39p)
        verdict "$name is render's" "$([ "$want" = "$got" ] && [ -n "$got" ] || echo "'$got' is not '$want'")"
    done
    want=$(sed -n '/"cycles": {/,$s/^ *"total": \([0-9]*\).*/\1/p' one.json | head -n 1)
    verdict "cycles are render's" "$([ "$want" = "$(column cycles full.csv | sed -n 39p)" ] || echo "not $want")"
    good "--threads 1" "$vodr" sweep $raw $over --cycles -o one.csv --threads 1
    same "the same file" one.csv full.csv
    cp -p full.csv before.csv
    good "again" "$vodr" sweep $raw $over --cycles -o full.csv
    expect "nothing is drawn twice" '^points  *54, 54 of them' ../out
    verdict "the file is left alone" "$(find full.csv -newer before.csv)"
}

# ---- pipelines ----
# shellcheck disable=SC2086
{
    good "one to four pipelines" "$vodr" sweep $raw --size 64x128 --zoom 8 --over pipelines=1,2,4 --cycles -o several.csv
    good "four by render" "$vodr" render $raw --size 64x128 --zoom 8 --set pipelines=4 --cycles --stats four.json
    verdict "one frame" "$([ "$(column frame_sha256 several.csv | uniq | grep -c .)" -eq 1 ] || column frame_sha256 several.csv)"
    verdict "as much memory on the chip as there are pipelines" "$(column onchip_bits several.csv | awk '
        NR == 1 { one = $1 } $1 != one * 2 ^ (NR - 1) { print } END { if (NR != 3) print NR " rows" }')"
    verdict "ever fewer cycles" "$(column cycles several.csv | awk 'NR > 1 && $1 >= last { print } { last = $1 }')"
    want=$(sed -n '/"cycles": {/,$s/^ *"total": \([0-9]*\).*/\1/p' four.json | head -n 1)
    equal "cycles are render's" "$(column cycles several.csv | tail -n 1)" "$want"
}
# ---- filters ----
# shellcheck disable=SC2086
{
    good "every filter" "$vodr" sweep $raw --view 20,10 --over filter=nearest,linear,cardinal,bspline --over density_bits=8,12 \
        --cycles -o filters.csv
    for filter in cardinal bspline; do
        good "one by render" "$vodr" render $raw --view 20,10 --filter $filter --set density_bits=12 --cycles --stats one.json
        at=$([ $filter = cardinal ] && echo 6 || echo 8)
        equal "the frame is render's" "$(column frame_sha256 filters.csv | sed -n ${at}p)" \
            "$(sed -n 's/^ *"frame_sha256": "\([^"]*\)".*/\1/p' one.json)"
        equal "cycles are render's" "$(column cycles filters.csv | sed -n ${at}p)" \
            "$(sed -n '/"cycles": {/,$s/^ *"total": \([0-9]*\).*/\1/p' one.json | head -n 1)"
    done
    verdict "a cubic filter takes more cycles" "$(column cycles filters.csv | awk 'NR == 3 { linear = $1 } NR > 4 && $1 < 4 * linear { print }')"
}
head -c 512 v.raw >x.raw
printf 'volume   view   slices  # not a comment here\n' >bad.list
printf '# points\nview line_px tf\n0,0 16x1 ramp\n\n30,-20.5\t4x4   bone\n' >points.list
# shellcheck disable=SC2086
{
    good "volumes, transfer functions, machines, densities, windows, crops" "$vodr" sweep w.raw x.raw --dims 8x8x8 \
        --over tf=ramp,bone --over machine=paper-16,paper-general --over density_bits=8,12 --over window=0:255,0:100 \
        --over 'crop=0:8,0:8,0:8;2:5,0:8,1:2' --over size=8x8,5x9 --over blend=over,mip -o all.csv
    good "one of them by render" "$vodr" render x.raw --dims 8x8x8 --tf bone --machine paper-general \
        --set density_bits=12 --window 0:100 --crop 2:5,0:8,1:2 --size 5x9 --blend mip --stats last.json
    sha=$(sed -n 's/.*"frame_sha256": "\([^"]*\)".*/\1/p' last.json)
    verdict "the last row has its frame" "$([ "$(column frame_sha256 all.csv | tail -n 1)" = "$sha" ] || echo "another")"
    good "a list and an axis" "$vodr" sweep $raw --list points.list --over ways=1,2 -o list.csv
    verdict "4 rows" "$([ "$(column tf list.csv | tr '\n' ' ')" = "ramp ramp bone bone " ] || echo "not so")"
    good "what the machine refuses is a row" "$vodr" sweep $raw --over ways=4,1024 --over cache_bytes=4096,64 -o no.csv
    expect "its column says why" ',"cache_bytes=64 is not a multiple of a set' no.csv
    verdict "3 of 4 are refused" "$([ "$(column refused no.csv | grep -c .)" -eq 3 ] || column refused no.csv)"
    good "again" "$vodr" sweep $raw --over ways=4,1024 --over cache_bytes=4096,64 -o no.csv
    expect "they are not tried again" '^points  *4, 4 of them' ../out
}

# ---- killed ----
interrupt() { # COMMAND...: killed after a while, which differs from call to call
    ("$@" >/dev/null 2>&1 & sleep "0.0$((1 + kills % 9))"; kill -KILL $! 2>/dev/null; wait $! 2>/dev/null)
    kills=$((kills + 1))
}
long='--over line_px=16x1,4x4 --over cache_bytes=512,1024,4096 --over view=orbit:60 --over ways=1,4'
kills=0
# shellcheck disable=SC2086
{
    good "720 points" "$vodr" sweep $raw $long -o long.csv
    broken=0
    while [ $kills -lt 12 ]; do
        [ $((kills % 4)) -ne 0 ] || rm -f killed.csv
        interrupt "$vodr" sweep $raw $long -o killed.csv 2>/dev/null
        rows=$(sed '/^#/d' killed.csv 2>/dev/null | wc -l)
        [ "$rows" -gt 1 ] && [ "$rows" -lt 721 ] && broken=$((broken + 1))
        if [ $((kills % 4)) -eq 0 ]; then
            good "killed 4 times, goes on" "$vodr" sweep $raw $long -o killed.csv
            same "as if never stopped" killed.csv long.csv
        fi
    done
    echo "     $broken of $kills kills came while rows were written"
    head -c $(($(wc -c <long.csv) - 700)) long.csv >cut.csv
    good "a row cut off in its middle" "$vodr" sweep $raw $long -o cut.csv
    same "is drawn again" cut.csv long.csv
    head -c 300 long.csv >cut.csv
    good "a head cut off in its middle" "$vodr" sweep $raw $long -o cut.csv
    same "is written again" cut.csv long.csv
    for n in 1 2 3; do "$vodr" sweep $raw $long -o shared.csv --threads 2 >../shared-$n 2>&1 & done
    wait
    same "three sweeps on one file" shared.csv long.csv
    if command -v mpirun >/dev/null; then
        good "mpirun" env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
            mpirun --oversubscribe -n 3 "$vodr" sweep $raw $long -o ranks.csv
        same "three ranks on one file" ranks.csv long.csv
        verdict "one rank speaks" "$([ "$(grep -c '^written' ../out)" -eq 1 ] || cat ../out)"
    else
        echo 'skip mpirun is not installed'
    fi
}

# ---- fronts and plots ----
# shellcheck disable=SC2086
{
    good "--objective on a finished file" "$vodr" sweep $raw $over --cycles -o full.csv --objective cycles,onchip_bits
    expect "draws nothing" '54 of them there before' ../out
    column cycles full.csv >../a && column onchip_bits full.csv >../b
    paste -d' ' ../a ../b | awk '
        { x[NR] = $1; y[NR] = $2 }
        END {
            for (i = 1; i <= NR; i++) {
                beaten = 0
                for (j = 1; j <= NR; j++)
                    if (x[j] <= x[i] && y[j] <= y[i] && (x[j] < x[i] || y[j] < y[i])) beaten = 1
                print 1 - beaten
            }
        }' >../want
    column pareto full.csv >../got
    same "pareto is 1 where no other is better" ../got ../want
    good "another objective" "$vodr" sweep $raw $over --cycles -o full.csv --objective hit_rate:max
    best=$(column hit_rate full.csv | sort -g | tail -n 1)
    column hit_rate full.csv | awk -v best="$best" '{ print ($1 == best) ? 1 : 0 }' >../want
    column pareto full.csv >../got
    same "the largest hit rate" ../got ../want
    if command -v gnuplot >/dev/null; then
        for type in line bar heat pareto; do
            good "--plot-type $type" "$vodr" sweep $raw $over --cycles -o full.csv --objective cycles,onchip_bits --plot $type.svg \
                --plot-type $type
            expect "it is SVG, with its unit" '(.*\(bits\|cycles\|bytes\))' $type.svg
        done
        good "without a type" "$vodr" sweep $raw --over view=orbit:5 -o few.csv --plot few.svg
        bad 3 "no/p.svg" "$vodr" sweep $raw --over view=orbit:5 -o few.csv --plot no/p.svg
    else
        echo 'skip gnuplot is not installed'
    fi
    bad 3 "gnuplot-nox" env PATH=/nowhere "$vodr" sweep $raw --over ways=1,2 -o no-plot.csv --plot no.svg
}

# ---- refused ----
# shellcheck disable=SC2086
{
    bad 2 "needs VOLUME" "$vodr" sweep --over ways=1,2 -o new.csv
    bad 2 "--output" "$vodr" sweep $raw --over ways=1,2
    bad 2 "something that varies" "$vodr" sweep $raw -o new.csv
    bad 2 "'colour' cannot vary" "$vodr" sweep $raw --over colour=1,2 -o new.csv
    bad 2 "'threads' cannot vary" "$vodr" sweep $raw --over threads=1,2 -o new.csv
    bad 2 "must be PARAM=V1" "$vodr" sweep $raw --over ways -o new.csv
    bad 2 "a value is empty" "$vodr" sweep $raw --over ways= -o new.csv
    bad 2 "a value is empty" "$vodr" sweep $raw --over ways=1,,2 -o new.csv
    bad 2 "ways is '3'" "$vodr" sweep $raw --over ways=1,3 -o new.csv
    bad 2 "'1' is there twice" "$vodr" sweep $raw --over ways=1,1 -o new.csv
    bad 2 "'ways' is an axis already" "$vodr" sweep $raw --over ways=1,2 --over ways=4 -o new.csv
    bad 2 "--view '0,95'" "$vodr" sweep $raw --over 'view=0,0;0,95' -o new.csv
    bad 2 "orbit:0" "$vodr" sweep $raw --over view=orbit:0 -o new.csv
    bad 2 "orbit:4:91" "$vodr" sweep $raw --over view=orbit:4:91 -o new.csv
    bad 2 "'paper-48'" "$vodr" sweep $raw --over machine=paper-16,paper-48 -o new.csv
    bad 2 "'unknown'" "$vodr" sweep $raw --over tf=ramp,unknown -o new.csv
    bad 2 "none.raw" "$vodr" sweep $raw none.raw -o new.csv
    bad 2 "none.raw" "$vodr" sweep --dims 8x8x8 --over volume=w.raw,none.raw -o new.csv
    bad 2 "given twice" "$vodr" sweep $raw --over volume=w.raw -o new.csv
    bad 2 "more than 100000000 points" "$vodr" sweep $raw --over view=orbit:3600 --over zoom=1,2 --over ways=1,2,4,8 \
        --over mem_latency_cycles="$(seq -s, 1 5000)" -o new.csv
    bad 2 "no column 'speed'" "$vodr" sweep $raw --over ways=1,2 -o new.csv --objective speed
    bad 2 "no column 'cycles'" "$vodr" sweep $raw --over ways=1,2 -o new.csv --objective cycles
    bad 2 "are no numbers" "$vodr" sweep $raw --over ways=1,2 -o new.csv --objective frame_sha256
    bad 2 "COLUMN:max" "$vodr" sweep $raw --over ways=1,2 -o new.csv --objective misses:least
    bad 2 "--plot-type needs" "$vodr" sweep $raw --over ways=1,2 -o new.csv --plot-type bar
    bad 2 "--plot-type 'pie'" "$vodr" sweep $raw --over ways=1,2 -o new.csv --plot p.svg --plot-type pie
    bad 2 "needs two columns" "$vodr" sweep $raw --over ways=1,2 -o new.csv --plot p.svg --plot-type pareto
    bad 2 "bad.list:1: '#' cannot vary" "$vodr" sweep --list bad.list -o new.csv
    printf 'ways line_px\n1\n' >bad.list
    bad 2 "1 values for 2 names" "$vodr" sweep $raw --list bad.list -o new.csv
    bad 2 "'long.csv' is there and is not of this sweep" "$vodr" sweep $raw --over ways=1,2 -o long.csv
    echo 'my notes' >notes.txt
    bad 2 "'notes.txt' is there and is not of this sweep" "$vodr" sweep $raw --over ways=1,2 -o notes.txt
    head -c 4096 /dev/zero >zeros.bin
    bad 2 "'zeros.bin' is there and is not of this sweep" "$vodr" sweep $raw --over ways=1,2 -o zeros.bin
    printf '# {\n' >head.txt
    good "the beginning of a head is gone over" "$vodr" sweep $raw --over ways=1,2 -o head.txt
    sed '$s/^/x/' long.csv >damaged.csv
    bad 2 "there is no row of it" "$vodr" sweep $raw $long -o damaged.csv
    bad 2 "'v.raw' is read by this command" "$vodr" sweep $raw --over ways=1,2 -o v.raw
    cp v.raw z.raw && "$vodr" sweep z.raw --dims 16x16x16 --over ways=1,2 -o z.csv >/dev/null
    printf 'x' | dd of=z.raw conv=notrunc 2>/dev/null
    bad 2 "'z.csv' is there and is not of this sweep" "$vodr" sweep z.raw --dims 16x16x16 --over ways=1,2 -o z.csv
    printf 'add | -1\n' >bad.energy
    bad 2 "bad.energy:1: add is '-1'" "$vodr" sweep $raw --over ways=1,2 -o new.csv --energy bad.energy
    printf 'pixel_cache WAYS=16 | 7 | 8\n' >rows.txt
    "$vodr" sweep $raw --over ways=4,16,32 --cells rows.txt -o rows.csv >/dev/null
    verdict "cells of machines that have rows" "$([ "$(column cells rows.csv | sed 's/[0-9][0-9]*/n/' | paste -sd,)" = n,n, ] || column cells rows.csv | paste -sd,)"
    printf 'pixel_cache WAYS=16 | 9 | 8\n' >rows.txt
    bad 2 "'rows.csv' is there and is not of this sweep" "$vodr" sweep $raw --over ways=4,16,32 --cells rows.txt -o rows.csv
    bad 3 "no/x.csv" "$vodr" sweep $raw --over ways=1,2 -o no/x.csv
    bad 3 "regular file" "$vodr" sweep $raw --over ways=1,2 -o /dev/full
    # A limit on the size of files stands in for a full disk: what was written is whole, and the sweep goes on later.
    (ulimit -f 16 && exec "$vodr" sweep $raw $long -o full-disk.csv) >../out 2>../err
    code=$?
    verdict "disk full: exit code 3" "$([ $code -eq 3 ] || echo "$code")"
    verdict "disk full: one sentence" "$([ "$(wc -l <../err)" -eq 1 ] || cat ../err)"
    verdict "disk full: the rows are whole" "$([ -z "$(tail -c 1 full-disk.csv | tr -d '\n')" ] || echo "they are not")"
    good "room again" "$vodr" sweep $raw $long -o full-disk.csv
    same "the same in the end" full-disk.csv long.csv
}

end_checks
