#!/bin/sh
# Replaces what stands below the line <!-- measured --> or <!-- knobs --> of a document by files, in their order:
# fill_in.sh DOCUMENT FILE...
set -eu
document=$1
shift
mark='^<!-- \(measured\|knobs\) -->$'
grep -q "$mark" "$document" || { echo "$document: has no line <!-- measured --> or <!-- knobs -->" >&2; exit 1; }
{
    sed "/$mark/q" "$document"
    for file in "$@"; do
        echo
        cat "$file"
    done
} > "$document.new"
mv "$document.new" "$document"
