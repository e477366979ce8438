#!/bin/sh
# Replaces what stands below the line <!-- measured --> of a document by files, in their order: fill_in.sh DOCUMENT FILE...
set -eu
document=$1
shift
grep -q '^<!-- measured -->$' "$document" || { echo "$document: has no line <!-- measured -->" >&2; exit 1; }
{
    sed '/^<!-- measured -->$/q' "$document"
    for file in "$@"; do
        echo
        cat "$file"
    done
} > "$document.new"
mv "$document.new" "$document"
