#!/usr/bin/env bash
# A drive file serves every verb: mesh and reduce make all gears, simulate places them with flanks in touch at a roll angle,
# recover finds the stresses of their roots. Rigid perfect gears transmit without error; without friction the sum of the
# normal forces is the torque over the base radius, at any angle, on the drive and the coast side; so it is with a helix.
#   drive.sh PATH/TO/elastogear PATH/TO/examples/drives
set -euo pipefail
elastogear=$(realpath "$1")
examples=$(realpath "$2")
scripts=$(realpath "$(dirname "$0")/../../scripts")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat >spur.yaml <<'END'
drive: cylindrical
element_order: 1
module: 3 mm
face_width: 25 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 43, profile_shift: 0.1}
torque: 300 N m
modes: 10
END
run() { "$elastogear" "$@" >log 2>&1 || { cat log; exit 1; }; }
run mesh spur.yaml
grep -q "contact ratio  *1.516" log || { cat log; exit 1; }
run reduce spur.yaml

run simulate spur.yaml -roll 0.125
run recover spur.yaml
grep -q "pinion root  *peak von Mises [1-9]" log || { cat log; exit 1; }
grep -q "estimated error of the mesh [1-9].* MPa, [1-9]. %" log && grep -q "wheel root: too coarse a mesh" log || { cat log; exit 1; }
run simulate spur.yaml -roll 0.125 -side coast -output coast.h5
# Flanks do not enter each other, but where what belongs to a penalty asks for one.
run simulate spur.yaml -roll 0.125 -contact_stiffness 1e13 -output penalty.h5 -verbose
grep -q "law of contact  *penalty" log || { cat log; exit 1; }
for roll in 0 0.3 0.6 0.9; do
  run simulate spur.yaml -roll $roll -torque "20 N m" -pinion_rigid true -wheel_rigid true -static_steps 1 \
    -output rigid_$roll.h5
done

# Hexahedra of 20 nodes, whose midside nodes are on the exact flanks as well.
second=(-pinion_file second_1.h5 -wheel_file second_2.h5)
run mesh spur.yaml -element_order 2 -pinion_mesh_output second_1.msh -wheel_mesh_output second_2.msh -drawing second.svg
grep -q "elements  *2720" log && grep -q "nodes  *15776" log || { cat log; exit 1; }
run reduce spur.yaml "${second[@]}" -element_order 2 -modes 1 -store surface
run simulate spur.yaml -roll 0.125 "${second[@]}" -pinion_rigid true -wheel_rigid true -contact_law unilateral -static_steps 1 \
  -output second.h5 -verbose
grep -q "flanks of pinion  *1360 faces, nodes within [0-9.]*e-1[0-9] m" log || { cat log; exit 1; }

# At this angle points on the sides that the lines of contact cross come and go.
cat >slanted.yaml <<'END'
drive: cylindrical
element_order: 1
module: 3 mm
helix_angle: 18 deg
face_width: 25 mm
pinion: {teeth: 17, profile_shift: 0.3, file: slanted_1.h5}
wheel: {teeth: 43, profile_shift: 0.1, file: slanted_2.h5}
torque: 300 N m
modes: 10
END
run reduce slanted.yaml
run simulate slanted.yaml -roll 0.2

# Undercut cuts this pinion's flanks off close to the base circle, and the wheel's tips pass beyond their ends.
cat >undercut.yaml <<'END'
drive: cylindrical
element_order: 1
module: 3 mm
helix_angle: 27 deg
face_width: 30 mm
pinion: {teeth: 10, file: undercut_1.h5}
wheel: {teeth: 60, profile_shift: -0.2, file: undercut_2.h5}
torque: 20 N m
modes: 2
END
run reduce undercut.yaml
for roll in 0 0.3 0.6 0.9; do
  run simulate undercut.yaml -roll $roll -pinion_rigid true -wheel_rigid true -contact_law unilateral -static_steps 1 \
    -output undercut_$roll.h5
done

# Here a point of least gap passes a node of the wheel, which is open by less than a nanometre.
run reduce "$examples/spur_c14.yaml" -size tiny -element_order 1
run simulate "$examples/spur_c14.yaml" -size tiny -element_order 1 -roll 0.02 -pinion_rigid true -wheel_rigid true -contact_law unilateral \
  -static_steps 1 -output passing.h5

