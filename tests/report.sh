#!/bin/sh
# report.sh - vodr report from outside: its page is whole, tells what --stats tells, and needs nothing but itself.
#   tests/report.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"

browser=
for name in chromium chromium-browser google-chrome; do
    [ -n "$browser" ] || browser=$(command -v $name)
done

# Every tag of a page is closed in its order; script, style and pre-formatted text aside.
tags_nest() { # PAGE
    awk '
        /^<script/ { inside = 1 }
        inside { if (/^<\/script>/) inside = 0; next }
        /^<style>/ { inside_style = 1 }
        inside_style { if (/^<\/style>/) inside_style = 0; else next; sub(/^<\/style>/, "") }
        {
            text = $0
            while (match(text, /<[^>]*>/)) {
                tag = substr(text, RSTART + 1, RLENGTH - 2)
                text = substr(text, RSTART + RLENGTH)
                name = tag
                sub(/[ ].*/, "", name)
                if (name ~ /^(!DOCTYPE|meta|img|input)$/) continue
                if (name !~ /^\//) { open[++depth] = name; continue }
                if (depth == 0 || "/" open[depth] != name) { print "<" name "> closes <" open[depth] ">"; exit }
                depth--
            }
            if (text ~ /[<>]/) { print "a lone < or > in: " text; exit }
        }
        END { if (depth) print "<" open[depth] "> is not closed" }' "$1"
}

# What would make a browser ask for anything outside the page.
reaches_out() { # PAGE
    pattern='https?://|@import|url\(|<(link|iframe|object|embed|base)|(href|srcset|action)=|fetch\(|XMLHttp'
    grep -noE "$pattern" "$1" | head -n 3
    grep -oE "src=.{6}" "$1" | grep -v "^src='data:"
}

# Lines of a block of JSON in a page.
block() { # PAGE ID
    sed -n "/^<script type='application\/json' id='$2'>\$/,/^<\/script>\$/p" "$1" | sed -e 1d -e '$d'
}

member() { # NAME < JSON: its first value, a number or a word
    sed 's/[{,}]/\n/g' | sed -n "s/^ *\"$1\": *\"\{0,1\}\([^\"]*\)\"\{0,1\}\$/\1/p" | head -n 1
}

sum_of() { # NAME < JSON: of the numbers of an array
    sed -n "s/.*\"$1\":\[\([0-9,]*\)\].*/\1/p" | tr ',' '\n' | awk '{ sum += $1 } END { print sum + 0 }'
}

# page NAME OUT COMMAND...: exit 0, silent on standard error, a page that is whole and needs nothing
page() {
    name=$1
    out=$2
    shift 2
    "$@" >../out 2>../err
    code=$?
    verdict "$name" "$([ $code -eq 0 ] && [ ! -s ../err ] || echo "exit code $code, said: $(cat ../err)")"
    verdict "$name: the page is whole" "$(tags_nest "$out"; tail -n 1 "$out" | grep -qx '</html>' || echo "no </html>")"
    verdict "$name: it reaches for nothing outside" "$(reaches_out "$out")"
}

# The page's script runs to its end and the page then holds WORDS.
browse() { # NAME PAGE WORDS
    if [ -z "$browser" ]; then
        echo "skip $1: no Chromium is installed"
        return
    fi
    timeout 120 "$browser" --headless --no-sandbox --disable-gpu --virtual-time-budget=5000 \
        --user-data-dir="$work/browser" --dump-dom "file://$work/here/$2" >../dom 2>../err
    problem=
    grep -q '^<html [^>]*data-ready="yes"' ../dom || problem="its script did not end"
    grep -qF -e "$3" ../dom || problem="$problem, no '$3'"
    verdict "$1" "$problem"
}

# ---- a page, and what is in it ----
i=0
while [ $i -lt 64 ]; do
    printf '\000\020\040\100\200\300\377\177\010\030\050\110\210\310\350\170'
    i=$((i + 1))
done >'a volume.raw' # 16x8x8 voxels
view='--dims 16x8x8 --view -30,20 --size 100x70 --zoom 5 --threads 1 --set brick=4 --traversal tile'
# shellcheck disable=SC2086
{
    page 'report' a.html "$vodr" report 'a volume.raw' $view -o a.html
    verdict 'it says what it wrote' "$(grep -qx 'written  *a.html' ../out || cat ../out)"
    "$vodr" render 'a volume.raw' $view --cycles --stats a.json -o a.png >/dev/null
}
block a.html stats | grep -vE '"(wall_s|fragments_per_s)":' >../stats.page
grep -vE '"(wall_s|fragments_per_s)":' a.json >../stats.file
same 'its statistics are those of --stats' ../stats.page ../stats.file
sed -n "s/.*src='data:image\/png;base64,\([^']*\)'.*/\1/p" a.html | base64 -d >../picture.png
same 'its picture is that of -o' ../picture.png a.png
misses=$(member misses <a.json)
equal 'the heat map adds up to the misses' "$(block a.html report | sum_of counts)" "$misses"
equal 'visits' "$(block a.html report | member total)" "$(member brick_visits <a.json)"
verdict 'there is more than one' "$([ "$(member brick_visits <a.json)" -gt 1 ] || echo 'there is not')"
equal 'every visit is there' "$(block a.html report | sed 's/.*"brick":\[\([0-9,]*\)\].*/\1/' | tr ',' '\n' | wc -l)" \
    "$(member brick_visits <a.json)"
for machine in paper-general paper-16 paper-32; do
    "$vodr" render 'a volume.raw' --dims 16x8x8 --view -30,20 --size 100x70 --zoom 5 --machine $machine \
        --cycles --stats b.json >/dev/null
    equal "misses beside: $machine" "$(block a.html report | sed "s/.*\"machine\":\"$machine\"//" | member misses)" \
        "$(member misses <b.json)"
    equal "cycles beside: $machine" "$(block a.html report | sed "s/.*\"machine\":\"$machine\"//" | member cycles)" \
        "$(member total <b.json)"
