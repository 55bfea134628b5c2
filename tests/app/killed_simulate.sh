#!/usr/bin/env bash
# A simulation that is killed (SIGKILL) 20 times at chosen writes, and once asked to stop (SIGTERM), ends in the result file
# of one that was not: equal to the bit in every dataset. A kill loses no more than the work since the last checkpoint.
#   killed_simulate.sh PATH/TO/elastogear PATH/TO/libfaults.so
set -u
elastogear=$(realpath "$1")
faults=$(realpath "$2")
source "$(dirname "$0")/bar.sh"
source "$(dirname "$0")/faults.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAIL: $*"; exit 1; }

# A brick of 4 x 2 x 2 hexahedra of 10 mm, held at its left end FIX; surface TOP.
bar 4 2 2 0.01 0.01 0.01 >brick.inp
"$elastogear" reduce -mesh brick.inp -material_E 2e9 -material_nu 0.3 -material_rho 1200 -restrain FIX -surface TOP \
  -modes 20 -output body.h5 >reduce.log 2>&1 || { cat reduce.log; fail "the body"; }

# One brick held, one that falls on it upside down, slides and bounces, and a rigid one that tumbles in a bushing, pushed by
# a couple that turns with it.
simulate=("$elastogear" simulate -bodies low,high,top -low_file body.h5 -high_file body.h5 -high_joint free
          -high_position 0.005,0.021,0.0402 -high_rotation 3.14159265,0,0 -high_velocity0 0.3,0,-1 -high_omega0 4,1,2
          -top_mass 1 -top_inertia 1,2,3,0,0,0 -top_joint free -top_omega0 0.1,300,0.1
          -bushings mount -mount_markers ground,top.frame -mount_stiffness 1e4,2e4,3e4 -mount_damping 1,2,3
          -mount_rotational_stiffness 10,20,0 -loads push -push_marker top.frame -push_torque 0,0,30 -push_frame body -sensors_eye top.frame
          -contact_pairs high:low -contact_friction 0.3 -contact_friction_law stick -contact_two_pass -contact_skin 2e-5 -gravity 0,0,-9.81
          -ts_dt 2e-6 -ts_max_time 1.5e-3 -output_every 3)
"${simulate[@]}" -output whole.h5 -checkpoint_every 1000 >whole.log 2>&1 || { cat whole.log; fail "the undisturbed run"; }
[ -e whole.h5.partial ] && fail "the folder of parts stays after a run that ended well"

compare() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import sys
import h5py
import numpy as np

def datasets(path):
    found = {}
    with h5py.File(path) as file:
        assert file.attrs["complete"] == 1, path
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found

a, b = (datasets(path) for path in sys.argv[1:])
assert a.keys() == b.keys() and len(a) > 40, a.keys() ^ b.keys()
assert a["contact/high:low/count"].max() > 3
assert abs(a["bushings/mount/torque"]).max() > 1 and a["energy/work"][-1] > 1e-3
different = [name for name in a if a[name].dtype != object
             and (a[name].shape != b[name].shape or np.asarray(a[name]).tobytes() != np.asarray(b[name]).tobytes())]
assert not different, different
print(len(a), "datasets equal to the bit,", len(a["time"]), "times")
PYTHON
}

# Asked to stop, the run leaves what it has.
struck term 1 renamed state.h5 "${simulate[@]}" -output cut.h5 -checkpoint_every 0 && fail "a stopped run ends as if all were well"
grep -q "stopped by signal 15" run.log || { cat run.log; fail "a stopped run does not say so"; }
"$elastogear" info cut.h5 >info.log 2>&1 || { cat info.log; fail "info on the result of a stopped run"; }
grep -q "incomplete" info.log || { cat info.log; fail "the result of a stopped run is not called incomplete"; }

rm cut.h5

# Each step ends in a checkpoint: its part is written and renamed, then its state.
reached=0
for ((kills = 0; kills < 20; ++kills)); do
  nth=$((5 + 7 * kills % 11))
  case $((kills % 5)) in
    0) where="renamed state.h5" ;;
    1) where="rename state.h5" ;;
    2) where="rename part_" ;;
    3) where="renamed part_" ;;
    4) where="write state.h5.tmp" nth=$((10 * nth)) ;;
  esac
  ((kills < 19)) || where="rename /result.h5$" nth=1 # the whole run is there, its result not yet
  # shellcheck disable=SC2086  # two words
  killed_at "$nth" $where "${simulate[@]}" -output cut.h5 -checkpoint_every 0
  [ -e cut.h5 ] && fail "a result appears although the run was killed"
  now=$(grep -Eo 'continued after +[0-9.e+-]+' run.log | grep -Eo '[0-9.e+-]+$')
  [ -n "$now" ] || { cat run.log; fail "a run does not say that it continues"; }
  awk -v a="$reached" -v b="$now" -v first=$kills 'BEGIN { exit !(first == 0 ? b + 0 >= 0 : b + 0 > a + 0) }' ||
    fail "killed at call $nth of $where: went from $reached s to $now s only"
  reached=$now
done

# Other input is refused and named, and nothing is lost by asking.
"${simulate[@]}" -output cut.h5 -ts_dt 1e-6 >run.log 2>&1 && fail "continued with another step"
grep -Eq "error: .*ts_dt 1e-6 \(was 2e-6\)" run.log || { cat run.log; fail "the message on another step"; }

# Options of other verbs, as a shared file has them, are no other input.
"${simulate[@]}" -output cut.h5 -recover_stress_low FIX -recover_csv all >run.log 2>&1 || { cat run.log; fail "the last run"; }
[ -e cut.h5.partial ] && fail "the folder of parts stays"
echo "killed 20 times, the last time in a run that continued after $reached s"
compare whole.h5 cut.h5 || fail "the result files differ"

# A step that cannot be solved: the last good state is in the file, and a run with other options goes on from it.
"${simulate[@]}" -output deep.h5 -contact_depth 2e-5 >run.log 2>&1 && fail "penetrates by more than the contact depth"
grep -Eq "error: .*nearly the contact depth.*Try a smaller time step \(-ts_dt\), numerical damping.*The result until t = .* is in deep.h5" run.log ||
  { cat run.log; fail "the message on a step that cannot be solved"; }
"$elastogear" info deep.h5 | grep -q "incomplete" || fail "the result of a failed run is not called incomplete"
"${simulate[@]}" -output deep.h5 -contact_depth 1e-3 >run.log 2>&1 && fail "continued with another depth unasked"
"${simulate[@]}" -output deep.h5 -contact_depth 1e-3 -resume anyway >run.log 2>&1 || { cat run.log; fail "another depth"; }
grep -q "warning .*contact_depth 1e-3 (was 2e-5)" run.log || { cat run.log; fail "no warning on the other depth"; }
"$elastogear" info deep.h5 | grep -q "incomplete" && fail "a result that was completed is called incomplete"
echo "all good"
