#!/usr/bin/env bash
# A sweep of a drive through roll angles: rigid gears transmit without error, on either side; of elastic ones the normal forces
# balance the torque, and each position is the equilibrium that a static analysis finds there, with held gears and on bearings.
# What friction takes is what the torques bring in. Cases are equal to the bit for one rank and two, and after kills; positions
# without an equilibrium are left out, and said.
#   sweep.sh PATH/TO/elastogear PATH/TO/libfaults.so
set -u
elastogear=$(realpath "$1")
faults=$(realpath "$2")
source "$(dirname "$0")/faults.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { cat run.log; echo "FAIL: $*"; exit 1; }
cat >spur.yaml <<'END'
drive: cylindrical
element_order: 1
module: 3 mm
face_width: 25 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 43, profile_shift: 0.1}
modes: 10
analysis: sweep
END
sweep=("$elastogear" simulate spur.yaml)
rigid=(-torque "20 N m" -pinion_rigid true -wheel_rigid true -contact_law unilateral)
bearings=(-pinion_bearing_radial "300 N/um" -wheel_bearing_radial "500 N/um")
"$elastogear" reduce spur.yaml >run.log 2>&1 || fail "the bodies"

for side in drive coast; do
  "${sweep[@]}" "${rigid[@]}" -side $side -sweep_positions 5 -sweep_pitches 2 -output rigid_$side.h5 >run.log 2>&1 || fail "rigid gears"
done
"${sweep[@]}" -torque "300 N m" -sweep_positions 18 -roll -0.2 -output elastic.h5 -verbose >run.log 2>&1 || fail "elastic gears"
grep -q "roll angles  *18 of 18 *$" run.log || fail "positions are not found from one another"
iterations=$(awk '/Newton iterations/ { print $3 }' run.log)
[ "$iterations" -lt 85 ] || fail "$iterations Newton iterations at 18 positions"
"${sweep[@]}" -torque "300 N m" "${bearings[@]}" -sweep_positions 6 -output bearings.h5 >run.log 2>&1 || fail "bearings"
"${sweep[@]}" -torque "300 N m" -contact_friction 0.08 -contact_points minima -sweep_positions 64 -output rough.h5 >run.log 2>&1 || fail "friction"
static=("${sweep[@]}" -analysis static -torque "300 N m")
"${static[@]}" -roll 0.63333333333333333 -output static.h5 >run.log 2>&1 || fail "static"
"${static[@]}" -roll 0.66666666666666667 "${bearings[@]}" -output static_bearings.h5 >run.log 2>&1 || fail "static on bearings"

# Cases on one rank, on two, and killed in all places.
cat >cases.yaml <<'END'
torques: [100 N m, 300 N m]
variants: [nominal, tilted]
variant_tilted: {wheel: {skew: 0.02 deg, lead_crowning: 10 um}, contact: {friction: 0.05}}
END
cases=("$elastogear" simulate spur.yaml cases.yaml -sweep_positions 20)
"${cases[@]}" -output one.h5 >run.log 2>&1 || fail "cases on one rank"
mpirun -n 2 --oversubscribe "${cases[@]}" -output two.h5 >run.log 2>&1 || fail "cases on two ranks"
killed_at 1 rename sweep.h5 "${cases[@]}" -output cut.h5
killed_at 1 renamed sweep.h5 "${cases[@]}" -sweep_positions 21 -output cut.h5  # what has found nothing keeps no other from beginning
killed_at 2 renamed unit_ "${cases[@]}" -output cut.h5
struck term 2 rename unit_ "${cases[@]}" -output cut.h5 && fail "a stopped sweep ends as if all were well"
grep -q "stopped by signal 15.*goes on from there" run.log || fail "a stopped sweep does not say so"
grep -Eq "continued after +2 of 8 parts" run.log || fail "a sweep does not say that it continues"
"${cases[@]}" -output cut.h5 -sweep_positions 21 >run.log 2>&1 && fail "continued with other positions"
grep -q "sweep_positions 21 (was 20)" run.log || fail "the message on other positions"