# The worm of one start has files of its own, since another drive's bodies bear its names.
one=(-worm_file one_1.h5 -wheel_file one_2.h5)
for example in "$examples"/*.yaml; do
  files=()
  [[ $example != */one_start_worm.yaml ]] || files=("${one[@]}")
  run reduce "$example" -size tiny -element_order 1 "${files[@]}"
  ! grep "nothing used" log || exit 1
  run simulate "$example" -size tiny -element_order 1 -roll 0.1 "${files[@]}"
  run recover "$example" -size tiny -element_order 1 "${files[@]}"
done
for roll in 0 0.3 0.6 0.9; do
  run simulate "$examples/steering_worm.yaml" -element_order 1 -roll $roll -worm_rigid true -wheel_rigid true -static_steps 1 \
    -output worm_$roll.h5
done

# An idler between two gears, and a sun that drives its ring by three planets.
cat >train.yaml <<'END'
drive: cylindrical
element_order: 1
module: 2 mm
face_width: 16 mm
gears: [first, idler, last]
first: {teeth: 20}
idler: {teeth: 25}
last: {teeth: 30}
torque: 30 N m
modes: 10
END
cat >planets.yaml <<'END'
drive: cylindrical
element_order: 1
module: 2 mm
face_width: 16 mm
gears: [sun, planet_1, planet_2, planet_3, ring]
sun: {teeth: 20}
planet_1: {teeth: 25}
planet_2: {teeth: 25, mate: sun, direction: 120}
planet_3: {teeth: 25, mate: sun, direction: 240}
ring: {teeth: 70, internal: true, mate: [planet_1, planet_2, planet_3]}
torque: 30 N m
modes: 10
END
run reduce train.yaml
run simulate train.yaml -roll 0.1
run reduce planets.yaml
run simulate planets.yaml -roll 0.35

# Wheels that the hob leaves: line contact, of either hand.
cat >left_worm.yaml <<'END'
drive: worm
element_order: 1
hand: left
module: 2 mm
diameter_quotient: 10
worm: {starts: 3, flank: ZN, file: left_1.h5}
wheel: {teeth: 41, file: left_2.h5}
face_width: 14 mm
torque: 4 N m
modes: 10
END
run reduce left_worm.yaml
run simulate left_worm.yaml -roll 0.1
for roll in 0 0.3 0.6 0.9; do
  rigid=(-roll "$roll" -worm_rigid true -wheel_rigid true -contact_law unilateral -static_steps 1)
  run simulate left_worm.yaml "${rigid[@]}" -output left_worm_$roll.h5
  run simulate "$examples/one_start_worm.yaml" -size tiny -element_order 1 "${rigid[@]}" "${one[@]}" -output one_start_worm_$roll.h5
done

PYTHONPATH=$scripts /usr/bin/python3 -B - <<'END'
import xml.etree.ElementTree

import h5py
import numpy as np
from figures import figure


def sum_of_normal_forces(path, pair=None):
    with h5py.File(path) as file:
        points = file["contact"][pair or next(iter(file["contact"]))]["points"]
        return np.linalg.norm(points["force"][points["offset"][-2]:], axis=1).sum()


def error_of_sum(path, m_n, z, T, beta):
    alpha = np.radians(20)
    alpha_t = np.arctan(np.tan(alpha) / np.cos(beta))
    beta_b = np.arcsin(np.sin(beta) * np.cos(alpha))
    r_b = m_n * z / (2 * np.cos(beta)) * np.cos(alpha_t)
    return sum_of_normal_forces(path) / (T / r_b / np.cos(beta_b)) - 1


for path, *gear in (("spur_result.h5", 3e-3, 17, 300, 0), ("coast.h5", 3e-3, 17, 300, 0),
                    ("slanted_result.h5", 3e-3, 17, 300, np.radians(18)),
                    ("second.h5", 3e-3, 17, 300, 0), ("internal_result.h5", 2e-3, 21, 60, 0)):
    figure("spur, helical and internal gears", "sum of normal forces", error_of_sum(path, *gear), 2e-3, "%")

with h5py.File("passing.h5") as file:
    (pair,), wheel = file["contact"].values(), file["bodies/wheel"]
    moment = pair["torque"][-1] - np.cross(wheel["position"][-1], pair["force"][-1])
assert abs(moment[2] / -300 - 1) < 1e-5, f"passing.h5: {moment} N m on the wheel, -300 N m is right"

r_b = 20e-3 * np.cos(np.radians(20))  # m, of the first gear and of the sun
for path, *meshes in (("train", ["first:idler"], ["idler:last"]),
                      ("planets", [f"sun:planet_{i}" for i in (1, 2, 3)], [f"planet_{i}:ring" for i in (1, 2, 3)])):
    for pairs in meshes:
        forces = [sum_of_normal_forces(f"{path}_result.h5", pair) for pair in pairs]
        assert abs(sum(forces) * r_b / 30 - 1) < 2e-3, f"{pairs}: {forces} N, {30 / r_b} N is right"

