#!/bin/sh
# completion.sh - scripts/vodr-completion.bash offers what the program's own help and machines name.
#   tests/completion.sh VODR    a line a check, then "N passed, N failed"; exit 1 when any failed
set -u

# shellcheck source=tests/lib/checks.sh
. "$(dirname "$0")/lib/checks.sh"
begin_checks "$0" "$@"

if ! command -v bash >/dev/null; then
    echo 'skip completion: bash is not installed'
    echo '0 passed, 0 failed'
    exit 0
fi
touch volume.nrrd

# The replies to a line typed after the program's name, one a line, sorted.
replies() {
    # shellcheck disable=SC2016
    bash -c '. "$1"
        COMP_LINE="$2 $3"
        COMP_POINT=${#COMP_LINE}
        _vodr
        printf "%s\n" "${COMPREPLY[@]}"' - "$root/scripts/vodr-completion.bash" "$vodr" "$1" | LC_ALL=C sort
}

# offers LINE WORD...: these and no others
offers() {
    line=$1
    shift
    got=$(replies "$line" | tr '\n' ' ')
    want=$(printf '%s\n' "$@" | LC_ALL=C sort | tr '\n' ' ')
    verdict "vodr $line" "$([ "$got" = "$want" ] || echo "offers '$got', not '$want'")"
}

# What the program says of itself, read here in another way than the completion does.
commands=$("$vodr" --help | awk '/^$/ { block++ } block == 2 && NF { print $1 }')
machines=$("$vodr" machine list | awk '{ print $1 }')
axes='volume= view= projection= zoom= size= slices= tf= window= crop= machine='
parameters=$("$vodr" machine show paper-16 | awk '$2 == "=" { print $1 "=" }')

values() { # PARAMETER
    "$vodr" machine show paper-16 | awk -v name="$1" '$1 == name { gsub(/[,;]/, " ", $5); print $5 }'
}

# shellcheck disable=SC2046,SC2086
{
    offers '' $commands --help --version
    for command in $commands; do
        options=$("$vodr" "$command" --help | grep -E '^ +(-[a-z], )?--[a-z]' | grep -oE -e '--[a-z-]+' | sort -u)
        offers "$command --" $options --help
    done
    offers 'render volume.nrrd --machine ' $machines volume.nrrd
    offers 'machine ' list show
    offers 'machine show ' $machines
    offers 'vectors ' generate check
    offers 'vectors generate ' volume_divider slice_generator rasterizer texture_unit alpha_blender pixel_cache frame_buffer
    offers 'vectors check pix' pixel_cache
    offers 'render --set ' $parameters
    offers 'report volume.nrrd --set=' $parameters
    offers 'sweep volume.nrrd --over ' $axes $parameters
    offers 'sweep --over traversal=tile,' $(values traversal | tr ' ' '\n' | sed -n 's/^./tile,&/p')
    offers 'sweep --over=machine=' $machines
    offers 'render --set fb_layout=' $(values fb_layout)
    offers 'render --blend=' $(values blend)
    offers 'render --filter ' $(values filter)
    offers 'report --traversal ' $(values traversal)
}
offers 'rend' render
offers 'render --set line_px=' ''
offers 'render --traversal t' tile
offers 'render --tf ' ramp bone skin-bone vessels mri volume.nrrd
offers 'render --tf=sk' skin-bone
offers 'render --endian ' little big
offers 'render --projection pers' perspective perspective:
offers 'render --zoom ' ''
offers 'reference --device ' cpu cuda
offers 'reference --method ' slices raycast
offers 'reference --numbers ' fixed float double texture
offers 'reference --accel ' none block bisect seed best rival hull aligned aligned-best aligned-paper
offers 'reference --theta ' box plane
offers 'reference --filter ' nearest linear cardinal bspline
offers 'reference --shading ' none phong
offers 'sweep --plot-type ' line bar heat pareto
offers 'sweep --list ' volume.nrrd
offers 'sweep vol' volume.nrrd
offers 'render vol' volume.nrrd
offers 'render -o vol' volume.nrrd
offers 'render --alpha vol' volume.nrrd
offers 'info no-such' ''

end_checks
