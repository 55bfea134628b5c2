#!/usr/bin/env bash
# The impact example through the program's verbs, at two step sizes: the peak contact force differs by less than 2 %,
# and the energy balance closes to 1 %. compare says where two runs have different laws of contact.
#   impact_step_size.sh PATH/TO/elastogear PATH/TO/examples/worm_gear
set -euo pipefail
elastogear=$(realpath "$1")
example=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# figure FILE 'words before the number'
figure() { "$elastogear" info "$1" | sed -nE "s/.*$2 ([0-9.eE+-]+).*/\1/p" | head -1; }

for body in worm wheel; do
  "$elastogear" mesh "$example/$body.yaml" >mesh.log
  "$elastogear" reduce "$example/$body.yaml" >reduce.log 2>&1
done
"$elastogear" simulate "$example/impact.yaml" -output whole.h5 >whole.log 2>&1
"$elastogear" simulate "$example/impact.yaml" -ts_dt 0.25e-6 -output half.h5 >half.log 2>&1
"$elastogear" recover "$example/impact.yaml" -result whole.h5 -output stress.h5 >recover.log
[ -s stress.h5 ] && [ -s stress_worm_root.csv ] && [ -s whole_worm.vtu ]

awk -v whole="$(figure whole.h5 'peak force:')" -v half="$(figure half.h5 'peak force:')" \
    -v start="$(figure whole.h5 'energy at the start:')" -v off="$(figure whole.h5 'energy balance: at most')" 'BEGIN {
  printf "peak force %s N, with half the step %s N: %.2g %% apart\n", whole, half, 100 * (whole / half - 1)
  printf "energy at the start %s J, balance off by %s J\n", start, off
  apart = whole / half - 1
  exit !(whole > 0 && half > 0 && apart < 0.02 && apart > -0.02 && start > 0 && off < 0.01 * start)
}'

"$elastogear" simulate "$example/impact.yaml" -contact_law penalty -output penalty.h5 >penalty.log 2>&1
"$elastogear" compare penalty.h5 whole.h5 >laws
grep -q 'law of contact is penalty, that of the reference unilateral' laws || { echo "FAIL: no word of laws"; cat laws; exit 1; }
"$elastogear" compare half.h5 whole.h5 >laws
! grep -q 'law of contact' laws || { echo "FAIL: one law is taken for two"; cat laws; exit 1; }
