#!/usr/bin/env bash
# A load step whose first trial is refused is cut or ends the run; it is never taken for balanced. Two equal rollers whose nodes
# just touch are pressed together; the first load step begins with a trial whose contact forces do not settle.
#   refused_trial.sh PATH/TO/elastogear PATH/TO/REPOSITORY
set -euo pipefail
elastogear=$(realpath "$1")
repository=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$elastogear" reduce "$repository/examples/hertz/hertz.yaml" -mesh "$repository/meshes/roller.inp" >log 2>&1 || { cat log; exit 1; }
if "$elastogear" simulate -bodies lower,upper -lower_file roller.h5 -upper_file roller.h5 -upper_rotation 3.14159265358979,0,0 \
  -upper_joint prismatic -upper_axis 0,0,1 -upper_force 136.1 -contact_pairs lower:upper -analysis static -output two.h5 >log 2>&1; then
  grep -q 'peak force 136.1 N' log || { cat log; echo "FAIL: a state without balance is called an equilibrium"; exit 1; }
else
  grep -q 'no equilibrium' log || { cat log; echo "FAIL: the run does not say why it ends"; exit 1; }
fi
echo "all good"
