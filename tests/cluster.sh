#!/bin/sh
# cluster.sh - `vodr cluster` from outside: the picture of one node by any number of them, simulated and under mpirun,
# however dealt out and composited; memory; ends of runs in which nodes fail.
#   tests/cluster.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"

# Two blobs and a haze in 40x22x30 voxels, most of them empty under `tf`.
voxels() {
    LC_ALL=C awk 'BEGIN {
        for (z = 0; z < 30; z++) for (y = 0; y < 22; y++) for (x = 0; x < 40; x++) {
            a = 200 - 14 * sqrt((x - 10)^2 + (y - 8)^2 + (z - 9)^2)
            b = 255 - 19 * sqrt((x - 29)^2 + (y - 14)^2 + (z - 20)^2 / 4)
            v = int(a > b ? a : b)
            printf "\\%03o", v < (x * 7 + y * 3 + z) % 16 ? (x * 7 + y * 3 + z) % 16 : v
        }
    }'
}
# shellcheck disable=SC2059 # what is printed are the bytes
printf "$(voxels)" >v.raw
printf '0 1 1 1 0\n40 1 0.5 0.2 0\n120 0.2 0.8 1 0.1\n255 1 1 1 0.6\n' >tf
printf '# normalized\n0 0 0 0 0\n1 1 1 1 0\n' >hides.tf
verdict "the volume" "$([ "$(wc -c <v.raw)" -eq 26400 ] || wc -c <v.raw)"
raw='v.raw --dims 40x22x30'
parallel='--tf tf --view 35,25,10 --zoom 2 --size 83x71'
perspective='--tf tf --view -140,-30 --projection perspective:75 --zoom 2.5 --size 71x83 --slices 64'

# ---- what one node draws ----
view=
# shellcheck disable=SC2086
for look in parallel perspective; do
    eval "view=\$$look"
    for blend in over mip; do
        good "reference, $look, $blend" "$vodr" reference $raw $view --blend $blend --raw $look-$blend.rgba -o $look-$blend.png
        good "one node" "$vodr" cluster $raw $view --blend $blend --raw one.rgba
        same "is the reference renderer's" one.rgba $look-$blend.rgba
    done
done

# alike NAME LOOK BLEND: what x.png and x.rgba are the picture of one node; maxima to the byte
alike() {
    if [ "$3" = mip ]; then
        same "$1" x.rgba "$2-mip.rgba"
    else
        good "$1" "$vodr" compare x.png "$2-over.png" --tolerance 1
    fi
}

# ---- simulated nodes ----
# shellcheck disable=SC2086
for blend in over mip; do
    for balance in static octree paper best; do
        for composite in direct binary-swap radix-k; do
            "$vodr" cluster $raw $perspective --blend $blend --nodes 7 --balance $balance --composite $composite \
                -o x.png --raw x.rgba >/dev/null
            alike "7 nodes, $blend, $balance, $composite" perspective $blend
        done
    done
    for nodes in 1 2 3 5 8 13 16 100; do
        "$vodr" cluster $raw $parallel --blend $blend --nodes $nodes --composite binary-swap --channel uint16 \
            --weight samples -o x.png --raw x.rgba --stats $nodes.json >/dev/null
        alike "$nodes nodes, $blend" parallel $blend
    done
done

# By time planes move after each eighth frame; at last they lie as they were best.
# shellcheck disable=SC2086
{
    good "7 nodes by time" "$vodr" cluster $raw $perspective --nodes 7 --weight time --repeat 170 -o x.png --stats s.json
    good "the same picture" "$vodr" compare x.png perspective-over.png --tolerance 1
}

# value KEY FILE; array KEY FILE: a line a node
value() { sed -n "s/^ *\"$1\": \([-0-9.e]*\),*$/\1/p" "$2" | head -n 1; }
array() { awk -v key="\"$1\":" '$1 == key && $2 == "[" { inside = 1; next } inside && /\]/ { exit } inside { gsub(/[ ,]/, ""); print }' "$2"; }

