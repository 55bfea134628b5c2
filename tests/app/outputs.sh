#!/usr/bin/env bash
# No run writes over what it reads, under whatever name, nor over what another run is writing.
#   outputs.sh PATH/TO/elastogear
set -u
elastogear=$(realpath "$1")
source "$(dirname "$0")/bar.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAIL: $*"; exit 1; }

bar 4 1 1 0.01 0.01 0.01 >bar.inp
cat >body.yaml <<'YAML'
mesh: bar.inp
material: {E: 210e9, nu: 0.3, rho: 7850}
restrain: FIX
surface: TOP
stress_nodes: FIX
modes: 3
output: body.h5
YAML
printf '0,1\n1,1\n' >load.csv
printf '1e-6\n' >times.csv
simulate=("$elastogear" simulate -bodies a -a_file body.h5 -loads push -push_marker a.frame -push_force 1,0,0 -push_signal table,load.csv
          -output_times times.csv -ts_dt 1e-6 -ts_max_time 2e-6)
recover=("$elastogear" recover -result run.h5 -stress_a FIX)
"$elastogear" reduce body.yaml >good.log 2>&1 && "${simulate[@]}" -output run.h5 >>good.log 2>&1 &&
  "${recover[@]}" -output stress.h5 >>good.log 2>&1 || { cat good.log; fail "the good case"; }
ln -s body.h5 symbolic.h5
ln body.h5 hard.h5
ln -s . here
cp stress.h5 tables_1.csv

# refused 'regex' COMMAND...: an error that says so; no file changes, none appears.
refused() {
  local pattern=$1 before after
  shift
  before=$(sum)
  "$@" >run.log 2>&1 && { cat run.log; fail "not refused: $*"; }
  grep -Eq "error: .*$pattern" run.log || { cat run.log; fail "no message '$pattern': $*"; }
  after=$(sum)
  [ "$before" == "$after" ] || fail "files changed: $*: $(diff <(echo "$before") <(echo "$after"))"
}
sum() { find . -maxdepth 1 -type f ! -name run.log -print0 | sort -z | xargs -0 md5sum; }

overwrites='would overwrite'
refused "output: $overwrites body.h5; .*a_file" "${simulate[@]}" -output body.h5
refused "output: $overwrites ./body.h5, the same file as body.h5; .*a_file" "${simulate[@]}" -output ./body.h5
for name in "$work/body.h5" symbolic.h5 hard.h5 here/body.h5; do
  refused "$overwrites $name, the same file as body.h5" "${simulate[@]}" -output "$name"
done
refused "$overwrites load.csv; .*push_signal" "${simulate[@]}" -output load.csv
refused "$overwrites times.csv; .*output_times" "${simulate[@]}" -output times.csv
refused "$overwrites run.h5; .*initial_file" "${simulate[@]}" -initial_file run.h5 -output run.h5
cp load.csv run_load.csv
refused "sensor_csv: $overwrites run_load.csv" "${simulate[@]}" -push_signal table,run_load.csv -output run.h5 -sensors_load a.frame -sensor_csv
printf -- '-ts_dt 1e-6\n' >options.txt
refused "$overwrites options.txt; this run reads its options there" "${simulate[@]}" -options_file options.txt -output options.txt
refused "output: $overwrites bar.inp; .*mesh" "$elastogear" reduce body.yaml -output bar.inp
refused "output .body.yaml, line 7.: $overwrites body.h5" "$elastogear" reduce body.yaml -mesh body.h5
refused "$overwrites body.yaml; this run reads its options there" "$elastogear" reduce body.yaml -output body.yaml
printf 'part: worm\nsize: tiny\nmesh: worm.yaml\n' >worm.yaml
refused "mesh .worm.yaml, line 3.: $overwrites worm.yaml" "$elastogear" mesh worm.yaml
refused "output: $overwrites run.h5" "${recover[@]}" -output run.h5
refused "output: $overwrites hard.h5, the same file as .*body.h5" "${recover[@]}" -output hard.h5
cp run.h5 stress_a_FIX.csv
refused "output: $overwrites stress_a_FIX.csv" "${recover[@]}" -result stress_a_FIX.csv -output stress.h5
cp run.h5 field.pvd
refused "fields: $overwrites field.pvd" "${recover[@]}" -result field.pvd -output stress.h5 -fields field
refused "output: $overwrites tables_1.csv" "$elastogear" compare tables_1.csv stress.h5 -output tables
rm run_load.csv stress_a_FIX.csv field.pvd options.txt

# Another run holds the lock of the output.
held() { refused "$1: another run writes it now" flock "$1.lock" "${@:2}"; }
touch run.h5.lock body.h5.lock stress.h5.lock worm.msh.lock
held run.h5 "${simulate[@]}" -output run.h5
held stress.h5 "${recover[@]}" -output stress.h5
held body.h5 "$elastogear" reduce body.yaml
held body.h5 mpirun -n 2 "$elastogear" reduce body.yaml
held worm.msh "$elastogear" mesh -part worm -mesh worm.msh

# A lock that nobody holds is free, and is gone after the run.
echo "process 1 on nowhere" >run.h5.lock
"${simulate[@]}" -output run.h5 >run.log 2>&1 || { cat run.log; fail "a lock that nobody holds"; }
mpirun -n 2 "$elastogear" reduce body.yaml >run.log 2>&1 || { cat run.log; fail "reduce on two ranks"; }
for name in run.h5 body.h5; do [ -e $name.lock ] && fail "$name.lock stays"; done

# Who holds it is said; killed, it holds it no longer, and the next run may go on from what it left.
endless=("$elastogear" simulate -bodies a -a_mass 1 -a_inertia 1,1,1,0,0,0 -a_joint free -a_velocity0 1,0,0 -ts_dt 1e-6
         -checkpoint_every 0 -output long.h5)
"${endless[@]}" -ts_max_time 1e6 >long.log 2>&1 &
run=$!
while kill -0 $run 2>/dev/null && [ ! -e long.h5.partial/state.h5 ]; do sleep 0.01; done
"${endless[@]}" -ts_max_time 1e6 >run.log 2>&1 && fail "a second run with the output of one that goes on"
grep -q "long.h5: another run writes it now (process $run on " run.log || { cat run.log; fail "who writes is not said"; }
[ -e long.h5.partial/state.h5 ] || fail "the second run took away what the first had"
kill -KILL $run || { cat long.log; fail "the first run ended"; }
wait $run 2>/dev/null
"${endless[@]}" -ts_max_time 3e-6 -resume discard >run.log 2>&1 || { cat run.log; fail "the output of a killed run"; }
[ -e long.h5.lock ] && fail "long.h5.lock stays"
echo "all good"
