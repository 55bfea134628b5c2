#!/usr/bin/env bash
# The program runs with kernels of OpenBLAS that use the processor, and with those that its user names.
#   blas_kernels.sh PATH/TO/elastogear
set -euo pipefail
elastogear=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# OpenBLAS says as it is loaded which kernels it takes; a program that starts again says so twice.
cores() { env "$@" OPENBLAS_VERBOSE=2 "$elastogear" mesh -part worm -size tiny -mesh worm.msh 2>&1 >log | sed -n 's/^Core: //p'; }

[[ $(cores OPENBLAS_CORETYPE=Nehalem) == Nehalem ]] || { echo "FAIL: the user's kernels are not taken"; exit 1; }
found=$(cores -u OPENBLAS_CORETYPE)
[[ -n $found ]] || { echo "no OpenBLAS that names its kernels: nothing to see"; exit 77; }
case $(tail -n 1 <<<"$found") in
  SkylakeX | Cooperlake | Sapphirerapids) ;;
  Haswell | Zen | Excavator) ! grep -q -m 1 avx512bw /proc/cpuinfo || { echo "FAIL: AVX-512 is not used"; exit 1; } ;;
  *) ! grep -q -m 1 avx2 /proc/cpuinfo || { echo "FAIL: AVX2 is not used: $found"; exit 1; } ;;
esac
[[ -s worm.msh ]] || { echo "FAIL: no mesh"; exit 1; }
echo "all good"