done
# shellcheck disable=SC2086
page 'the clocked machine' clocked.html "$vodr" report 'a volume.raw' $view --path clocked -o clocked.html
block a.html report >../fast.page
block clocked.html report | sed 's/ --path clocked//; s/clocked\.html/a.html/' >../clocked.page
same 'the clocked machine tells the same visits and misses' ../clocked.page ../fast.page
equal 'all draw the same frame' "$(block a.html report | grep -o '"same_frame":[a-z]*' | sort -u)" '"same_frame":true'
parameters=$("$vodr" machine show paper-16 | grep -c ' = ')
equal 'every parameter is there' "$(block a.html report | grep -o '"values":' | wc -l)" "$parameters"
browse 'in a browser' a.html "<span>Misses</span><b>$misses</b>"
browse 'what limits the frame, in a browser' a.html "What limits the frame: $(member bottleneck <a.json | sed 's/; next.*//')"

cp a.html ../first.html
vodr() {
    "$vodr" "$@"
}
eval "$(block a.html report | sed 's/.*"command":"\([^"]*\)".*/\1/')" >/dev/null
grep -vE '"(wall_s|fragments_per_s)":' ../first.html >../first.page
grep -vE '"(wall_s|fragments_per_s)":' a.html >../again.page
same 'the command on the page makes it again' ../first.page ../again.page

# ---- other machines and views ----
raw="a volume.raw"
page 'undivided, mip, alpha' b.html "$vodr" report "$raw" --dims 16x8x8 -o b.html --machine paper-general \
    --blend mip --alpha
browse 'undivided, mip, alpha, in a browser' b.html 'one visit'
page 'perspective from inside, under, 16 bits' c.html "$vodr" report "$raw" --dims 16x8x8 -o c.html --blend under \
    --projection perspective:100 --zoom 20 --set fb_bits=16 --set tf_bits=16 --size 33x65
browse 'perspective from inside, in a browser' c.html 'Misses so far'
page 'nothing on the screen' d.html "$vodr" report "$raw" --dims 16x8x8 -o d.html --size 2x2 --zoom 0.0001
equal 'no visits' "$(block d.html report | member total)" 0
browse 'nothing on the screen, in a browser' d.html 'No pixel was touched'
dd if=/dev/zero of=zero.raw bs=32768 count=1 2>/dev/null
page 'more visits than are kept' e.html "$vodr" report zero.raw --dims 32x32x32 --set brick=1 -o e.html
equal 'they are told' "$(block e.html report | member total)" 32768
equal 'and thinned' "$(block e.html report | member stride)" 2
equal 'evenly' "$(block e.html report | sed 's/.*"brick":\[\([0-9,]*\)\].*/\1/' | tr ',' '\n' | wc -l)" 16384
"$vodr" report "$raw" --dims 16x8x8 -o /dev/stdout >../out 2>../err
verdict 'to standard output: the page alone' \
    "$(head -n 1 ../out | grep -vx '<!DOCTYPE html>' || tail -n 1 ../out | grep -vx '</html>')"

# ---- names that would break a page ----
mkdir 'x<'
hostile="x</script><script>document.title=1<!--'\"&amp;\\\`\${1}.raw"
cp "$raw" "$hostile"
page 'a hostile file name' f.html "$vodr" report "$hostile" --dims 16x8x8 -o f.html
equal 'it opens no further script' "$(grep -o '<script' f.html | wc -l)" 3
equal 'nor ends one' "$(grep -o '</script' f.html | wc -l)" 3
title='<title>script&gt;&lt;script&gt;document.title=1&lt;!--&#39;&quot;&amp;amp;'
verdict 'its title is escaped' "$(grep -qF "$title" f.html || grep '<title>' f.html)"
browse 'a hostile file name, in a browser' f.html '>script&gt;&lt;script&gt;document.title=1&lt;!--'
latin=$(printf 'caf\351.raw')
cp "$raw" "$latin"
page 'a file name that is not UTF-8' g.html "$vodr" report "$latin" --dims 16x8x8 -o g.html
browse 'a file name that is not UTF-8, in a browser' g.html 'caf'

# ---- what is refused ----
bad 2 '--output' "$vodr" report "$raw" --dims 16x8x8
bad 2 'no-such.nrrd' "$vodr" report no-such.nrrd -o no.html
bad 2 '--repeat' "$vodr" report "$raw" --dims 16x8x8 -o no.html --repeat 2
bad 2 'ways' "$vodr" report "$raw" --dims 16x8x8 -o no.html --set ways=3
bad 3 "'no/such/place.html'" "$vodr" report "$raw" --dims 16x8x8 -o no/such/place.html
bad 3 "'.'" "$vodr" report "$raw" --dims 16x8x8 -o .
bad 3 "'/dev/full'" "$vodr" report "$raw" --dims 16x8x8 -o /dev/full
limited() {
    (ulimit -f 8 && exec "$@")
}
bad 3 "'a.html'" limited "$vodr" report "$raw" --dims 16x8x8 -o a.html

end_checks