alpha_t = np.arctan(np.tan(np.radians(20)) / np.cos(np.radians(27)))
for name, teeth, r_b in (("rigid", 17, 25.5e-3 * np.cos(np.radians(20))),
                         ("undercut", 10, 15e-3 / np.cos(np.radians(27)) * np.cos(alpha_t))):
    errors = []  # m along the line of action
    for roll in (0, 0.3, 0.6, 0.9):
        with h5py.File(f"{name}_{roll}.h5") as file:
            errors.append((file["bodies/pinion/rigid"][-1, 0] - 2 * np.pi * roll / teeth + np.pi / 2) * r_b)
    assert np.abs(errors).max() < 5e-9, f"{name}: transmission error of rigid gears {errors} m"

# The drawing: of each gear its teeth and its bore across the axis, and two sections along it.
picture = xml.etree.ElementTree.parse("spur.svg")
outlines = []  # mm
for path in picture.iter("{http://www.w3.org/2000/svg}path"):
    outlines += [np.array([[float(x) for x in point.strip("LZ ").split(",")] for point in outline.split(" L")])
                 for outline in path.get("d").split("M")[1:]]
assert len(outlines) == 8, f"{len(outlines)} outlines"
for outline, diameter in zip(outlines, (18.12, 2 * 29.4, 48.84, 2 * 67.8)):
    size = np.ptp(outline, axis=0).max()
    assert 0.98 * diameter < size < diameter + 0.01, f"{size} mm drawn, {diameter} mm expected"

r_b2 = 82.029e-3 / 2  # m
errors = []
for roll in (0, 0.3, 0.6, 0.9):
    with h5py.File(f"worm_{roll}.h5") as file:
        errors.append((file["bodies/worm/rigid"][-1, 0] - np.pi * roll) / 20.5 * r_b2)
assert np.ptp(errors) < 0.2e-6, f"transmission error of a rigid worm drive {errors} m"
# A worm is pushed along its axis by T/p, whatever its flanks, and with a wheel that is conjugate the torques are as the
# teeth. Line contact of hob and worm has no transmission error.
for name, starts, r_2 in (("one_start_worm", 1, 41.2e-3), ("left_worm", 3, 42.8e-3)):
    errors = []
    for roll in (0, 0.3, 0.6, 0.9):
        with h5py.File(f"{name}_{roll}.h5") as file:
            errors.append((file["bodies/worm/rigid"][-1, 0] - 2 * np.pi * roll / starts) * starts / 41 * r_2)
    assert np.ptp(errors) < 0.2e-6, f"{name}: transmission error {errors} m"
    p = 2e-3 * starts / 2 / np.cos(np.arctan(starts / 10))  # m/rad
    with h5py.File(f"{name}_result.h5") as file:
        force = abs(file["contact/worm:wheel/force"][-1, 0])
        torque = abs(file["contact/worm:wheel/torque"][-1, 2])
    assert abs(force * p / 4 - 1) < 5e-3, f"{name}: axial force {force} N, {4 / p} N is right"
    assert abs(torque * starts / 164 - 1) < 5e-3, f"{name}: torque {torque} N m, {164 / starts} N m is right"
with h5py.File("steering_worm_result.h5") as file:
    points = file["contact/worm:wheel/points"]
    force = np.linalg.norm(points["force"][points["offset"][-2]:], axis=1).sum()
assert abs(force / 2071 - 1) < 5e-3, f"worm drive: sum of normal forces {force} N"  # N, without losses
END

echo "part: wheel" >part.yaml
cat >planets.yaml <<'END'
drive: cylindrical
element_order: 1
module: 2 mm
face_width: 8 mm
gears: [sun, planet_1, planet_2, ring]
sun: {teeth: 24}
planet_1: {teeth: 24}
planet_2: {teeth: 24, mate: sun, direction: 120 deg}
ring: {teeth: 72, internal: true, mate: [planet_1, planet_2]}
END
run mesh planets.yaml
grep -q "planet_2:ring" log || { cat log; exit 1; }

