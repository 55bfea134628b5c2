#!/usr/bin/env bash
# The turn-in settles as soon with friction that sticks as without any, and at stations of exact flanks as at
# minimum-gap points, within a factor of two.
#   settling.sh PATH/TO/elastogear PATH/TO/examples/worm_gear
set -euo pipefail
elastogear=$(realpath "$1")
examples=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
for part in worm wheel; do
  "$elastogear" mesh "$examples/$part.yaml" -size tiny >log 2>&1 || { cat log; exit 1; }
  "$elastogear" reduce "$examples/$part.yaml" -basis modal -modes 50 >log 2>&1 || { cat log; exit 1; }
  "$elastogear" reduce "$examples/$part.yaml" -modes 20 -output "$part.residual.h5" >log 2>&1 || { cat log; exit 1; }
done
steps() { # options: steps until all rests; at most 2000
  "$elastogear" simulate "$examples/turn_in.yaml" -ts_max_time 4e-3 "$@" >log 2>&1 || { cat log >&2; return 1; }
  grep -q 'at rest after' log || { cat log >&2; return 1; }
  awk '/time steps/ { print $3 }' log
}
free=$(steps)
sticking=$(steps -contact_friction 0.1 -contact_friction_law stick)
echo "steps without friction $free, with friction that sticks $sticking"
((sticking < 2 * free)) || { echo "FAIL: friction that sticks keeps the bodies from rest"; exit 1; }
residual=(-worm_file worm.residual.h5 -wheel_file wheel.residual.h5 -contact_two_pass false
  -worm_flanks "$examples/worm.yaml" -wheel_flanks "$examples/wheel.yaml")
minima=$(steps "${residual[@]}" -contact_points minima)
stations=$(steps "${residual[@]}" -contact_points stations)
echo "steps at minimum-gap points $minima, at stations $stations"
((stations < 2 * minima)) || { echo "FAIL: stations keep the bodies from rest"; exit 1; }
echo "all good"
