#!/usr/bin/env bash
# recover takes the body files of the run and no others: moved files pass, whatever options the run changed in memory, and files
# with another mesh, material or restraint are refused by name. So do the scripts.
#   body_of_run.sh PATH/TO/elastogear FOLDER_OF_SCRIPTS
set -u
elastogear=$(realpath "$1")
scripts=$(realpath "$2")
source "$(dirname "$0")/bar.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAIL: $*"; exit 1; }

# reduce NX FILE [option ...]: a bar of 4 cm, held at its left end.
reduce() {
  bar "$1" 1 1 "$(awk -v n="$1" 'BEGIN { print 0.04 / n }')" 0.01 0.01 >bar.inp
  "$elastogear" reduce -mesh bar.inp -material_nu 0.3 -material_rho 1200 -restrain FIX -surface TOP -stress_nodes FIX \
    -output "$2" -modes 5 "${@:3}" >log 2>&1 || { cat log; fail "reduce $2"; }
}
reduce 4 bar.h5 -material_E 2e9
reduce 6 mesh.h5 -material_E 2e9
reduce 4 material.h5 -material_E 1e9
reduce 4 again.h5 -material_E 2e9
mkdir moved && cp bar.h5 moved/bar.h5

simulate() {
  "$elastogear" simulate -bodies low,block -block_mass 1 -block_inertia 1,1,1,0,0,0 -block_joint free -low_file bar.h5 \
    -gravity 0,0,-9.81 -ts_dt 1e-5 -ts_max_time 1e-4 -output "$@" >log 2>&1 || { cat log; fail "simulate $1"; }
}
recover() { "$elastogear" recover -stress_low FIX -output stress.h5 -result "$@" >log 2>&1; }
passes() { recover "$@" || { cat log; fail "recover refuses $*"; }; }
refuses() {
  rm -f stress.h5
  recover "$@" && fail "recover takes $*"
  [ -e stress.h5 ] && fail "recover writes stresses of $*"
  grep -q "error: $3: is not the body 'low' of $1.*-low_file" log || { cat log; fail "the message on $*"; }
}

simulate run.h5
passes run.h5
peak=$(grep "peak von Mises" log)
passes run.h5 -low_file moved/bar.h5
passes run.h5 -low_file again.h5
[ "$(grep "peak von Mises" log)" == "$peak" ] || { cat log; fail "the same contents give other stresses"; }
refuses run.h5 -low_file mesh.h5
refuses run.h5 -low_file material.h5
refuses run.h5 -low_file mesh.h5 -mode_acceleration true

# What a run changes of the body in memory does not make the file another one.
simulate changed.h5 -low_residual false -low_damping_ratio 0.1
passes changed.h5
refuses changed.h5 -low_file material.h5

# A rigid body has no stresses.
simulate rigid.h5 -low_rigid true
recover rigid.h5 && fail "stresses of a rigid body"
grep -q "rigid.h5: no stresses of low, rigid in the run" log || { cat log; fail "the message on a rigid body"; }

passes run.h5
/usr/bin/python3 "$scripts/summary.py" run.h5 stress.h5 --body-file low=moved/bar.h5 >log 2>&1 || { cat log; fail "summary.py"; }
/usr/bin/python3 "$scripts/summary.py" run.h5 stress.h5 --body-file low=material.h5 >log 2>&1 && fail "summary.py takes another body"
grep -q "material.h5: is not the body 'low' of run.h5" log || { cat log; fail "the message of summary.py"; }
echo "all good"
