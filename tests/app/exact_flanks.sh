#!/usr/bin/env bash
# Gaps on exact flanks are distances from the involute helicoid, which is computed here once more; those on facets are not.
# A deviation of the worm's surface turns the wheel. Rigid flanks that meet without a penalty where their gap is least
# transmit without an error. Gear data of another gear and deviations of other nodes are refused.
#   exact_flanks.sh PATH/TO/elastogear PATH/TO/examples/worm_gear
set -euo pipefail
elastogear=$(realpath "$1")
examples=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
for part in worm wheel; do
  cp "$examples/$part.yaml" .
  "$elastogear" mesh $part.yaml -size tiny >log 2>&1 || { cat log; exit 1; }
  "$elastogear" reduce $part.yaml -basis modal -modes 5 >log 2>&1 || { cat log; exit 1; }
done
cat >drive.yaml <<'END'
bodies: [worm, wheel]
worm:
  {file: worm.h5, rigid: true, joint: fixed, position: [0, 0.05, 0], rotation: [2.221441469079183, 0, 2.221441469079183],
   flanks: worm.yaml}
wheel: {file: wheel.h5, rigid: true, joint: revolute, axis: [0, 0, 1], angle0: 0.0766242, torque: -20, flanks: wheel.yaml}
contact: {pairs: [worm:wheel], two_pass: true}
analysis: static
static_steps: 2
END
"$elastogear" simulate drive.yaml -output exact.h5 -verbose >log 2>&1 || { cat log; exit 1; }
# The gear data may lie in several files, of which the last one counts.
grep -v '^part' worm.yaml | sed '/^# --- reduce/,$d' >first.yaml
printf 'part: wheel\nbacklash: 1\n' >>first.yaml
printf 'part: worm\nbacklash: 40e-6\n' >last.yaml
"$elastogear" simulate drive.yaml -worm_flanks first.yaml,last.yaml -output two.h5 >two.log 2>&1 || { cat two.log; exit 1; }
grep -q "flanks of wheel .*656 faces, nodes within" log || { cat log; exit 1; }
"$elastogear" simulate drive.yaml -contact_surface facets -output facets.h5 >log 2>&1 || { cat log; exit 1; }

# Nodes of the wheel meet a worm that is 5 um thicker.
/usr/bin/python3 - <<'END'
import h5py
with open("thick.csv", "w") as file:
    print("node,deviation [m]", file=file)
    for node in h5py.File("worm.h5")["surface/nodes"]:
        print(f"{node},5e-6", file=file)
END
for deviation in thick none; do
  echo "# nothing" >none.csv
  "$elastogear" simulate drive.yaml -contact_two_pass false -contact_slave second -worm_deviation $deviation.csv \
    -output $deviation.h5 >log 2>&1 || { cat log; exit 1; }
done

# The worm turned by two angles, and the wheel by theirs over 20.5.
i=0
for turned in 0.3 0.9; do
  i=$((i + 1))
  read -r rotation angle < <(/usr/bin/python3 - $turned <<'END'
import sys
from math import acos, cos, pi, sin
turned = float(sys.argv[1])
# Half a turn about (1, 0, 1) / sqrt(2), as in drive.yaml, after `turned` about z: the product of two quaternions.
c, s, h = cos(turned / 2), sin(turned / 2), 0.5 ** 0.5
w, x, y, z = -h * s, h * c, -h * s, h * c
angle = 2 * acos(w)
print(",".join(repr(angle * q / sin(angle / 2)) for q in (x, y, z)), repr(0.0766242 + turned * 2 / 41))
END
)
  "$elastogear" simulate drive.yaml -contact_law unilateral -contact_points minima -contact_two_pass false \
    -worm_rotation "$rotation" -wheel_angle0 "$angle" -output turned_$i.h5 >log 2>&1 || { cat log; exit 1; }
done

# In motion the force of a blow between rigid bodies is that of a time step, which is said; at rest there is none.
if grep -q "rigid bodies without a penalty" log; then cat log; exit 1; fi
"$elastogear" simulate drive.yaml -analysis dynamic -contact_law unilateral -ts_dt 1e-6 -ts_max_time 5e-6 \
  -output blow.h5 >log 2>&1 || { cat log; exit 1; }
grep -q "warning .*worm:wheel: rigid bodies without a penalty" log || { cat log; exit 1; }

