#!/bin/sh
# cli.sh - the vodr command from outside: exit codes, one sentence on standard error, no partial output.
#   tests/cli.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"

i=0
while [ $i -lt 64 ]; do
    printf '\000\020\040\100\200\300\377\177\010\030\050\110\210\310\350\170'
    i=$((i + 1))
done >v.raw # 16x8x8 voxels
raw="v.raw --dims 16x8x8"

# ---- help and version ----
good "vodr --help" "$vodr" --help
for command in render reference cluster compare machine info sweep vectors; do
    expect "vodr --help names $command" "^  $command " ../out
done
good "vodr --version" "$vodr" --version
expect "vodr --version" '^vodr [0-9]' ../out
for command in reference cluster compare machine info sweep vectors; do
    good "vodr $command --help" "$vodr" $command --help
    expect "vodr $command --help has an example" '^Example' ../out
done
good "vodr render --help" "$vodr" render --help
for option in output machine set tf window view projection zoom size slices crop blend filter traversal threads path cycles repeat \
    stats raw registers background alpha no-orient dims type spacing endian; do
    expect "vodr render --help explains --$option" "--$option" ../out
done

# ---- what works ----
# shellcheck disable=SC2086
{
    good "render with nothing to write" "$vodr" render $raw
    expect "the summary counts 1024 fragments" 'fragments  *1,024' ../out
    good "render, all outputs" "$vodr" render $raw -o a.png --raw a.rgba --stats a.json --registers r.json
    expect "stats: schema" '"schema": "vodr-stats-1"' a.json
    expect "stats: fragments" '"fragments": 1024' a.json
    for name in cycles stalls bottleneck; do
        expect "stats: no $name without --cycles" "\"$name\": null" a.json
    done
    verdict "stats: frame_sha256 is of --raw" \
        "$(grep -q "$(sha256sum a.rgba | cut -d' ' -f1)" a.json || echo "it is not")"
    verdict "raw: 16x8 pixels of 4 bytes" "$([ "$(wc -c <a.rgba)" -eq 512 ] || wc -c a.rgba)"
    sed -n 's/^\([a-z_]*\) *|.*/\1/p' "$root/hw/registers.txt" >../registers
    while read -r register; do
        expect "registers: $register" "\"$register\": -\{0,1\}[0-9]" r.json
    done <../registers
    good "values after =" "$vodr" render $raw --output=b.png --view=-30,20 --raw=b.rgba
    good "values that begin with -" "$vodr" render $raw -o c.png --view -30,20 --raw c.rgba
    same "both are one" b.rgba c.rgba
    good "the same, divided otherwise" "$vodr" render $raw --view -30,20 --raw d.rgba --traversal tile --set brick=3 \
        --threads 1 --machine paper-general --set=ways=1
    same "division changes nothing" b.rgba d.rgba
    good "16 bits" "$vodr" render $raw --set fb_bits=16 --set tf_bits=16 --raw e.rgba -o e.png --alpha
    verdict "raw: 16x8 pixels of 8 bytes" "$([ "$(wc -c <e.rgba)" -eq 1024 ] || wc -c e.rgba)"
    good "perspective, mip, background" "$vodr" render $raw --projection perspective:60 --blend mip -o f.png \
        --background ff8000 --size 20x10 --slices 9 --zoom 1.5 --window 0:200 --tf bone --crop 0:8,0:8,0:8
    good "--energy" "$vodr" render $raw --stats energy.json
    printf 'dram_byte | 0\n' >free.txt
    good "--energy" "$vodr" render $raw --stats free.json --energy free.txt
    expect "stats: costs" '"offchip_pj": [1-9]' energy.json
    expect "stats: costs by another table" '"offchip_pj": 0,' free.json
    expect "stats: cells" '"cells": [1-9]' energy.json
    good "no row of synthesis" "$vodr" render $raw --stats rowless.json --set ways=16
    expect "stats: cells are not known" '"cells": null,' rowless.json
    printf 'pixel_cache WAYS=16 | 7 | 8\n' >rows.txt
    good "--cells" "$vodr" render $raw --stats rows.json --set ways=16 --cells rows.txt
    expect "stats: cells by a further row" '"cells": [1-9]' rows.json
    good "--repeat" "$vodr" render $raw --repeat 3 --stats g.json
    good "options may end with --" "$vodr" render --dims 16x8x8 -- v.raw
    good "outputs to devices" "$vodr" render $raw -o /dev/null --raw /dev/null
    good "stats to standard output" "$vodr" render $raw --stats /dev/stdout
    expect "nothing but JSON there" '^{$' ../out
    verdict "it is JSON from its first line on" "$([ "$(head -n 1 ../out)" = "{" ] || head -n 1 ../out)"
    good "machine show" "$vodr" machine show paper-16
    cp ../out mine.txt
    good "machine show gives a machine file" "$vodr" render $raw --machine mine.txt --raw h.rgba
    same "that draws the same" a.rgba h.rgba
    printf '0 1 0 0 0\n255 1 1 1 0.5 \n' >tf.txt
    good "a transfer-function file" "$vodr" render $raw --tf tf.txt
}

# ---- cycles ----
# The lines of a statistics file from `"NAME": {` to the brace that closes it.
object() { # NAME FILE
    sed -n "/^  \"$1\": {/,/^  }/p" "$2"
}
# Blocks whose busy, stalled and idle cycles do not add up to the total.
unbalanced() { # FILE
    object cycles "$1" | tr -d '",:' | awk '
        $1 == "total" { total = $2 }
        $2 == "{" { name = $1; sum = 0 }
        $1 == "busy" || $1 == "stalled" || $1 == "idle" { sum += $2; left[name] = sum }
        END {
            for (name in left) if (name != "cycles") { blocks++; if (left[name] != total) print name, left[name], total }
            if (blocks != 7 || total < 500) print blocks " blocks, total " total
        }'
}
# shellcheck disable=SC2086
for machine in 'paper-16' 'paper-16 --set nonblocking=1' 'paper-general --set memory=dram' 'paper-32 --traversal tile'; do
    how="$raw --crop 0:12,0:8,0:6 --view -30,20 --machine $machine --cycles --set brick=4"
    good "--cycles: $machine" "$vodr" render $how --stats fast.json
    expect "the summary counts cycles" '^cycles  *[0-9,]*  ([0-9.]* a fragment)$' ../out
    expect "and names the bottleneck" '^bottleneck  *[a-z]' ../out
    good "--path blocks" "$vodr" render $how --path blocks --stats blocks.json
    good "--path clocked" "$vodr" render $how --path clocked --stats clocked.json
    verdict "every block's cycles add up to the total" "$(unbalanced fast.json)"
    grep -vE '"(wall_s|fragments_per_s)":' fast.json >fast.stats
    for path in blocks clocked; do
        grep -vE '"(wall_s|fragments_per_s)":' $path.json >$path.stats
        same "$path: the same frame, counts and cycles" fast.stats $path.stats
    done
    for cause in divider slice texture_load fragment_fifo cache hazard write_back fill dram_row dram_refresh; do
        object stalls fast.json | grep -q "\"$cause\": [0-9]" || echo "$cause"
    done >missing
    verdict "every stall cause is there" "$(cat missing)"
done
# shellcheck disable=SC2086
{
    good "--path clocked without --cycles" "$vodr" render $raw --path clocked --stats clocked.json
    expect "tells none" '"cycles": null' clocked.json
    good "nothing on the screen" "$vodr" render $raw --cycles --size 2x2 --zoom 0.0001 --stats nothing.json
    expect "has a bottleneck all the same" '"bottleneck": "[a-z]' nothing.json
}
rm -f ./*.stats missing
good "machine list" "$vodr" machine list
expect "machine list has paper-32" '^paper-32 ' ../out

# ---- reference ----
# shellcheck disable=SC2086
{
    good "reference with nothing to write" "$vodr" reference $raw
    expect "the summary counts 1024 samples of those slices" 'samples  *[0-9]' ../out
    for how in '' '--blend mip --set density_bits=8 --size 9x7' '--blend under --filter nearest --projection perspective:70' \
        '--set fb_bits=16 --set tf_bits=16 --window 20:180 --slices 5 --tf bone'; do
        good "render $how" "$vodr" render $raw --view -30,20 $how --raw m.rgba
        good "reference --numbers fixed $how" "$vodr" reference $raw --view -30,20 $how --numbers fixed --raw n.rgba
        same "draws the machine's bytes" m.rgba n.rgba
    done
    for method in slices raycast; do
        good "reference --method $method, all outputs" "$vodr" reference $raw --method $method -o r.png --raw r.rgba \
            --stats r.json --repeat 2 --accel none
        expect "stats: schema" '"schema": "vodr-reference-stats-1"' r.json
        expect "stats: samples" '"samples": 1024' r.json
        expect "stats: method" "\"method\": \"$method\"" r.json
        expect "stats: wall_s" '"wall_s": [0-9]' r.json
        verdict "stats: frame_sha256 is of --raw" \
            "$(grep -q "$(sha256sum r.rgba | cut -d' ' -f1)" r.json || echo "it is not")"
        for how in '--accel block --block 2' '--accel best' '--threads 3' '--simd portable' '--accel none'; do
            good "reference --method $method $how" "$vodr" reference $raw --method $method $how --raw t.rgba
            same "draws the same bytes" r.rgba t.rgba
        done
    done
    good "reference, double and Phong" "$vodr" reference $raw --method raycast --numbers double --step 0.5 \
        --shading phong --termination 0.9 --raw t.rgba
    good "reference, texture, mip" "$vodr" reference $raw --numbers texture --blend mip --raw t.rgba
    rm -f m.rgba n.rgba r.png r.rgba r.json t.rgba
    printf '0 0 0 0 0\n255 1 0.5 0 0.4\n' >values.txt
    { echo 'gradient 0'; cat values.txt; echo 'gradient 20'; cat values.txt; } >same.txt
    { echo 'gradient 10'; sed 's/[^ ]*$/0/' values.txt; echo 'gradient 40'; cat values.txt; } >edges.txt
    for how in '--method raycast' '--method slices --shading phong' '--method raycast --numbers double'; do
        for tf in values same edges; do
            good "reference $how --tf $tf.txt" "$vodr" reference $raw --view 20,10 --tf $tf.txt $how --raw $tf.rgba
        done
        same "rows that are alike are a function of values" values.rgba same.rgba
        verdict "rows that are not are none" "$(! cmp -s values.rgba edges.rgba || echo "the frames are the same")"
        good "reference $how, nothing skipped" "$vodr" reference $raw --view 20,10 --tf edges.txt $how --accel none --raw t.rgba
        same "changes nothing" edges.rgba t.rgba
    done
    bad 2 "'edges.txt' is of value and gradient magnitude, the machine's tables" "$vodr" render $raw -o no.png --tf edges.txt
    bad 2 "'edges.txt' is of value and gradient magnitude, the machine's tables" "$vodr" reference $raw -o no.png --tf edges.txt --numbers fixed
    bad 2 "'edges.txt' is of value and gradient magnitude, the machine's tables" "$vodr" sweep $raw -o no.csv --over tf=edges.txt
    bad 2 "does not go with blend=mip" "$vodr" reference $raw -o no.png --tf edges.txt --blend mip
    bad 2 "--device 'gpu': must be cpu or cuda" "$vodr" reference $raw -o no.png --device gpu
    bad 2 "--method 'rays': must be slices or raycast" "$vodr" reference $raw -o no.png --method rays
    bad 2 "--numbers 'half': must be fixed, float, double or texture" "$vodr" reference $raw -o no.png --numbers half
    bad 2 "--accel 'bezier': must be none, block, bisect, seed, best, rival, hull, aligned, aligned-best or aligned-paper" "$vodr" reference $raw -o no.png \
        --accel bezier
    bad 2 "--accel hull does not go with filter=linear" "$vodr" reference $raw -o no.png --accel hull
    bad 2 "--filter 'cubic': must be nearest, linear, cardinal or bspline" "$vodr" reference $raw -o no.png --filter cubic
    bad 2 "--filter bspline does not go with --numbers texture" "$vodr" reference $raw -o no.png --filter bspline \
        --numbers texture
    for how in block 'bisect --blend mip' 'seed --blend mip'; do
        bad 2 "--accel ${how%% *} does not go with filter=cardinal" "$vodr" reference $raw -o no.png --filter cardinal \
            --accel $how
    done
    for filter in cardinal bspline; do
        good "the machine, --filter $filter" "$vodr" render $raw --filter $filter --view 20,10 --cycles --stats m.json --raw m.rgba
        expect "cycles: texture_fetch" '"texture_fetch": [1-9]' m.json
        for how in '--traversal whole' '--set density_bits=8 --set brick=3 --path blocks'; do
            good "the machine, --filter $filter $how" "$vodr" render $raw --filter $filter --view 20,10 $how --raw n.rgba
            same "draws the same bytes" m.rgba n.rgba
        done
        good "reference --numbers fixed --filter $filter" "$vodr" reference $raw --numbers fixed --filter $filter --view 20,10 --raw n.rgba
        same "draws the same bytes" m.rgba n.rgba
        good "reference --set filter=$filter" "$vodr" reference $raw --numbers fixed --set filter=$filter --view 20,10 --raw n.rgba
        same "draws the same bytes" m.rgba n.rgba
        bad 2 "filter=$filter: texture_unit in Verilog takes nearest and linear only" "$vodr" render $raw -o no.png --filter $filter --rtl all
        bad 2 "a brick of 8 voxels (brick_min) needs" "$vodr" render $raw -o no.png --filter $filter --set texture_memory_bytes=1024
        printf '\005' >one.raw
        good "a single voxel, --filter $filter" "$vodr" render one.raw --dims 1x1x1 --window 0:255 --filter $filter --size 3x3 --raw m.rgba
        good "a single voxel, --filter linear" "$vodr" render one.raw --dims 1x1x1 --window 0:255 --size 3x3 --raw n.rgba
        same "is as constant" m.rgba n.rgba
        bad 2 "draw whole volumes" "$vodr" cluster $raw -o no.png --set filter=$filter
        for blend in over mip; do
            good "reference --filter $filter --blend $blend" "$vodr" reference $raw --filter $filter --blend $blend \
                --accel none --view 30,20 --raw r.rgba --stats r.json
            expect "stats: filter" "\"filter\": \"$filter\"" r.json
            for how in rival hull best 'hull --block 2' 'best --simd portable'; do
                good "reference --filter $filter --blend $blend --accel $how" "$vodr" reference $raw --filter $filter \
                    --blend $blend --view 30,20 --accel $how --raw t.rgba
                same "draws the same bytes" r.rgba t.rgba
            done
        done
    done
    for how in aligned 'aligned --copies 1' aligned-best 'aligned-best --simd portable'; do
        good "reference --filter bspline --accel $how" "$vodr" reference $raw --filter bspline --blend mip --view 30,20 \
            --accel $how --raw t.rgba
        same "draws the same bytes" r.rgba t.rgba
    done
    for how in '' '--theta plane' '--copies 1'; do
        # shellcheck disable=SC2086 # words
        "$vodr" reference $raw --filter bspline --accel aligned-paper $how --view 30,20 --raw t.rgba --stats t.json >t.txt
        expect "aligned-paper $how: PSNR" 'PSNR [0-9.inf]* dB against the usual frame' t.txt
        expect "aligned-paper $how: stats" '"theta_deg": -*[0-9.]*' t.json
    done
    expect 'aligned-paper: its copies' '^coefficients *1 copy$' t.txt
    rm -f t.txt t.json
    bad 2 "--accel aligned does not go with filter=cardinal, which has none, best, rival, hull" "$vodr" reference $raw -o no.png \
        --filter cardinal --accel aligned
    bad 2 "--theta 'up': must be box or plane" "$vodr" reference $raw -o no.png --theta up
    bad 2 "--theta goes with --accel aligned-paper" "$vodr" reference $raw -o no.png --filter bspline --accel aligned --theta box
    bad 2 "--copies '2': must be 1 or 3" "$vodr" reference $raw -o no.png --copies 2
    bad 2 "--copies goes with --accel aligned, aligned-best and aligned-paper" "$vodr" reference $raw -o no.png --copies 1
    good "reference --filter nearest" "$vodr" reference $raw --filter nearest --raw r.rgba
    good "reference --set filter=nearest" "$vodr" reference $raw --set filter=nearest --raw t.rgba
    same "draws the same bytes" r.rgba t.rgba
    rm -f r.rgba t.rgba r.json
    bad 2 "--shading 'flat': must be none or phong" "$vodr" reference $raw -o no.png --shading flat
    bad 2 "--step '0': must be" "$vodr" reference $raw -o no.png --method raycast --step 0
    bad 2 "--block '0': must be" "$vodr" reference $raw -o no.png --block 0
    bad 2 "--block '1': must be" "$vodr" reference $raw -o no.png --block 1
    bad 2 "--accel seed goes with blend=mip" "$vodr" reference $raw -o no.png --accel seed
    good "reference, mip" "$vodr" reference $raw --blend mip --accel none --raw r.rgba
    for how in block bisect seed best 'seed --block 2' 'block --block 32768'; do
        good "reference, mip, --accel $how" "$vodr" reference $raw --blend mip --accel $how --raw t.rgba
        same "draws the same bytes" r.rgba t.rgba
    done
    rm -f r.rgba t.rgba
    bad 2 "--termination '1.5': must be" "$vodr" reference $raw -o no.png --termination 1.5
    bad 2 "--slices '0': must be" "$vodr" reference $raw -o no.png --slices 0
    bad 2 "--method raycast has no --numbers fixed" "$vodr" reference $raw -o no.png --method raycast --numbers fixed
    for how in '--accel block' '--shading phong' '--block 4' '--termination 0.5'; do
        bad 2 "${how% *} does not go with" "$vodr" reference $raw -o no.png --numbers fixed $how
    done
    bad 2 "--step goes with --method raycast" "$vodr" reference $raw -o no.png --step 2
    bad 2 "--numbers double is drawn on --device cpu only" "$vodr" reference $raw -o no.png --numbers double --device cuda
    bad 2 "--shading phong does not go with blend=mip" "$vodr" reference $raw -o no.png --shading phong --blend mip
    bad 2 "--cycles is of the machine" "$vodr" reference $raw -o no.png --cycles
    bad 2 "--path is of the machine" "$vodr" reference $raw -o no.png --path blocks
    bad 2 "both name 'no.png'" "$vodr" reference $raw -o no.png --raw no.png
    bad 2 "none.nrrd" "$vodr" reference none.nrrd -o no.png
    bad 3 "'none/x'" "$vodr" reference $raw --raw none/x
    bad 3 "CUDA" env CUDA_VISIBLE_DEVICES= "$vodr" reference $raw -o no.png --device cuda
}

# ---- compare ----
good "compare, equal" "$vodr" compare a.png a.png
good "compare --json, equal" "$vodr" compare a.png a.png --json
expect "psnr is null" '"psnr": null' ../out
expect "first_difference is null" '"first_difference": null' ../out
"$vodr" compare a.png b.png --json --diff diff.png >../out 2>../err
verdict "compare, different: exit code 1" "$([ $? -eq 1 ] || echo "it is another")"
verdict "compare, different: silent on standard error" "$(cat ../err)"
expect "first_difference has a channel" '"channel": "[rgba]"' ../out
verdict "--diff writes a picture" "$([ -s diff.png ] || echo "it does not")"
good "compare within the tolerance" "$vodr" compare a.png b.png --tolerance 255
bad 2 "16x8 pixels but 'f.png' is 20x10" "$vodr" compare a.png f.png --diff no.png
bad 2 "'none.png'" "$vodr" compare a.png none.png
bad 2 "as a PNG" "$vodr" compare a.png a.json
bad 2 "'../here'" "$vodr" compare a.png ../here
bad 2 "needs B.png" "$vodr" compare a.png
bad 2 "--tolerance '-1'" "$vodr" compare a.png b.png --tolerance -1
bad 3 "no/diff.png" "$vodr" compare a.png b.png --diff no/diff.png
bad 3 "/dev/full" "$vodr" compare a.png b.png --diff /dev/full

# ---- bad usage ----
bad 2 "a command is needed" "$vodr"
bad 2 "'draw'" "$vodr" draw
bad 2 "further argument 'x'" "$vodr" --version x
bad 2 "render needs VOLUME" "$vodr" render
bad 2 "'w.raw'" "$vodr" render v.raw w.raw
bad 2 "'--colour'" "$vodr" render v.raw --colour red
bad 2 "'-x'" "$vodr" render v.raw -x
bad 2 "--size needs a value" "$vodr" render v.raw --size
bad 2 "--size is given more than once" "$vodr" render v.raw --size 2x2 --size=3x3
bad 2 "it takes no value" "$vodr" render v.raw --alpha=1
bad 2 "paper-48" "$vodr" machine show paper-48
bad 2 "must be list or show" "$vodr" machine print
bad 2 "further operand" "$vodr" machine list all
bad 2 "needs the name" "$vodr" machine show

# refuse VALUE... -- OPTION: each value of the option is refused in a sentence that names both
refuse() {
    option=$1
    shift
    for value in "$@"; do
        # shellcheck disable=SC2086
        bad 2 "--$option '$value'" "$vodr" render $raw -o no.png "--$option" "$value"
    done
}
refuse view 0,90.5 36001,0 1 a,b 1,2,3,4 "1, 2" 1,,2 nan,0 1e999,0 0x10,0 ""
refuse projection isometric perspective: perspective:0.5 perspective:151 perspective:x parallel:30 ""
refuse zoom 0 -1 x inf 1x ""
refuse size 0x3 3x0 16385x1 3 3x 3x4x5 -3x4 3X4 99999999999999999999x1 ""
refuse slices 0 -1 16385 1.5 x ""
refuse window 1 1:1 2:1 a:b 1:2:3 ""
refuse threads -1 1025 x
refuse repeat 0 1001 x
refuse background fff gggggg 1234567 0x1234
refuse set ways =3 ""
refuse path slow Fast ""

# shellcheck disable=SC2086
{
    bad 2 "'colour'" "$vodr" render $raw -o no.png --set colour=red
    bad 2 "--set: ways is '3'" "$vodr" render $raw -o no.png --set ways=3
    bad 2 "--blend: blend is 'add'" "$vodr" render $raw -o no.png --blend add
    bad 2 "--filter" "$vodr" render $raw -o no.png --filter cubic
    bad 2 "--traversal" "$vodr" render $raw -o no.png --traversal spiral
    bad 2 "cache_bytes" "$vodr" render $raw -o no.png --set cache_bytes=64 --set ways=1024
    bad 2 "dram_trfc_cycles=300 must be below dram_refresh_cycles=300" "$vodr" render $raw -o no.png \
        --set dram_trfc_cycles=300 --set dram_refresh_cycles=300
    bad 2 "--set: texture_latency_cycles is '0'" "$vodr" render $raw -o no.png --set texture_latency_cycles=0
    bad 2 "--set: write_fifo is '257'" "$vodr" render $raw -o no.png --set write_fifo=257
    bad 2 "--set: pipelines is '17'" "$vodr" render $raw -o no.png --set pipelines=17
    bad 2 "pipelines=2: blocks in Verilog take 1 only" "$vodr" render $raw --rtl pixel_cache --set pipelines=2
    bad 2 "'paper-48'" "$vodr" render $raw -o no.png --machine paper-48
    bad 2 "'./paper-16'" "$vodr" render $raw -o no.png --machine ./paper-16
    bad 2 "'.' is a directory" "$vodr" render $raw -o no.png --machine .
    printf 'ways = 4\nways = 4\n' >twice.txt
    bad 2 "twice.txt:2" "$vodr" render $raw -o no.png --machine twice.txt
    bad 2 "'unknown'" "$vodr" render $raw -o no.png --tf unknown
    bad 2 "'none.txt'" "$vodr" render $raw -o no.png --energy none.txt
    printf 'add | 0.03\ndivide | 2\n' >odd.txt
    bad 2 "odd.txt:2: there is no energy 'divide'" "$vodr" render $raw -o no.png --energy odd.txt
    printf 'pixel_cache | 7 | 8\npixel_cache SIZE=1 | 7 | 8\n' >odd_rows.txt
    bad 2 "odd_rows.txt:2: pixel_cache has no parameter 'SIZE'" "$vodr" render $raw -o no.png --cells odd_rows.txt
    printf '0 0 0 0 0\n1 0 0 2 0\n' >tf2.txt
    bad 2 "tf2.txt:2: b is '2'" "$vodr" render $raw -o no.png --tf tf2.txt
    bad 2 "both name 'no.png'" "$vodr" render $raw -o no.png --raw no.png
    bad 2 "dims" "$vodr" render v.raw -o no.png --dims 0x8x8
    bad 2 "v.raw" "$vodr" render v.raw -o no.png --dims 16x8x9
    bad 2 "v.raw" "$vodr" render v.raw -o no.png
    bad 2 "crop" "$vodr" render $raw -o no.png --crop 0:17,0:8,0:8
    bad 2 "none.nrrd" "$vodr" render none.nrrd -o no.png
    bad 2 "none?nrrd" "$vodr" render "none
nrrd" -o no.png
    : >empty.nrrd
    bad 2 "empty.nrrd" "$vodr" render empty.nrrd -o no.png
    bad 2 "dcm2niix" "$vodr" render ../here -o no.png
    { head -c 128 /dev/zero && echo DICM; } >series.dcm
    bad 2 "dcm2niix" "$vodr" info series.dcm
    printf 'NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n77777777' >same.nrrd
    bad 2 "--spacing: along y it is 2" "$vodr" render same.nrrd -o no.png --spacing 1,2,1
    good "info of voxels that are all alike" "$vodr" info same.nrrd
    expect "it suggests no window that would be refused" '^suggested *--tf ramp$' ../out
    bad 2 "at zoom 0.01 and 16384x16384 pixels" "$vodr" render $raw -o no.png --zoom 0.01 --size 16384x16384

    # ---- unwritable output ----
    mkdir sub
    for option in output raw stats registers; do
        bad 3 "'none/x'" "$vodr" render $raw --$option none/x
        bad 3 "'sub'" "$vodr" render $raw --$option sub
        bad 3 "'sub/'" "$vodr" render $raw --$option sub/
        bad 3 "''" "$vodr" render $raw --$option ''
        bad 3 "'/dev/full'" "$vodr" render $raw --$option /dev/full
    done
    bad 3 "/dev/full" "$vodr" render $raw -o no.png --stats /dev/full --raw no.rgba
    bad 3 "'a.png/x'" "$vodr" render $raw -o a.png/x
    # What is read is never replaced.
    cp v.raw kept.raw
    bad 2 "'kept.raw' is read by this command" "$vodr" render kept.raw --dims 16x8x8 -o kept.raw
    bad 2 "'./kept.raw' is read by this command" "$vodr" render v.raw --dims 16x8x8 --machine kept.raw --raw ./kept.raw
    # A limit on the size of files stands in for a full disk: old files must stay, new ones must not.
    limited() {
        (ulimit -f 8 && exec "$@")
    }
    bad 3 "'b.rgba'" limited "$vodr" render $raw --size 100x100 -o no.png --raw b.rgba
    bad 3 "'no.json'" limited "$vodr" render $raw -o b.png --registers no.json
}
"$vodr" --help >/dev/full 2>../err
verdict "standard output is full: exit code 3" "$([ $? -eq 3 ] || echo "it is another")"

end_checks