# What another version of the program left is refused with the remedy.
version() { /usr/bin/python3 -c "import sys, h5py; h5py.File(sys.argv[1], 'r+').attrs['version'] += int(sys.argv[2])" "$1" "$2"; }
units=(cut.partial/unit_*.h5)
for left in cut.partial/sweep.h5 "${units[0]}"; do
  version "$left" -1
  "${cases[@]}" -output cut.h5 -resume anyway >run.log 2>&1 && fail "goes on from $left of another version"
  grep -q "$left: has version 1 .*-resume discard begins anew" run.log || { cat run.log; fail "the message on $left of another version"; }
  version "$left" 1
done
(LD_PRELOAD=$faults${LD_PRELOAD:+:$LD_PRELOAD} FAULT=full FAULT_CALL=write FAULT_FILE=$work/ FAULT_SPACE=40000 \
  ASAN_OPTIONS=${ASAN_OPTIONS:-}:verify_asan_link_order=0 exec "${cases[@]}" -output cut.h5) >run.log 2>&1 && fail "a full disk is passed over"
grep -q "no space left.*goes on from there" run.log || fail "the message on a full disk"
killed_at 1 rename case_0002 "${cases[@]}" -output cut.h5
"${cases[@]}" -output cut.h5 >run.log 2>&1 || fail "the last run"
grep -Eq "continued after +8 of 8 parts" run.log || fail "joining anew"
killed_at 1 renamed unit_ "${cases[@]}" -output other.h5 -sweep_positions 21
"${cases[@]}" -output other.h5 -resume replace >run.log 2>&1 || fail "a sweep does not take the place of another one that was killed"
grep -q "begun anew  *other.partial held a run of other input: sweep_positions 20 (was 21)" run.log || fail "a sweep does not say that it begins anew"
ls -d ./*.partial 2>/dev/null && fail "the folder of parts stays"

# Where Newton's method is given too few iterations some positions are not found.
"${sweep[@]}" -torque "300 N m" -sweep_positions 12 -snes_max_it 2 -output some.h5 >some.log 2>&1 && fail "missing positions are no error"
grep -Eq "error: no equilibrium found at [1-9][0-9]* of 12 roll angles" some.log || { cat some.log; fail "what is missing is not said"; }

/usr/bin/python3 - <<'END' || exit 1
import csv

import h5py
import numpy as np

R_B1 = 25.5e-3 * np.cos(np.radians(20))


def datasets(path):
    found = {}
    with h5py.File(path) as file:
        assert file.attrs["complete"] == 1, path
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found


def near(what, value, expected, allowed):
    worst = np.max(np.abs(np.asarray(value) - expected))
    print(f"{what}: off by {worst:.3g}, allowed {allowed:.3g}")
    assert worst <= allowed, what


for side, sign in (("drive", 1), ("coast", -1)):
    r = datasets(f"rigid_{side}.h5")
    near("roll angles", r["time"], np.arange(5) * 0.4, 1e-15)
    error = (r["bodies/pinion/rigid"][:, 0] - 2 * np.pi * r["time"] / 17 + np.pi / 2) * R_B1
    near(f"transmission error of rigid gears on the {side} side, m", error - error[0], 0, 0.2e-6)
    near("their wheel's torque over the pinion's", r["bodies/wheel/joint_force"][:, 0] / (sign * 20), 43 / 17, 2e-3)
    near("velocities", r["bodies/wheel/rigid_velocity"], 0, 0)

r = datasets("elastic.h5")
near("roll angles", r["time"], -0.2 + np.arange(18) / 18, 1e-15)
offset = r["contact/pinion:wheel/points/offset"]
force = np.linalg.norm(r["contact/pinion:wheel/points/force"], axis=1)
sums = np.array([force[a:b].sum() for a, b in zip(offset, offset[1:])])
# Where the edge of a tip bears before the path of contact begins, its normal is not that of the involute: there the sum is not T/r_b.
steepness = r["contact/pinion:wheel/points/force"][:, 1] / r["contact/pinion:wheel/points/force"][:, 0]
angle = np.degrees(np.arctan(steepness))  # of the normals with the line of centres
at_involutes = np.array([np.ptp(angle[a:b]) < 0.15 for a, b in zip(offset, offset[1:])])
assert at_involutes.sum() >= 14, at_involutes
near("sums of normal forces over T/r_b on involutes", sums[at_involutes] * R_B1 / 300, 1, 1.5e-3)
# forces of stations stand along exact normals, which turn with the flanks as these deform
near("moments of contact forces about the pinion's axis over its torque", r["contact/pinion:wheel/torque"][:, 2] / 300, 1, 1e-3)
near("energy of elastic gears against their turnover", r["energy/balance"] / (300 * 2 * np.pi / 17), 0, 2e-3)
for swept, static, i in ((r, "static.h5", 15), (datasets("bearings.h5"), "static_bearings.h5", 4)):
    s = datasets(static)
    for name in ("bodies/pinion/q", "bodies/wheel/q", "bodies/pinion/position", "bodies/pinion/rotation",
                 "bodies/wheel/rotation", "contact/pinion:wheel/force"):
        size = max(np.linalg.norm(s[name][-1]), 1e-3)
        near(f"{name} against a static analysis", swept[name][i] / size, s[name][-1] / size, 1e-6)
r = datasets("bearings.h5")
held = datasets("static_bearings.h5")["bushings/bearing_of_wheel/torque"][-1, 2]
near("the torque that holds the wheel against a static analysis", r["bushings/bearing_of_wheel/torque"][4, 2] / held, 1, 1e-3)
near("that over the pinion's", held / 300, 43 / 17, 3e-2)
near("energy of gears on bearings against their turnover", r["energy/balance"] / (300 * 2 * np.pi / 17), 0, 2e-3)

# Over a pitch what is stored comes back: the mean powers are equal. Friction has one sign in the approach and the other behind.
r = datasets("rough.h5")
power = r["contact/pinion:wheel/friction_power"]
T_2 = r["bodies/wheel/joint_force"][:, 0]
input_output = 2 * np.pi * (300 / 17 - abs(T_2.mean()) / 43)
assert 0 < T_2.min() and T_2.mean() < 300 * 43 / 17 and (power > 0).all(), (T_2, power)
near("input less output over the loss by friction", input_output / power.mean(), 1, 5e-3)
lost = r["energy/dissipated"]
near("energy of rough gears over the loss", r["energy/balance"][-1] / lost[-1], 0, 2e-2)
near("what friction has taken over the sum of its powers", lost[-1] / ((power.sum() - (power[0] + power[-1]) / 2) / 64), 1, 1e-2)

with open("one/cases.csv") as file:
    rows = list(csv.DictReader(file))
assert [row["file"] for row in rows] == [f"case_{i:04d}.h5" for i in (1, 2, 3, 4)], rows
assert [float(row["torque [N m]"]) for row in rows] == [100, 300, 100, 300], rows
assert rows[0]["wheel_lead_crowning [m]"] == "" and float(rows[2]["wheel_lead_crowning [m]"]) == 10e-6, rows
assert all(row["positions"] == "20" for row in rows)
for row in rows:
    one = datasets("one/" + row["file"])
    assert len(one["time"]) == 20 and len(one) > 40
    for other in ("two", "cut", "other"):
        found = datasets(f"{other}/{row['file']}")
        assert one.keys() == found.keys()
        different = [name for name in one if one[name].dtype != object
                     and np.asarray(one[name]).tobytes() != np.asarray(found[name]).tobytes()]
        assert not different, (other, row, different)
tilted, straight = datasets("one/case_0004.h5"), datasets("one/case_0002.h5")
assert tilted["energy/dissipated"][-1] > 0 and straight["energy/dissipated"][-1] == 0
assert (np.diff(tilted["energy/dissipated"]) > 0).all(), "energies go on from part to part"
near("energies from part to part, over what has been lost", tilted["energy/balance"] / tilted["energy/dissipated"][-1], 0, 5e-2)
END
echo "all good"
