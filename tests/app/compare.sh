#!/usr/bin/env bash
# elastogear compare: a run agrees with itself and with the same mesh numbered backwards, a doubled load deviates by what
# is known beforehand, and files that do not fit end in a clear error.
#   compare.sh PATH/TO/elastogear
set -euo pipefail
elastogear=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# A bar of three hexahedra of 10 mm, nodes counted from 1 or backwards; FIX is the left end, END the right one.
source "$here/bar.sh"
{ bar 3 1 1 0.01 0.01 0.01 && printf '*NSET, NSET=MIDDLE\n5, 6, 7, 8, 9, 10, 11, 12\n'; } >forth.inp
awk -F', ' -v OFS=', ' '/^\*/ { kind = $1; print; next } # the first number of a node is its own, of a cell not a node
  { for (i = kind == "*ELEMENT" ? 2 : 1; i <= (kind == "*NODE" ? 1 : NF); ++i) if (kind != "*SURFACE") $i = 17 - $i; print }' \
  forth.inp >back.inp

# run NAME FORCE: static response to a force on the tip; stress of the middle.
run() {
  "$elastogear" simulate -bodies a -a_file "$1.h5" -loads pull -pull_marker a.END -pull_force "$2,0,0" -analysis static \
    -static_steps 4 -output "$1_$2.h5" >log 2>&1 || { cat log; exit 1; }
  "$elastogear" recover -result "$1_$2.h5" -stress_a MIDDLE -output "$1_$2_stress.h5" >log 2>&1 || { cat log; exit 1; }
}
for name in forth back; do
  "$elastogear" reduce -mesh $name.inp -material_E 210e9 -material_nu 0.3 -material_rho 7850 -restrain FIX -markers END \
    -stress_nodes MIDDLE -basis full -output $name.h5 >log 2>&1 || { cat log; exit 1; }
done
run forth 1000
run forth 2000
run back 1000

# expect_share TABLE.csv LARGEST SMALLEST: bounds of the deviations in percent (the columns of components that are zero by
# symmetry aside).
expect_share() {
  awk -F, -v high="$2" -v low="$3" 'NR > 1 { for (i = 8; i <= 9; ++i) if (!($i <= high && $i >= low)) { print FILENAME ": " $0; bad = 1 } }
    END { exit bad || NR < 3 }' "$1"
}
"$elastogear" compare forth_1000_stress.h5 forth_1000_stress.h5 -output self >out
expect_share self_1.csv 0 0
grep -q "Stress over time" out || { echo "FAIL: no signals"; cat out; exit 1; }
"$elastogear" compare forth_2000_stress.h5 forth_1000_stress.h5 -output double >out
expect_share double_1.csv 100.000001 99.999999
"$elastogear" compare forth_1000_stress.h5 forth_2000_stress.h5 -at last -reference_at 0.5 -output half >out
expect_share half_1.csv 1e-6 0
grep -q "over time" out && { echo "FAIL: signals of files whose times differ"; exit 1; }
"$elastogear" compare forth_1000_stress.h5 forth_2000_stress.h5 -to 0.5 -output early >out # the peak until half the load
grep -q "peak at" out && awk -F, 'NR == 2 && !($5 == 0.5) { exit 1 }' early_3.csv || { echo "FAIL: not the peak within -to"; exit 1; }
"$elastogear" compare back_1000_stress.h5 forth_1000_stress.h5 -match position -output back >out
expect_share back_1.csv 1e-6 0
"$elastogear" compare forth_1000_stress.h5 forth_1000_stress.h5 -node_a 4 | grep -q "a MIDDLE node 4 " ||
  { echo "FAIL: no row of the node that was asked for"; exit 1; }

expect_error() {
  local pattern=$1
  shift
  if "$elastogear" compare "$@" -output new >out 2>&1 || ! grep -Eq "error: .*$pattern" out || ls new* 2>/dev/null; then
    echo "FAIL: no error matching '$pattern' from compare $*"; cat out; exit 1
  fi
}
expect_error 'two files, not 1' forth_1000.h5
expect_error 'nosuch.h5: there is no such file' nosuch.h5 forth_1000.h5
expect_error 'must be result files, or both stress files' forth_1000.h5 forth_1000_stress.h5
expect_error 'result and stress files can be compared' forth.h5 back.h5
expect_error 'at = 7 s: is outside of the file' forth_1000_stress.h5 forth_1000_stress.h5 -at 7
expect_error 'no pair of bodies and no moving body' forth_1000.h5 forth_1000.h5
expect_error 'unknown option -node_b' forth_1000_stress.h5 forth_1000_stress.h5 -node_b 1
expect_error 'no time between 3 and 1 s' forth_1000_stress.h5 forth_1000_stress.h5 -from 3
expect_error 'share 1 times between 1 and 1' forth_1000_stress.h5 forth_1000_stress.h5 -from 1
echo "all good"
