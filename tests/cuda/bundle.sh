#!/bin/sh
# bundle.sh BUILD FOLDER: the programs that gpu_check.py runs, stripped, with the shared libraries they need (the loaders of
# OpenGL too, which find the machine's driver), without those of the C library and the compiler; and FOLDER.tar.xz of them.
# The programs look for their libraries in lib/ beside them. `commit` names the state of the sources.
set -eu
build=$1 folder=$2
rm -rf "$folder" "$folder.tar.xz"
mkdir -p "$folder/lib"
for program in spindrift unit_tests cuda_tests cuda_sort_bench; do
    strip -o "$folder/$program" "$build/$program"
    ldd "$build/$program" | awk '$3 ~ /^\// { print $3 }'
done | sort -u | grep -vE '/(libc|libm|libdl|libpthread|librt|libstdc\+\+|libgcc_s)\.so' |
    xargs cp -L -t "$folder/lib"
strip "$folder"/lib/*.so*
git describe --always --dirty > "$folder/commit"
XZ_OPT=-T0 tar -C "$(dirname "$folder")" -cJf "$folder.tar.xz" "$(basename "$folder")"
du -sh "$folder" "$folder.tar.xz"