refused() {  # PATTERN ARGUMENTS: ends with an error that fits
  if "$elastogear" simulate drive.yaml -output no.h5 "${@:2}" >log 2>&1 || ! grep -Eq "error: .*$1" log; then
    echo "not refused as expected: ${*:2}"; cat log; exit 1
  fi
}
sed 's/^part: worm/&\nbacklash: 0.05e-3/' worm.yaml >slack.yaml
printf 'z1: 2\n' >no_part.yaml
printf 'part: worm\nz1: two\n' >word.yaml
printf 'part: worm\ncentre_distance: 0.02\n' >small.yaml
refused "slack.yaml: body 'worm': node .*, in thread_1_.*, is 2.5e-06 m off .* name the files" -worm_flanks slack.yaml
refused "worm.yaml: body 'wheel': node .*, in tooth_.*, is .* m off" -wheel_flanks worm.yaml
refused "no_part.yaml: names no part" -worm_flanks no_part.yaml
refused "z1 \(word.yaml, line 2\) = 'two'" -worm_flanks word.yaml
refused "small.yaml: there is no lead angle" -worm_flanks small.yaml
refused "nosuch.yaml" -worm_flanks nosuch.yaml
node=$(sed -n 2p thick.csv | cut -d, -f1)
printf '999999,0\n' >no_node.csv
printf '%s,1e-6\n%s,1e-6\n' "$node" "$node" >twice.csv
printf '%s,5\n' "$node" >micrometres.csv
printf '%s\n' "$node" >one_column.csv
refused "no_node.csv, line 1: node 999999 is not on the surface of body 'worm'" -worm_deviation no_node.csv
refused "twice.csv, line 2: node $node is given twice" -worm_deviation twice.csv
refused "micrometres.csv, line 1: deviation 5 m of node $node exceeds" -worm_deviation micrometres.csv
refused "one_column.csv, line 1: must be two numbers" -worm_deviation one_column.csv
refused "nosuch.csv: there is no such file" -worm_deviation nosuch.csv
sed 's/, flanks: wheel.yaml//; /flanks: worm.yaml/s/flanks: worm.yaml//' drive.yaml >plain.yaml
if "$elastogear" simulate plain.yaml -contact_surface exact -output no.h5 >log 2>&1 || ! grep -q "neither body of the pair worm:wheel" log; then
  cat log; exit 1
fi

/usr/bin/python3 - <<'END'
from math import acos, asin, atan, cos, hypot, pi, remainder, sin, tan

import h5py
import numpy as np

m_n, alpha_n, a, j_n, teeth = 2e-3, pi / 12, 50e-3, 40e-6, (2, 41)  # the reference design
low, high = 0, atan((teeth[0] / teeth[1]) ** (1 / 3))
for _ in range(200):
    gamma = (low + high) / 2
    low, high = (gamma, high) if m_n / 2 * (teeth[0] / sin(gamma) + teeth[1] / cos(gamma)) > a else (low, gamma)


def flank_distance(body, tooth, side, x):
    """Signed distance (m) of x in the frame of body 0 (worm) or 1 (wheel) from a flank, docs/theory, section 9."""
    z, angle, theta_1 = teeth[body], (gamma, pi / 2 - gamma)[body], (pi - pi / teeth[0], pi / 2)[body]
    r = m_n * z / (2 * sin(angle))
    alpha_t = atan(tan(alpha_n) / sin(angle))
    r_b, beta_b, p = r * cos(alpha_t), asin(cos(angle) * cos(alpha_n)), r * tan(angle)
    s_n = pi * m_n / 2 - j_n / (2 * cos(alpha_n))
    alpha = acos(r_b / hypot(x[0], x[1]))
    psi = s_n / (2 * r * sin(angle)) + tan(alpha_t) - alpha_t - tan(alpha) + alpha
    theta = remainder(np.arctan2(x[1], x[0]) - x[2] / p - theta_1 - 2 * pi * tooth / z, 2 * pi)
    return r_b * cos(beta_b) * (side * theta - psi)


def largest_error(result):
    """Largest difference (m) of a gap of the last state from the exact distance, and how many gaps there are."""
    names = ["worm", "wheel"]
    surface = [h5py.File(f"{name}.h5")["surface"] for name in names]
    file = h5py.File(result)
    place = [(file[f"bodies/{name}/position"][-1], file[f"bodies/{name}/rotation"][-1]) for name in names]
    points = file["contact/worm:wheel/points"]
    errors = []
    for i in range(points["offset"][-2], points["offset"][-1]):
        slave = points["slave_side"][i]
        master = 1 - slave
        (r, R), (r_m, R_m) = place[slave], place[master]
        x = R_m.T @ (r + R @ surface[slave]["X"][points["slave_node"][i]] - r_m)
        name = surface[master]["group_name"][surface[master]["group"][points["face"][i]]].decode()
        _, number, side = name.split("_")
        exact = flank_distance(master, int(number) - 1, 1 if side == "left" else -1, x)
        errors.append(abs(points["gap"][i] - exact))
    return max(errors), len(errors)


for result in ("exact.h5", "facets.h5"):
    print(result, "largest error %.3g m of %d gaps" % largest_error(result))
assert largest_error("exact.h5")[0] < 0.05e-6
assert largest_error("facets.h5")[0] > 1e-6
angle = {name: h5py.File(f"{name}.h5")["bodies/wheel/rigid"][-1, 0] for name in ("thick", "none")}
turn = 5e-6 / (m_n * cos(alpha_n) * teeth[1] / 2)  # r_b cos(beta_b) = p_bn z / (2 pi), at the point of contact
found = angle["thick"] - angle["none"]
print("turn by the deviation", found, "expected", turn)
assert abs(found / turn - 1) < 0.03  # the node lies beside it
ahead = []
for i, turned in ((1, 0.3), (2, 0.9)):
    file = h5py.File(f"turned_{i}.h5")
    ahead.append(file["bodies/wheel/rigid"][-1, 0] - 0.0766242 - turned * teeth[0] / teeth[1])
    assert file["contact/worm:wheel/penetration"][-1] < 1e-9
error = abs(ahead[1] - ahead[0]) * m_n * teeth[1] / (2 * cos(gamma))
print("transmission error", error, "m")
assert error < 0.1e-6
END
echo "all good"
