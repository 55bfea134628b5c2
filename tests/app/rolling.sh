#!/usr/bin/env bash
# The worm drive rolls on exact flanks at local minimum-gap points, without a penalty, while a point of contact nears
# the end of the wheel's flank: no point that bears a force is missed or found too late, which the balance of
# energy would show, and Newton's method needs little more than one iteration a step.
#   rolling.sh PATH/TO/elastogear PATH/TO/examples/worm_gear
set -euo pipefail
elastogear=$(realpath "$1")
examples=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$examples"/{worm,wheel,rolling}.yaml .
for part in worm wheel; do
  "$elastogear" mesh $part.yaml -size tiny >log 2>&1 || { cat log; exit 1; }
  "$elastogear" reduce $part.yaml -basis modal_residual -modes 10 >log 2>&1 || { cat log; exit 1; }
done
# After 2.009 rad the worm's thread has its point of contact by the end of a flank of the wheel.
rolling=("$elastogear" simulate rolling.yaml -contact_law unilateral -contact_surface exact -contact_points minima
         -contact_two_pass false -worm_flanks worm.yaml -wheel_flanks wheel.yaml
         -worm_angle0 2.0091288 -worm_omega0 126.35 -wheel_angle0 0.1735838 -wheel_omega0 6.1637)
"${rolling[@]}" -ts_dt 1e-5 -ts_max_time 1.5e-3 -output rolling.h5 >log 2>&1 || { cat log; exit 1; }
"${rolling[@]}" -ts_dt 2e-6 -ts_max_time 0.6e-3 -output fine.h5 >fine.log 2>&1 || { cat fine.log; exit 1; }
iterations=$(awk '/Newton iterations/ { print $3 }' fine.log)
[ "$iterations" -lt 360 ] || { echo "FAIL: $iterations Newton iterations in 300 steps"; cat fine.log; exit 1; }
/usr/bin/python3 - <<'PYTHON'
import h5py
import numpy as np

file = h5py.File("rolling.h5")
settled = file["time"][:] > 0.25e-3  # the blow at the start has faded
torque = file["contact/worm:wheel/groups/b/torque"][:].sum(axis=1)[settled, 2]
balance = np.abs(file["energy/balance"][:]).max()
print("torque on the wheel", torque.min(), "to", torque.max(), "N m; balance of energy", balance, "J")
assert 72 < torque.min() and torque.max() < 92  # 82 N m in balance
assert balance < 3e-4
PYTHON
echo "all good"
