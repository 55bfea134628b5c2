#!/usr/bin/env bash
# A held wheel under a worm that is driven by 10 N m without friction takes the worm's torque times z2/z1 = 20.5, on
# average over half a turn of the worm, within 0.5 %.
#   torque_balance.sh PATH/TO/elastogear PATH/TO/examples/worm_gear
set -euo pipefail
elastogear=$(realpath "$1")
examples=$(realpath "$2")
scripts=$(realpath "$(dirname "$0")/../../scripts")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
angles=${3:-48}  # fewer miss or hit the narrow peaks where a node passes an edge or an end
for part in worm wheel; do
  "$elastogear" mesh "$examples/$part.yaml" -size tiny >log 2>&1 || { cat log; exit 1; }
  "$elastogear" reduce "$examples/$part.yaml" >log 2>&1 || { cat log; exit 1; }
done
for i in $(seq 0 $((angles - 1))); do
  angle=$(awk -v i="$i" -v n="$angles" 'BEGIN { print i * atan2(0, -1) / n }')
  turned=$(awk -v i="$i" -v n="$angles" 'BEGIN { pi = atan2(0, -1); print pi / 41 + i * pi / n / 20.5 }')
  "$elastogear" simulate -bodies worm,wheel -worm_file worm.h5 -worm_joint revolute -worm_axis 0,0,1 -worm_angle0 "$angle" \
    -worm_position 0,0.05,0 -worm_rotation 2.221441469079183,0,2.221441469079183 -worm_torque 10 \
    -wheel_file wheel.h5 -wheel_joint fixed -wheel_rotation "0,0,$turned" -contact_pairs worm:wheel -contact_two_pass true \
    -contact_surface smooth -analysis static -static_steps 4 -output "$i.h5" >log 2>&1 || { cat log; exit 1; }
done
PYTHONPATH=$scripts /usr/bin/python3 -B - "$angles" <<'END'
import sys

import h5py
import numpy as np
from figures import figure
ratio = np.array([h5py.File(f"{i}.h5")["contact/worm:wheel/torque"][-1, 2] for i in range(int(sys.argv[1]))]) / 10
print("T2/T1 at the angles:", *(f"{r:.3f}" for r in ratio), f"mean {ratio.mean():.3f}, exact 20.5")
figure(f"worm drive at rest, {len(ratio)} angles", "mean ratio of the torques", abs(ratio.mean()) / 20.5 - 1, 0.005, "%")
END
echo "all good"
