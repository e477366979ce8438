#!/bin/sh
# Each header of source/ compiles by itself, so that it can be included anywhere, in any order.
set -eu
cd "$(dirname "$0")/.."
one() {
    name=${1#source/}
    lanes="-DSPINDRIFT_REAL=double -DLANES=doubles"
    case $name in
        sim/simulation_simd.h) exit 0 ;; # is a translation unit but for its instruction set
        core/lanes_simd.h | sim/neighbours/cluster_*.h | sim/neighbours/half_list_sums.h)
            lanes="-DSPINDRIFT_SIMD -mavx2 -mbmi -mbmi2 -mfma -mf16c -mpclmul -maes" ;;
    esac
    echo "#include \"$name\"" | c++ -std=c++20 -fopenmp -fsyntax-only -Itests/cuda/emulation -Isource \
        $lanes $(pkg-config --cflags sdl2 hdf5 imgui 2>/dev/null || pkg-config --cflags sdl2 hdf5) \
        -I/usr/include/imgui -x c++ - || { echo "$1 does not compile by itself" >&2; exit 255; }
}
if [ $# -gt 0 ]; then one "$1"; exit; fi
git ls-files 'source/*.h' | xargs -n 1 -P "$(nproc)" "$0"