# shellcheck disable=SC2086
{
    good "stats" "$vodr" cluster $raw $parallel --nodes 8 --balance paper --stats s.json
    for key in subvolumes weight parts clusters held_bytes samples render_s cpu_s composite_s sent_bytes; do
        equal "$key of each node" "$(array $key s.json | wc -l)" 8
    done
    equal "the nodes' sub-volumes are all" "$(array subvolumes s.json | awk '{ s += $1 } END { print s }')" \
        "$(value nonempty_subvolumes s.json)"
    lbr=$(array subvolumes s.json | sort -n | awk 'NR == 1 { least = $1 } { most = $1 } END { printf "%.6f", least / most }')
    equal "lbr is the least over the greatest" "$(value lbr s.json | awk '{ printf "%.6f", $1 }')" "$lbr"
    equal "the nodes' samples are all" "$(array samples s.json | awk '{ s += $1 } END { print s }')" "$(value samples s.json)"
    good "best" "$vodr" cluster $raw $parallel --nodes 8 --stats b.json
    verdict "best is more even" "$(awk -v a="$(value lbr b.json)" -v b="$lbr" 'BEGIN { if (a <= b) print a, "after", b }')"
}

# ---- another transfer function ----
# Steps of a slider: what shows shrinks and grows by little; the last function is the first of all the other checks.
for step in 1 2 3; do
    printf '0 1 1 1 0\n%d 1 0.5 0.2 0\n120 0.2 0.8 1 0.1\n255 1 1 1 0.6\n' $((40 - 8 * step)) >step$step
done
then="${parallel#--tf tf} --tf step3 --then step2 --then step1 --then tf"
# little FILE: each change moved and read at most a fifth of a scatter's bytes, and some moved something
little() {
    awk '/"moved_bytes"/ { moved = $2 + 0; all += moved } /"read_bytes"/ { read = $2 + 0 } /"scatter_bytes"/ { n++; if (moved + read > 0.2 * $2) print "moved", moved, "read", read, "of", $2 }
        END { if (n != 3 || all == 0) print n, "changes moved", all, "bytes" }' "$1"
}
# shellcheck disable=SC2086
for blend in over mip; do
    good "changes, $blend" "$vodr" cluster $raw $then --subvolume 4 --nodes 5 --blend $blend -o x.png --raw x.rgba --stats s.json
    alike "the last function's picture" parallel $blend
    verdict "changes move little" "$(little s.json)"
done
# shellcheck disable=SC2086
for balance in static octree paper; do
    good "changes, $balance" "$vodr" cluster $raw $then --nodes 5 --balance $balance -o x.png
    alike "the last function's picture" parallel over
done
# shellcheck disable=SC2086
{
    good "changes, no room for old and new" "$vodr" cluster $raw $then --subvolume 4 --nodes 8 --node-memory 0.01 -o x.png --stats s.json
    alike "the last function's picture" parallel over
    verdict "all is read anew" "$(grep -E '"(moved|read)_bytes": [1-9]' s.json)"
    good "a function that hides all, and back" "$vodr" cluster $raw $parallel --then hides.tf --then tf --nodes 5 -o x.png
    alike "the last function's picture" parallel over
    bad 2 "none.tf" "$vodr" cluster $raw --then none.tf
}

# ---- nodes that are machines ----
wide='--set fb_bits=16 --set tf_bits=16 --set cache_bytes=8192'
# shellcheck disable=SC2086
for look in parallel perspective; do
    eval "view=\$$look"
    good "the machine, $look" "$vodr" render $raw $view $wide --cycles --raw m.rgba -o m.png --stats r.json
    good "one node" "$vodr" cluster $raw $view $wide --renderer machine --subvolume 64 --raw x.rgba --stats s.json
    same "is the machine" x.rgba m.rgba
    equal "and takes its cycles" "$(value slowest s.json)" "$(value total r.json)"
    for nodes in 2 7; do
        good "$nodes machines" "$vodr" cluster $raw $view $wide --renderer machine --nodes $nodes --balance best -o x.png --stats s.json
        good "a picture without seams" "$vodr" compare x.png m.png --tolerance 0.05
        equal "cycles of each" "$(array cycles s.json | sort -n | tail -n 1)" "$(value slowest s.json)"
    done
