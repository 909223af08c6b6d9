# shellcheck shell=bash
# vodr-completion.bash - completion of the vodr command for bash:   . scripts/vodr-completion.bash
#
# Nothing about vodr is written down here but the option a list of words belongs to: subcommands, options, machines,
# parameters and their values are asked of the very program being typed, so they are those it has.

# The options of subcommand $2, one a line: `--view VALUE`, `--alpha`. Program $1.
_vodr_options() {
    "$1" "$2" --help 2>/dev/null | sed -n 's/^ *\(-[a-z], \)\{0,1\}\(--[a-z-]*\) \{0,1\}\([^ ]*\).*/\2 \3/p'
}

# The words that the help of subcommand $2 lists for option $3, those before the parenthesis or the `or` that ends them.
_vodr_words() {
    "$1" "$2" --help 2>/dev/null | sed -n "/^ *$3 /,/^ *--/p" | sed -e '2,$ { /^ *--/d }' -e "s/^ *$3 *[^ ]*//" |
        tr '\n' ' ' | sed -e 's/^[^:]*: //' -e 's/ or a.*//' -e 's/[(;].*//' -e 's/ or /, /' | tr -d ',' | tr ' ' '\n'
}

# The parameters of a machine; the values of parameter $2, where they are words or numbers to choose from.
_vodr_parameters() {
    "$1" machine show paper-16 2>/dev/null | sed -n 's/^\([a-z_]*\) *=.*/\1/p'
}
_vodr_values() {
    "$1" machine show paper-16 2>/dev/null | sed -n "s/^$2 *=[^#]*# \([^ ;]*,[^ ;]*\).*/\1/p" | tr ',' '\n'
}

# What a sweep may vary; the values of name $3 of them, where they are words.
_vodr_axes() {
    _vodr_words "$1" "$2" --over
    echo
    _vodr_parameters "$1"
}
_vodr_axis_values() {
    case $3 in
    machine) _vodr_machines "$1" ;;
    tf) _vodr_words "$1" "$2" --tf ;;
    *) _vodr_values "$1" "$3" ;;
    esac
}

_vodr_machines() {
    "$1" machine list 2>/dev/null | sed 's/ .*//'
}

# The blocks that the help of vectors names.
_vodr_blocks() {
    "$1" vectors --help 2>/dev/null | tr '\n' ' ' | sed -n 's/.*BLOCK: \([a-z_, ]*\)\..*/\1/p' | tr -s ', ' '\n'
}

# What may follow option $3 of subcommand $2, given that $4 is typed of it: files where its help names one.
_vodr_value() {
    case $3 in
    --machine)
        _vodr_machines "$1"
        compgen -f -- "$4"
        ;;
    --set)
        case $4 in
        *=*) _vodr_values "$1" "${4%%=*}" | sed "s/^/${4%%=*}=/" ;;
        *) _vodr_parameters "$1" | sed 's/$/=/' ;;
        esac
        ;;
    --over)
        case $4 in
        *=*) _vodr_axis_values "$1" "$2" "${4%%=*}" | sed "s/^/${4%"${4##*[=,]}"}/" ;;
        *) _vodr_axes "$1" "$2" | sed -e '/./!d' -e 's/$/=/' ;;
        esac
        ;;
    --blend | --traversal) _vodr_values "$1" "${3#--}" ;;
    --filter) if [ "$2" = reference ]; then _vodr_words "$1" "$2" "$3"; else _vodr_values "$1" filter; fi ;;
    --tf | --then)
        _vodr_words "$1" "$2" --tf
        compgen -f -- "$4"
        ;;
    --type | --endian | --plot-type | --device | --method | --numbers | --accel | --theta | --shading | --balance | --weight | --composite | --channel) _vodr_words "$1" "$2" "$3" ;;
    --projection) printf '%s\n' parallel perspective perspective: ;;
    *) if _vodr_options "$1" "$2" | grep -q -e "^$3 .*\(\.[a-z]\|FILE\)"; then compgen -f -- "$4"; fi ;;
    esac
}

# Whether option $3 of subcommand $2 takes a value.
_vodr_takes_value() {
    _vodr_options "$1" "$2" | grep -q -e "^$3 [^ ]"
}

# Every word that may stand where the words given end; the last of them is being typed.
_vodr_candidates() {
    local program=${1/#\~/$HOME} command=$2 current=${*: -1} previous=${*: -2:1}
    [ "$previous" = -o ] && previous=--output
    if [ $# -eq 2 ]; then
        "$program" --help 2>/dev/null | sed -n -e '/^Exit/q' -e 's/^  \([a-z][a-z]*\)  *[a-z].*/\1/p'
        printf '%s\n' --help --version
    elif [[ $current == --*=* ]]; then
        _vodr_value "$program" "$command" "${current%%=*}" "${current#*=}" | sed "s/^/${current%%=*}=/"
    elif [[ $previous == --* ]] && _vodr_takes_value "$program" "$command" "$previous"; then
        _vodr_value "$program" "$command" "$previous" "$current"
    elif [[ $current == -* ]]; then
        _vodr_options "$program" "$command" | sed 's/ .*//'
        echo --help
    elif [ "$command" = machine ]; then
        if [ $# -eq 3 ]; then printf '%s\n' list show; else _vodr_machines "$program"; fi
    elif [ "$command" = vectors ]; then
        if [ $# -eq 3 ]; then printf '%s\n' generate check; else _vodr_blocks "$program"; fi
    else
        compgen -f -- "$current"
    fi
}

# Bash splits words at `=` and `:` too, and puts a reply in place of what follows the last of them.
_vodr() {
    local line=${COMP_LINE:0:COMP_POINT} words current head reply
    read -ra words <<<"$line"
    [[ $line == *[[:space:]] ]] && words+=('')
    current=${words[-1]}
    head=${current%"${current##*[=:]}"}
    COMPREPLY=()
    while IFS= read -r reply; do
        [[ $reply && $reply == "$current"* ]] && COMPREPLY+=("${reply#"$head"}")
    done < <(_vodr_candidates "${words[@]}" | sort -u)
    if [ -e "${COMPREPLY[0]}" ]; then
        compopt -o filenames 2>/dev/null
    elif [[ ${COMPREPLY[0]} == *[=:] ]]; then
        compopt -o nospace 2>/dev/null
    fi
    return 0
}

complete -F _vodr vodr
