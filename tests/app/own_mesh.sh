#!/usr/bin/env bash
# A user's own mesh with surface groups of Gmsh alone, through the whole chain: face sets hold the body, carry loads and get stresses.
#   own_mesh.sh PATH/TO/elastogear
set -euo pipefail
elastogear=$(realpath "$1")
mesh=$(realpath "$(dirname "$0")/../../meshes/bar.msh")
example=$(realpath "$(dirname "$0")/../../examples/own_mesh/pull.yaml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "FAIL: $*"; exit 1; }
run() { "$@" >log 2>&1 || { cat log; fail "$*"; }; }
says() { grep -Eq "$1" log || { cat log; fail "nothing matches '$1'"; }; }

n=8  # cubes of 10 mm
cp "$mesh" bar.msh
run "$elastogear" info bar.msh
says 'left: 2' && says 'top: 16'

material=(-material_E 200e9 -material_nu 0 -material_rho 7850)
last=$((4 * n + 1))  # a node at the corner of the end
reduce=("$elastogear" reduce -mesh bar.msh -unit mm "${material[@]}" -basis full -output body.h5)
run "${reduce[@]}" -restrain left -markers right,$last -surface top -stress_nodes top,right
says 'restrained .*left: face set, 4 nodes'
says 'marker .*right: face set, 4 nodes'
says "marker .*$last: node set, 1 node\$"
run "$elastogear" info body.h5
says "marker $last: \(0.08 0 0\) m, without rotation"

# Without lateral contraction tension is uniform: sigma = F/A = 1 MPa, u = F l/(E A) = 0.4 um.
pull=("$elastogear" simulate -bodies a -a_file body.h5 -a_joint fixed -analysis static -loads pull -pull_marker a.right
      -pull_force 100,0,0 -sensors_end a.right -sensors_corner "a.$last" -sensor_csv true -output pull.h5)
run "${pull[@]}"
for sensor in end corner; do
  tail -1 pull_$sensor.csv | awk -F, -v l=0.08 -v sensor=$sensor '{ x = $2 - l }
    END { if (!(x > 0.3999e-6 && x < 0.4001e-6)) { print "FAIL: " sensor " moves by " x " m"; exit 1 } }'
done
run "$elastogear" recover -result pull.h5 -stress_a top,right -csv all -output stress.h5
run "$elastogear" info stress.h5
says 'peak von Mises: (1e\+06|999999|1000000|1\.00000e\+06)'

# The example, in which nodes held in single directions leave lateral contraction free (example.own_mesh checks its answer).
run "$elastogear" reduce "$example" -mesh bar.msh -markers "right,$last" -output body.h5
says 'restrained .*left in x: face set, 4 nodes'
says 'restrained .*1 in yz: node set, 1 node$'
run "$elastogear" info body.h5
says 'restraint: 1 node, and 1 in xy, and 2 in x$'
"${reduce[@]}" -restrain left:x >log 2>&1 && fail "a body that can slide is taken"
says 'free to move along .*, move along .*, turn about \(1 0 0\)'
"${reduce[@]}" -restrain left:q >log 2>&1 && fail "a direction that is none is taken"
says "'q' must be directions of the mesh, as in left:z"

# What is wrong is said in the mesh's words.
"${reduce[@]}" -restrain left -markers tip >log 2>&1 && fail "an unknown marker is taken"
says "no node set and no face set 'tip'; its node sets: none; its face sets: left, right, top"
"${reduce[@]}" -restrain left -markers 4711 >log 2>&1 && fail "an unknown node is taken"
says "option -markers: '4711' is no set of the mesh, and there is no node of this number"
"${pull[@]}" -pull_marker a.tip >log 2>&1 && fail "a load on an unknown marker is taken"
says "no marker 'tip'; it has: .*Reduce the body again with 'tip' in the option markers of reduce, which takes node sets, face sets"
sed '/^\$Nodes/,/^\$EndNodes/s/^20 0 10$/20 zero 10/' bar.msh >word.msh
"${reduce[@]}" -mesh word.msh -restrain left >log 2>&1 && fail "a word is taken for a coordinate"
says "word.msh, line [0-9]+.*zero"
echo "all good"