# Bodies of another drive, gears that are not there and drives that do not exist are refused.
refused() {
  if "$elastogear" "${@:2}" >log 2>&1; then echo "accepted: ${*:2}"; exit 1; fi
  grep -q "$1" log || { echo "no '$1' in:"; cat log; exit 1; }
}
refused "is not the body of pinion in this drive: .*pinion_profile_shift" simulate spur.yaml -pinion_profile_shift 0.31
refused "unknown option -pinoin_teeth" simulate spur.yaml -pinoin_teeth 18
refused "module = 3 m: .*module: 3 mm" mesh spur.yaml -module 3
refused "tip_diameter of at most" mesh spur.yaml -wheel_tip_diameter "136.9 mm"
refused "addendum: has no meaning in drive: cylindrical" mesh spur.yaml -addendum "3 mm"
refused "helix_angle: has no meaning in drive: worm" mesh "$examples/steering_worm.yaml" -helix_angle 10
refused "'ZX'" mesh "$examples/one_start_worm.yaml" -worm_flank ZX
refused "runs with form ZI alone" mesh "$examples/one_start_worm.yaml" -wheel_form helical
refused "face_width = .* m would do" mesh "$examples/one_start_worm.yaml" -face_width "25 mm"
refused "is for a drive" mesh part.yaml -helix_angle 10
refused "is for a single body" reduce spur.yaml -mesh other.msh
refused "counts are for single bodies" mesh spur.yaml -wheel_count_flank 4
refused "counts are for single bodies" reduce "$examples/steering_worm.yaml" -worm_count_turn 60
refused "element_order = '3'" mesh spur.yaml -element_order 3
# Contact forces that cancel on all of the few modes, up to roundoff, are in balance.
cat >plane.yaml <<'END'
drive: cylindrical
element_order: 1
module: 3 mm
face_width: 9 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 23}
torque: 60 N m
modes: 4
static_steps: 3
END
run reduce plane.yaml -pinion_file plane_1.h5 -wheel_file plane_2.h5
run simulate plane.yaml -pinion_file plane_1.h5 -wheel_file plane_2.h5
[ "$(awk '/Newton iterations/ { print $3 }' log)" -le 80 ] || { cat log; exit 1; }
refused "torque is missing" simulate spur.yaml -torque 0
refused "'deg' is no unit of it" mesh spur.yaml -face_width "25 deg"
refused "cutter_teeth: 25 would do" mesh "$examples/internal.yaml" -ring_cutter_teeth 71
refused "direction: 120" mesh planets.yaml -planet_2_direction "121 deg"
refused "must be a gear named before" mesh spur.yaml -wheel_mate idler
refused "tip_relief = 20000 um" mesh spur.yaml -pinion_tip_relief "20 mm"
refused "tip_relief_length" mesh spur.yaml -pinion_tip_relief "20 um" -pinion_tip_relief_length "20 mm"
refused "tooth 44 is not there" mesh spur.yaml -wheel_pitch_deviation "44, 10 um"
refused "must be pairs of a tooth" mesh spur.yaml -wheel_pitch_deviation "3"
refused "must be at most 2 deg" mesh spur.yaml -wheel_skew 3
refused "needs wheel_bearing_radial, too" simulate spur.yaml -wheel_bearing_axial "50 N/um"
refused "radial stiffness is missing of old" simulate spur.yaml -wheel_bearings old
refused "hold.* the gear along its axis" simulate spur.yaml -wheel_bearings new -new_radial "100 N/um"
refused "do not keep the gear from tilting" simulate spur.yaml -wheel_bearings a,b -a_radial 1e8 -b_radial 1e8 -a_axial 1e8
refused "needs bearing_catalogue, too" simulate spur.yaml -wheel_bearings old -old_catalogue 6205
echo "6206, 1e8, 1e7" >bearings.csv
refused "has no line of bearing '6205'" simulate spur.yaml -wheel_bearings old -old_catalogue 6205 -bearing_catalogue bearings.csv
refused "bearings.csv, line 1: must be a designation" simulate spur.yaml -wheel_bearings old -old_catalogue 6206 -bearing_catalogue bearings.csv
refused "unknown option -old_at" simulate spur.yaml -old_at 1
refused "rack_protuberance = 0.5: must be 0 to 0.2" mesh spur.yaml -rack_protuberance 0.5
refused "rack_protuberance_angle = 25 deg: must be" mesh spur.yaml -rack_protuberance 0.02 -rack_protuberance_angle 25
refused "none.csv: there is no such file" mesh spur.yaml -wheel_topography none.csv
printf 'diameter,z,height\n0.13,0,1e-6\n0.13,0,2e-6\n' >twice.csv
refused "twice.csv, line 3: this point of the flank is given twice" mesh spur.yaml -wheel_topography twice.csv
refused "unknown option -pinion_middle_tip_relief" mesh spur.yaml -pinion_middle_tip_relief "1 um"
