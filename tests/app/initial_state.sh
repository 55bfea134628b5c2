#!/usr/bin/env bash
# A run that begins in the middle of another one ends where that one ends, in a rigid hinged body exactly; a static analysis
# takes the place without the rate.
#   initial_state.sh PATH/TO/elastogear
set -euo pipefail
elastogear=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
hinge=("$elastogear" simulate -bodies a -a_mass 1 -a_inertia 1,1,1,0,0,0 -a_joint revolute -ts_dt 0.01)
"${hinge[@]}" -a_angle0 0.3 -a_omega0 2 -a_torque 5 -ts_max_time 1 -output whole.h5 >log 2>&1 || { cat log; exit 1; }
"${hinge[@]}" -a_torque 5 -ts_max_time 0.5 -initial_file whole.h5 -initial_time 0.5 -output half.h5 >log 2>&1 || { cat log; exit 1; }
"$elastogear" compare half.h5 whole.h5 -at last -output half >log || { cat log; exit 1; }
awk -F, 'NR > 1 { ++rows; if (!($4 < 1e-9)) { print; bad = 1 } } END { exit bad || rows != 2 }' half_1.csv ||
  { echo "FAIL: the second half differs"; cat half_1.csv; exit 1; }
"${hinge[@]}" -analysis static -a_rotation_motion speed,0 -ts_max_time 1 -initial_file whole.h5 -initial_time 0.5 -output still.h5 \
  >log 2>&1 || { cat log; exit 1; }
"$elastogear" compare still.h5 whole.h5 -at last -reference_at 0.5 -output still >log || { cat log; exit 1; }
awk -F, '/coordinate/ { exit !($4 < 1e-9) }' still_1.csv && awk -F, '/speed/ { exit !($2 == 0) }' still_1.csv ||
  { echo "FAIL: static analysis begins elsewhere"; cat still_1.csv; exit 1; }
echo "all good"
