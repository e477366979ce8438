#!/bin/sh
# bundle.sh BUILD FOLDER: the programs that gpu_check.py runs, stripped, with the shared libraries they need (the loaders of
# OpenGL too, which find the machine's driver), without those of the C library and the compiler.
set -eu
build=$1 folder=$2
rm -rf "$folder"
mkdir -p "$folder/lib"
for program in spindrift unit_tests cuda_tests cuda_sort_bench; do
    strip -o "$folder/$program" "$build/$program"
    ldd "$build/$program" | awk '$3 ~ /^\// { print $3 }'
done | sort -u | grep -vE '/(libc|libm|libdl|libpthread|librt|libstdc\+\+|libgcc_s)\.so' |
    xargs cp -L -t "$folder/lib"
du -sh "$folder"
