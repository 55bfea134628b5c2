#!/usr/bin/env bash
# A user's own mesh with surface groups of Gmsh alone, through the whole chain: face sets hold the body, carry loads and get stresses.
#   own_mesh.sh PATH/TO/elastogear
set -euo pipefail
elastogear=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "FAIL: $*"; exit 1; }
run() { "$@" >log 2>&1 || { cat log; fail "$*"; }; }
says() { grep -Eq "$1" log || { cat log; fail "nothing matches '$1'"; }; }

# tetrahedra N: a bar of N cubes of 10 mm, each of six tetrahedra, along x, as MSH 4.1 in mm with the physical surfaces
# left (x = 0), right and top.
tetrahedra() {
  awk -v n="$1" '
    function node(i, j, k) { return 1 + k + 2 * (j + 2 * i) }
    function corner(i, axes, m,   x) { split("0 0 0", x, " "); while (m > 0) x[substr(axes, m--, 1)] = 1; return node(i + x[1], x[2], x[3]) }
    function triangle(group, a, b, c) { side[group, ++count[group]] = a " " b " " c }
    BEGIN {
      split("123 231 312 132 213 321", order, " ");
      for (i = 0; i < n; ++i) for (p = 1; p <= 6; ++p) {
        for (m = 0; m < 4; ++m) t[m] = corner(i, order[p], m);
        tet[++tets] = p <= 3 ? t[0] " " t[1] " " t[2] " " t[3] : t[0] " " t[2] " " t[1] " " t[3];
        first = substr(order[p], 1, 1); last = substr(order[p], 3, 1);
        if (i == 0 && last == 1) triangle(1, t[0], t[1], t[2]);
        if (i == n - 1 && first == 1) triangle(2, t[1], t[2], t[3]);
        if (first == 3) triangle(3, t[1], t[2], t[3]);
      }
      print "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n2 1 \"left\"\n2 2 \"right\"\n2 3 \"top\"\n3 4 \"body\"\n$EndPhysicalNames";
      print "$Entities\n0 0 3 1";
      for (g = 1; g <= 3; ++g) print g, "0 0 0 1 1 1 1", g, 0;
      print "1 0 0 0 1 1 1 1 4 0\n$EndEntities\n$Nodes";
      print 1, 4 * (n + 1), 1, 4 * (n + 1) "\n3 1 0", 4 * (n + 1);
      for (m = 1; m <= 4 * (n + 1); ++m) print m;
      for (i = 0; i <= n; ++i) for (j = 0; j < 2; ++j) for (k = 0; k < 2; ++k) print 10 * i, 10 * j, 10 * k;
      all = tets + count[1] + count[2] + count[3];
      print "$EndNodes\n$Elements\n4", all, 1, all;
      for (g = 1; g <= 3; ++g) { print 2, g, 2, count[g]; for (m = 1; m <= count[g]; ++m) print ++e, side[g, m] }
      print 3, 1, 4, tets; for (m = 1; m <= tets; ++m) print ++e, tet[m];
      print "$EndElements";
    }'
}
n=8
tetrahedra $n >bar.msh
run "$elastogear" info bar.msh
says 'left: 2' && says 'top: 16'

material=(-material_E 200e9 -material_nu 0 -material_rho 7850)
last=$((4 * n + 1))  # a node at the corner of the end
reduce=("$elastogear" reduce -mesh bar.msh -unit mm "${material[@]}" -basis full -output body.h5)
run "${reduce[@]}" -restrain left -markers right,$last -marker_weights area -surface top -stress_nodes top,right
says 'restrained .*left: face set, 4 nodes'
says 'marker .*right: face set, 4 nodes'
says "marker .*$last: node set, 1 node\$"
run "$elastogear" info body.h5
says "marker $last: \(0.08 0 0\) m, without rotation"

# Without lateral contraction tension is uniform: sigma = F/A = 1 MPa, u = F l/(E A) = 0.4 um.
pull=("$elastogear" simulate -bodies a -a_file body.h5 -a_joint fixed -analysis static -loads pull -pull_marker a.right
      -pull_force 100,0,0 -sensors_end a.right -sensors_corner a.$last -sensor_csv true -output pull.h5)
run "${pull[@]}"
for sensor in end corner; do
  tail -1 pull_$sensor.csv | awk -F, -v l=0.08 -v sensor=$sensor '{ x = $2 - l }
    END { if (!(x > 0.3999e-6 && x < 0.4001e-6)) { print "FAIL: " sensor " moves by " x " m"; exit 1 } }'
done
run "$elastogear" recover -result pull.h5 -stress_a top,right -csv all -output stress.h5
run "$elastogear" info stress.h5
says 'peak von Mises: (1e\+06|999999|1000000|1\.00000e\+06)'

# The same with lateral contraction, which nodes held in single directions leave free.
printf 'restrain: [left:x, 1:yz, 2:y]\nmarkers: [right, %d]\nmarker_weights: area\n' $last >held.yaml
run "$elastogear" reduce held.yaml "${reduce[@]:2}" -material_nu 0.3 -stress_nodes top
says 'restrained .*left in x: face set, 4 nodes'
says 'restrained .*1 in yz: node set, 1 node$'
run "$elastogear" info body.h5
says 'restraint: 1 node, and 1 in xy, and 2 in x$'
run "${pull[@]}"
tail -1 pull_end.csv | awk -F, '{ x = $2 - 0.08 } END { if (!(x > 0.3999e-6 && x < 0.4001e-6)) { print "FAIL: contraction is held: " x " m"; exit 1 } }'
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
