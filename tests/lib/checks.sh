# checks.sh - what the checks from outside share; to be sourced. Each begins with begin_checks, and ends with end_checks.
# shellcheck shell=sh

passed=0
failed=0

# begin_checks SCRIPT VODR: sets $vodr and $root, and goes to an empty folder where files are judged. What the checks
# themselves write lies beside it, the last command's output and errors in ../out and ../err.
begin_checks() {
    if [ $# -ne 2 ] || [ ! -x "$2" ]; then
        echo "usage: tests/$(basename "$1") VODR (a program that can be run)" >&2
        exit 2
    fi
    # shellcheck disable=SC2034 # for those who source this
    vodr=$(CDPATH='' cd "$(dirname "$2")" && pwd)/$(basename "$2")
    # shellcheck disable=SC2034
    root=$(CDPATH='' cd "$(dirname "$1")/.." && pwd)
    work=$(mktemp -d "${TMPDIR:-/tmp}/vodr-checks-XXXXXX")
    trap 'rm -rf "$work"' EXIT
    trap 'exit 1' HUP INT TERM
    mkdir "$work/here" && cd "$work/here" || exit 1
}

# The closing line; fails when a check did.
end_checks() {
    echo "$passed passed, $failed failed"
    [ "$failed" -eq 0 ]
}

verdict() { # NAME PROBLEM: an empty PROBLEM is a pass
    if [ -z "$2" ]; then
        passed=$((passed + 1))
        echo "ok   $1"
    else
        failed=$((failed + 1))
        echo "FAIL $1: $2"
    fi
}

# good NAME COMMAND...: exit 0, nothing on standard error
good() {
    name=$1
    shift
    "$@" >../out 2>../err
    code=$?
    problem=
    [ $code -eq 0 ] || problem="exit code $code"
    [ -s ../err ] && problem="$problem, said: $(cat ../err)"
    verdict "$name" "$problem"
}

# bad CODE WORDS COMMAND...: that exit code, one line on standard error that begins with `vodr: ` and holds WORDS,
# nothing on standard output, no file made, changed or left behind
bad() {
    want=$1
    words=$2
    shift 2
    before=$(ls -lA --full-time)
    "$@" >../out 2>../err
    code=$?
    problem=
    [ $code -eq "$want" ] || problem="exit code $code, not $want"
    [ "$(wc -l <../err)" -eq 1 ] || problem="$problem, $(wc -l <../err) lines on standard error"
    grep -q '^vodr: ' ../err || problem="$problem, the line does not begin with vodr:"
    grep -qF -e "$words" ../err || problem="$problem, it does not say '$words': $(cat ../err)"
    [ -s ../out ] && problem="$problem, something on standard output"
    [ "$before" = "$(ls -lA --full-time)" ] || problem="$problem, the files changed"
    shift
    verdict "refused: $*" "$problem"
}

expect() { # NAME PATTERN FILE
    verdict "$1" "$(grep -q -e "$2" "$3" || echo "no line of $3 matches $2")"
}

equal() { # NAME A B
    verdict "$1" "$([ "$2" = "$3" ] || echo "'$2' is not '$3'")"
}

same() { # NAME A B
    verdict "$1" "$(cmp "$2" "$3" 2>&1)"
}
