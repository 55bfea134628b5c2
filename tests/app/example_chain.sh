#!/usr/bin/env bash
# scripts/example from mesh to tables, scripts/paper from there to a page: the turn-in at size tiny. Torque and
# geometry set the contact force, so the reduced bodies have it right within 2 % (the place of contact differs a little); the stress at the worm's root comes nearer with more modes,
# also under the contact forces of the unreduced bodies (studies/same_forces.py). The studies of estimates and deviations take the
# runs as they are.
#   example_chain.sh PATH/TO/elastogear PATH/TO/REPOSITORY
set -euo pipefail
elastogear=$(realpath "$1")
repository=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
/usr/bin/python3 -B "$repository/scripts/example" turn_in --size tiny --bases modal --law penalty --modes 10,60 --elastogear "$elastogear" --out "$work" >"$work/out" 2>&1 ||
  { tail -20 "$work/out"; exit 1; }
/usr/bin/python3 -B "$repository/scripts/paper" --page --output "$work" >"$work/out" 2>&1 || { tail -20 "$work/out"; exit 1; }
cd "$work/turn_in"
awk -F, '$1 == "force worm:wheel [N]" { print "force:", $0; good = $4 < 2 } END { exit !good }' modal_60_against_full_result_1.csv
von_mises() { awk -F, '/^worm root all/ { print $8 }' "modal_$1_against_full_stress_1.csv"; }
echo "von Mises stress of the worm's root: $(von_mises 10) % off with 10 modes, $(von_mises 60) % with 60"
awk -v few="$(von_mises 10)" -v many="$(von_mises 60)" 'BEGIN { exit !(many < few) }'
/usr/bin/python3 -B "$repository/studies/same_forces.py" "$work" --modes 10 60 --figure "$work/same_forces.svg" >"$work/out" 2>&1 ||
  { tail -20 "$work/out"; exit 1; }
equal_forces() { awk -F' *[|] *' -v modes="$1" '$2 == "worm root" && $3 == modes { print $7 }' "$work/out"; }
echo "under equal forces: $(equal_forces 10) % off with 10 modes, $(equal_forces 60) % with 60"
awk -v few="$(equal_forces 10)" -v many="$(equal_forces 60)" 'BEGIN { exit !(many < few) }'
[ -s "$work/same_forces.svg" ] || { echo "FAIL: no figure of equal forces"; exit 1; }
study() { /usr/bin/python3 -B "$repository/studies/$1.py" "${@:2}" >"$work/out" 2>&1 || { tail -20 "$work/out"; exit 1; }; }
study estimates "$work/turn_in" --modes 10 60
grep -q '^| all | 8 |' "$work/out" || { echo "FAIL: no table of 8 estimates"; cat "$work/out"; exit 1; }
study deviations "$work/turn_in"
grep -q '^| simulate_full |' "$work/out" || { echo "FAIL: no times of the runs"; cat "$work/out"; exit 1; }
for part in "worm root node [0-9]*, 60 modes" "paper, worm node 9391, 1000 modes" "revision" "Not computed: results in impact"; do
  grep -q "$part" ../paper.html || { echo "FAIL: the page lacks '$part'"; exit 1; }
done
grep -q 'src="http' ../paper.html && { echo "FAIL: the page is not self-contained"; exit 1; }
echo "all good"