done
# shellcheck disable=SC2086
{
    bad 2 "--renderer machine does not go with --then" "$vodr" cluster $raw --renderer machine --then bone
    bad 2 "--renderer machine does not go with blend mip" "$vodr" cluster $raw --renderer machine --blend mip
    bad 2 "--link '1': must be CYCLES,BYTES" "$vodr" cluster $raw --link 1
}

# ---- what shows nothing, or hardly anything ----
head -c 27 /dev/zero >small.raw
# shellcheck disable=SC2086
{
    good "a function that hides all" "$vodr" cluster $raw --tf hides.tf --nodes 5 --raw x.rgba
    good "the same by the reference renderer" "$vodr" reference $raw --tf hides.tf --raw y.rgba
    same "an empty picture" x.rgba y.rgba
    good "a volume of one empty sub-volume, 5 nodes" "$vodr" cluster small.raw --dims 3x3x3 --nodes 5 --raw x.rgba
    verdict "a picture" "$([ "$(wc -c <x.rgba)" -eq 36 ] || wc -c <x.rgba)"
}

# ---- memory ----
# shellcheck disable=SC2086
{
    bad 2 "--node-memory" "$vodr" cluster $raw $parallel --node-memory 0
    bad 2 "bytes of voxels, but 10485 are allowed" "$vodr" cluster $raw $parallel --node-memory 0.01 -o no.png
    good "more nodes than one need less each" "$vodr" cluster $raw $parallel --node-memory 0.01 --nodes 8 -o x.png --stats s.json
    good "the same picture" "$vodr" compare x.png parallel-over.png --tolerance 1
    verdict "no node holds more" "$(array held_bytes s.json | awk '$1 > 10485')"
}

# ---- refused ----
# shellcheck disable=SC2086
{
    bad 2 "--balance 'even': must be static, octree, paper or best" "$vodr" cluster $raw --balance even
    bad 2 "--weight 'size': must be count, samples or time" "$vodr" cluster $raw --weight size
    bad 2 "--composite 'tree': must be direct, binary-swap or radix-k" "$vodr" cluster $raw --composite tree
    bad 2 "--filter cardinal and bspline draw whole volumes" "$vodr" cluster $raw --filter bspline
    bad 2 "--subvolume '3': must be an integer from 4 to 64" "$vodr" cluster $raw --subvolume 3
    bad 2 "--nodes '1025': must be an integer from 1 to 1024" "$vodr" cluster $raw --nodes 1025
    bad 2 "--network '1': must be" "$vodr" cluster $raw --network 1
    bad 2 "--channel 'half': must be float or uint16" "$vodr" cluster $raw --channel half
    bad 2 "--numbers fixed draws whole volumes" "$vodr" cluster $raw --numbers fixed
    bad 2 "--accel seed: of parts of a volume, mip has none and best" "$vodr" cluster $raw --blend mip --accel seed
    bad 2 "'v.raw' is read by this command" "$vodr" cluster $raw -o v.raw
    bad 3 "cannot write 'none/x'" "$vodr" cluster $raw -o none/x
}

# ---- without MPI ----
mkdir ../alone && cp "$vodr" ../alone/vodr
# shellcheck disable=SC2086
{
    good "a program without vodr-mpi.so beside it" ../alone/vodr cluster $raw $parallel --raw x.rgba
    same "draws alone" x.rgba parallel-over.rgba
    bad 3 "mpirun started 3 processes, but this build has no MPI" env OMPI_COMM_WORLD_SIZE=3 ../alone/vodr cluster $raw
}

# ---- processes of mpirun ----
ranks() { # N COMMAND...: under mpirun, as any user, on any number of cores
    count=$1
    shift
    env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 60 mpirun --oversubscribe -n "$count" "$@"
}

