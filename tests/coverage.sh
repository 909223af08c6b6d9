#!/bin/sh
# coverage.sh - what can be seen of the coverage in no time: what is left out of it (tests/coverage.txt) still stands in the
# sources, the page docs/table-coverage.md has the bins that there are, and docs/verification.md is what its script makes.
#   tests/coverage.sh VODR    test_bins lies beside it, in tests/
set -u
# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"
bins=$(dirname "$vodr")/tests/test_bins
cd "$root" || exit 1

# What stands between the marks of a page's generated part.
part() { # PAGE NAME
    awk -v begin="<!-- generated: $2 -->" '$0 == "<!-- end -->" { inside = 0 } inside { print } $0 == begin { inside = 1 }' "$1"
}

sed '/^ *\(#\|$\)/d' tests/coverage.txt >"$work/reasons"
while IFS= read -r line; do
    problem=$(echo "$line" | awk -F ' +[|] +' '
        function is_there(text,    line) {
            while ((getline line <$1) > 0) if (index(line, text)) return 1
            return 0
        }
        NF != 4 || $4 == "" { print "must be: file | kind | text | reason"; exit }
        $2 !~ /^(line|branch|toggle)$/ { print "kind must be line, branch or toggle"; exit }
        $2 == "toggle" { gsub(/\[[^]]*\]/, " ", $3); while (match($3, /[a-z][a-z_0-9]+/)) { # names of signals within an expression
            name = substr($3, RSTART, RLENGTH)
            if (!is_there(name)) { print name " is not in " $1; exit }
            close($1)
            $3 = substr($3, RSTART + RLENGTH)
        } exit }
        !is_there($3) { print "it is not in " $1 }')
    verdict "left out: $line" "$problem"
done <"$work/reasons"

part docs/table-coverage.md coverage-bins >"$work/page"
"$bins" --table >"$work/made"
same 'the page has the bins that there are, and their frames' "$work/made" "$work/page"
equal 'the page has all reasons' "$(part docs/table-coverage.md coverage-reasons | grep -c '^| `')" "$(wc -l <"$work/reasons")"
scripts/verification >"$work/made"
same 'docs/verification.md is what make verification makes' "$work/made" docs/verification.md

end_checks
