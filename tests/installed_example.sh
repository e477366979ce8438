#!/bin/sh
# The library as others use it: installed into an empty folder, found there by a project of its
# own, which runs.
#   installed_example.sh SOURCE BUILD
set -eu
prefix=$2/installed
rm -rf "$prefix" "$2/installed_example"
cmake --install "$2" --prefix "$prefix" --component library >/dev/null
# Nothing of the source may be needed, and nothing that draws.
cp -r "$1/examples" "$prefix/examples"
cmake -S "$prefix/examples" -B "$2/installed_example" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_BUILD_TYPE=Release --log-level=WARNING
cmake --build "$2/installed_example"
if ldd "$2/installed_example/flap_example" | grep -E 'libGL|libEGL|libOpenGL|libSDL'; then
    echo "the library drags in a window" >&2
    exit 1
fi
"$2/installed_example/flap_example" 0.2