# ends CODE WORDS COMMAND...: that exit code, one sentence of vodr's among what mpirun says, no output file, in 30 seconds
ends() {
    want=$1
    words=$2
    shift 2
    rm -f x.png
    start=$(date +%s)
    "$@" >../out 2>../err
    code=$?
    problem=
    [ $code -eq "$want" ] || problem="exit code $code, not $want"
    [ $(($(date +%s) - start)) -lt 30 ] || problem="$problem, it took $(($(date +%s) - start)) s"
    [ ! -e x.png ] || problem="$problem, there is a picture"
    [ -z "$words" ] || [ "$(grep -c '^vodr: ' ../err)" -eq 1 ] || problem="$problem, not one sentence: $(cat ../err)"
    [ -z "$words" ] || grep -qF -e "$words" ../err || problem="$problem, it does not say '$words': $(cat ../err)"
    verdict "ends: $words" "$problem"
}

if ! command -v mpirun >/dev/null || [ ! -e "$(dirname "$vodr")/vodr-mpi.so" ]; then
    echo 'skip processes: there is no mpirun, or the build has no MPI'
    end_checks
    exit
fi
# shellcheck disable=SC2086
{
    for run in '1 best direct' '2 paper binary-swap' '3 octree radix-k' '5 static binary-swap' '8 best radix-k'; do
        # shellcheck disable=SC2034
        read -r nodes balance composite <<END
$run
END
        for blend in over mip; do
            good "$run, $blend" ranks $nodes "$vodr" cluster $raw $perspective --blend $blend --balance $balance \
                --composite $composite -o x.png --raw x.rgba --stats s.json
            alike "the same picture" perspective $blend
        done
        equal "an entry a process" "$(array cpu_s s.json | wc -l)" $nodes
    done
    good "float voxels, gradient lighting" "$vodr" reference v.raw --dims 20x11x30 --type float32 --shading phong -o y.png
    good "the same, 3 processes" ranks 3 "$vodr" cluster v.raw --dims 20x11x30 --type float32 --shading phong -o x.png
    good "the same picture" "$vodr" compare x.png y.png --tolerance 1
    good "3 processes by time" ranks 3 "$vodr" cluster $raw $perspective --weight time --repeat 170 -o x.png
    good "the same picture" "$vodr" compare x.png perspective-over.png --tolerance 1
    good "changes, 5 processes" ranks 5 "$vodr" cluster $raw $then --subvolume 4 -o x.png --stats s.json
    alike "the last function's picture" parallel over
    verdict "changes move little" "$(little s.json)"
    good "3 machines" ranks 3 "$vodr" cluster $raw $perspective $wide --renderer machine -o x.png --stats s.json
    good "the machine's picture" "$vodr" compare x.png m.png --tolerance 0.05
    good "the same, simulated" "$vodr" cluster $raw $perspective $wide --renderer machine --nodes 3 --stats y.json
    equal "as many cycles" "$(grep -A 4 '"cycles": {' s.json)" "$(grep -A 4 '"cycles": {' y.json)"
    good "more processes than sub-volumes" ranks 5 "$vodr" cluster small.raw --dims 3x3x3 --raw x.rgba
    ends 2 "vodr: none.nrrd: " ranks 3 "$vodr" cluster none.nrrd -o x.png
    ends 2 "vodr: --balance 'even'" ranks 3 "$vodr" cluster $raw --balance even -o x.png
    ends 2 "vodr: --nodes 4 simulates nodes in one process, but mpirun started 2" ranks 2 "$vodr" cluster $raw --nodes 4 -o x.png
    ends 2 "vodr: node 1 of 3: " ranks 3 sh -c "[ \$OMPI_COMM_WORLD_RANK = 1 ] && exec '$vodr' cluster gone.raw --dims 40x22x30 -o x.png
        exec '$vodr' cluster $raw -o x.png"
    ends 3 "cannot write 'none/x'" ranks 2 "$vodr" cluster $raw -o none/x
    long='--zoom 20 --size 900x900 --repeat 1000' # minutes of drawing: it is the process that ends, not its work
    ends 137 "" ranks 3 sh -c "[ \$OMPI_COMM_WORLD_RANK = 1 ] && exec timeout -s KILL 2 '$vodr' cluster $raw $long -o x.png
        exec '$vodr' cluster $raw $long -o x.png"
    verdict "mpirun tells which process died" "$(grep -q 'rank 1.*signal 9' ../err || cat ../err)"
}

end_checks
