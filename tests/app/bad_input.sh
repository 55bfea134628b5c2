#!/usr/bin/env bash
# Bad input: each case must end with a clear error that names file and value, a non-zero exit code and no new file.
#   bad_input.sh PATH/TO/elastogear
set -u
elastogear=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
passed=0 failed=0

# expect_error NAME 'regex' COMMAND...: the command fails by itself (no signal), says what the regex asks for, and
# leaves the folder as it was.
expect_error() {
  local name=$1 pattern=$2 before after status
  shift 2
  before=$(ls -1)
  timeout 120 "$@" >"$work.out" 2>&1
  status=$?
  after=$(ls -1)
  if ((status == 0)) || ((status >= 124)); then
    echo "FAIL $name: exit code $status"; tail -5 "$work.out"; failed=$((failed + 1))
  elif ! grep -Eq "error: .*$pattern" "$work.out"; then
    echo "FAIL $name: no message matching '$pattern'"; tail -5 "$work.out"; failed=$((failed + 1))
  elif grep -Eq 'PETSC ERROR|\(\) at |#[0-9] ' "$work.out"; then
    echo "FAIL $name: a traceback"; tail -5 "$work.out"; failed=$((failed + 1))
  elif [ "$before" != "$after" ]; then
    echo "FAIL $name: files appeared: $(comm -13 <(echo "$before") <(echo "$after"))"; failed=$((failed + 1))
  else
    echo "ok   $name: $(grep -Eo 'error: .*' "$work.out" | head -1)"; passed=$((passed + 1))
  fi
  rm -f "$work.out"
}

# A brick of n x 1 x 1 hexahedra of 10 mm as .inp; the node set FIX is the left end, the surface TOP the upper side.
brick() {
  awk -v n="$1" 'BEGIN {
    print "*NODE";
    for (i = 0; i <= n; ++i) for (k = 0; k < 4; ++k)
      printf "%d, %g, %g, %g\n", 4*i + k + 1, 0.01*i, 0.01*(k == 1 || k == 2), 0.01*(k > 1);
    print "*ELEMENT, TYPE=C3D8, ELSET=ALL";
    for (i = 0; i < n; ++i) printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", i + 1, 4*i+1, 4*i+2, 4*i+3, 4*i+4, 4*i+5, 4*i+6, 4*i+7, 4*i+8;
    print "*NSET, NSET=FIX\n1, 2, 3, 4\n*NSET, NSET=CORNER\n1\n*SURFACE, NAME=TOP, TYPE=ELEMENT";
    for (i = 0; i < n; ++i) printf "%d, S5\n", i + 1;
  }'
}
brick 3 >brick.inp
sed 's/^5, 0.01,/5, nan,/' brick.inp >nan.inp
sed 's/^2, 5, 6, 7, 8, 9, 10, 11, 12$/2, 9, 10, 11, 12, 5, 6, 7, 8/' brick.inp >inverted.inp
printf '1,1, 1,1, 1.0\n1,1, 1,2, nan\n' >k.mtx
printf '1,1, 1,1, 1.0\n17,1, 17,1, 2.0\n' >k2.mtx
reduce=("$elastogear" reduce -mesh brick.inp -material_E 210e9 -material_nu 0.3 -material_rho 7850 -restrain FIX
        -surface TOP -modes 5 -output new.h5)

# What the cases vary works when it is right.
"${reduce[@]}" -output body.h5 >good.log 2>&1 || { echo "FAIL: the good case fails"; cat good.log; exit 1; }
[ -s body.h5 ] || { echo "FAIL: the good case wrote nothing"; exit 1; }
cp body.h5 other.h5
head -c $(($(stat -c %s body.h5) / 2)) body.h5 >truncated.h5
"$elastogear" mesh -part wheel -size tiny -mesh wheel.msh >good.log 2>&1 || { echo "FAIL: mesh fails"; cat good.log; exit 1; }
head -c $(($(stat -c %s wheel.msh) / 2)) wheel.msh >truncated.msh
simulate=("$elastogear" simulate -bodies a,b -a_file body.h5 -b_file other.h5 -contact_pairs a:b -ts_dt 1e-7
          -ts_max_time 1e-6 -output new.h5)

expect_error "missing configuration" 'nosuch.yaml' "$elastogear" simulate nosuch.yaml
printf 'mesh: [1, 2\nfoo: {' >malformed.yaml
expect_error "malformed configuration" 'malformed.yaml' "$elastogear" reduce malformed.yaml
expect_error "unknown verb" "'reduse'" "$elastogear" reduse
printf 'ts_dt: 1e-7\nts: {dt: 2e-7}\n' >twice.yaml
expect_error "key given twice" 'twice.yaml, line 2: the key ts_dt is given twice, first in line 1' "$elastogear" simulate twice.yaml
printf 'mesh: brick.inp\n\nmodess: 3\n' >misspelt.yaml
expect_error "misspelt key in a file" 'modess .misspelt.yaml, line 3' "$elastogear" reduce misspelt.yaml
expect_error "missing file of options" 'nosuch.txt: there is no such file' "$elastogear" reduce -options_file nosuch.txt
printf -- '-modes 3\nmodes 4\n' >malformed.txt
expect_error "malformed file of options" "malformed.txt, line 2: 'modes' is no option" "$elastogear" reduce -options_file malformed.txt
printf -- '-modes 3\n-epss_tol 4\n' >options.txt
expect_error "misspelt option in a file of options" 'epss_tol .options.txt, line 2.*eps_tol' "$elastogear" reduce -options_file options.txt
expect_error "malformed YAML as file of options" 'malformed.yaml, line 2' "$elastogear" reduce -options_file malformed.yaml
expect_error "file of options without a name" 'options_file is given without' "$elastogear" reduce -options_file -modes 3
expect_error "malformed options in the environment" 'PETSc cannot start.*PETSC_OPTIONS' env PETSC_OPTIONS='-options_file nosuch.txt' "$elastogear" reduce
expect_error "file after the options" "'misspelt.yaml' belongs to no option" "$elastogear" reduce -modes 3 misspelt.yaml
expect_error "list with a blank" "'B' belongs to no option" "$elastogear" reduce -restrain A, B
expect_error "missing mesh" 'nosuch.msh' "${reduce[@]}" -mesh nosuch.msh
expect_error "truncated .msh" 'truncated.msh' "${reduce[@]}" -mesh truncated.msh
expect_error "unknown option" 'modess.*-modes' "${reduce[@]}" -modess 5
expect_error "swapped letters" 'mdoes.*nearest known option is -modes ' "${reduce[@]}" -mdoes 5
expect_error "missing option" 'material_nu' "$elastogear" reduce -mesh brick.inp -output new.h5 -material_E 1 -restrain FIX
expect_error "missing node set" "NOSUCH.*CORNER, FIX" "${reduce[@]}" -restrain NOSUCH
expect_error "missing face set" "NOSUCH.*TOP" "${reduce[@]}" -surface NOSUCH
expect_error "NaN option" 'material_E.*nan' "${reduce[@]}" -material_E nan
expect_error "NaN coordinate" 'nan.inp.*nan' "${reduce[@]}" -mesh nan.inp
expect_error "impossible material" 'nu.*0\.7' "${reduce[@]}" -material_nu 0.7
expect_error "inverted element" '(cell|element).*Jacobian' "${reduce[@]}" -mesh inverted.inp
expect_error "no restraint" 'restrain' "$elastogear" reduce -mesh brick.inp -material_E 210e9 -material_nu 0.3 -material_rho 7850 -surface TOP -modes 5 -output new.h5
expect_error "too little restraint" '(singular|restrain)' "${reduce[@]}" -restrain CORNER
expect_error "too many modes" 'modes.*37.*36' "${reduce[@]}" -modes 37
expect_error "modes no number" 'modes.*many' "${reduce[@]}" -modes many
expect_error "restraint of an unknown node" "no node '99'" "${reduce[@]}" -restrain_nodes 1,99
expect_error "frame at no point" 'frame.*bore' "${reduce[@]}" -frame bore
expect_error "mass without stiffness" 'mass.*needs -stiffness' "${reduce[@]}" -mass m.mtx
expect_error "missing matrix" 'nosuch.mtx' "${reduce[@]}" -stiffness nosuch.mtx -mass nosuch.mtx
expect_error "NaN in a matrix" "k.mtx, line 2: 'nan'" "${reduce[@]}" -stiffness k.mtx -mass k.mtx
expect_error "matrix of another mesh" 'k2.mtx: node 17' "${reduce[@]}" -stiffness k2.mtx -mass k2.mtx
orthotropic=("$elastogear" reduce -mesh brick.inp -material_E1 40e9 -material_E2 10e9 -material_E3 10e9 -material_nu12 0.3
             -material_nu13 0.3 -material_nu23 0.4 -material_G12 5e9 -material_G13 5e9 -material_G23 4e9 -material_rho 1900
             -restrain FIX -modes 5 -output new.h5)
"${orthotropic[@]}" -material_orientation cylindrical -material_axis 1,0,0 -output fibre.h5 >good.log 2>&1 ||
  { echo "FAIL: an orthotropic body fails"; cat good.log; exit 1; }
expect_error "impossible orthotropic material" 'nu.*not positive definite' "${orthotropic[@]}" -material_nu12 3
expect_error "orthotropic material in part" 'material_E2 is missing' "$elastogear" reduce -mesh brick.inp -material_E1 1 -material_rho 1 -output new.h5
expect_error "material axes in one line" 'parallel' "${orthotropic[@]}" -material_axis_2 2,0,0
expect_error "no material anywhere" 'material_E.*brick.inp.*SOLID SECTION' "$elastogear" reduce -mesh brick.inp -restrain FIX -output new.h5
{ sed 's/, 0\.0\([123]\),/, \10,/g; s/, 0\.0\([123]\),/, \10,/g; s/, 0\.01$/, 10/' brick.inp
  printf '*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85e-9\n*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n'
  printf '*BOUNDARY\nFIX, 1, 3\n'; } >millimetres.inp
"${reduce[@]}" >good.log 2>&1 && "$elastogear" reduce -mesh millimetres.inp -unit mm -surface TOP -modes 5 -output mm.h5 >mm.log 2>&1
diff <(grep -E "mass|frequency" good.log) <(grep -E "mass|frequency" mm.log) ||
  { echo "FAIL: a deck in mm and tonnes differs from the mesh in m with options"; cat mm.log; exit 1; }
rm -f new.h5 mm.h5
sed 's/^FIX, 1, 3/FIX, 1, 2/' millimetres.inp >partly.inp
expect_error "restraint in two directions" 'node 1 in xy only' "$elastogear" reduce -mesh partly.inp -unit mm -output new.h5
sed 's/MATERIAL=STEEL/MATERIAL=BRASS/' millimetres.inp >brass.inp
expect_error "unknown material in the mesh" "brass.inp.*unknown material 'BRASS'" "$elastogear" reduce -mesh brass.inp -output new.h5
expect_error "missing body file" 'nosuch.h5' "${simulate[@]}" -a_file nosuch.h5
expect_error "truncated body file" 'truncated.h5' "${simulate[@]}" -a_file truncated.h5
expect_error "a mesh as body file" 'wheel.msh' "${simulate[@]}" -a_file wheel.msh
expect_error "misspelt body key" 'a_jonit.*a_joint' "${simulate[@]}" -a_jonit fixed
expect_error "pair of unknown body" "'c'" "${simulate[@]}" -contact_pairs a:c
expect_error "zero step" 'ts_dt.*0' "${simulate[@]}" -ts_dt 0
expect_error "friction that never fades" 'regularised friction needs the speed' "${simulate[@]}" -contact_friction 0.1
expect_error "static friction below that of sliding" 'static friction 0.1' "${simulate[@]}" -contact_friction 0.2 \
  -contact_friction_law stick -contact_friction_static 0.1
expect_error "a gap moved out of sight" 'offset 1 m must not exceed' "${simulate[@]}" -contact_offset 1
expect_error "negative contact damping" 'damping -1' "${simulate[@]}" -contact_damping -1
expect_error "misspelt option of PETSc" 'ts_dtt.*-ts_dt ' "${simulate[@]}" -ts_dtt 1e-7
expect_error "another misspelt one" 'snes_rtoll.*-snes_rtol ' "${simulate[@]}" -snes_rtoll 1e-7
expect_error "one without a prefix that is known" 'infoo.*-info ' "${simulate[@]}" -infoo
expect_error "one of a nested solver" 'elastic_pc_tpye.*-elastic_pc_type ' "${simulate[@]}" -elastic_pc_tpye gamg
expect_error "name and value in one word" 'ts_dt=1e-8: write .* two words, -ts_dt 1e-8' "${simulate[@]}" -ts_dt=1e-8
expect_error "negative step" 'ts_dt = -1e-07' "${simulate[@]}" -ts_dt -1e-7
expect_error "no end" 'ts_max_time = 0 s: must be positive' "${simulate[@]}" -ts_max_time 0
expect_error "negative time of output" 'output_dt = -1e-07 s' "${simulate[@]}" -output_dt -1e-7
expect_error "time of output that is none" "output_times: 'soon' is neither" "${simulate[@]}" -output_times soon
expect_error "times of output that fall" '5e-08 s does not come after 1e-07 s' "${simulate[@]}" -output_times 1e-7,5e-8
printf '1e-7\n2\n' >times.txt
expect_error "time of output after the end" '2 s is outside the run' "${simulate[@]}" -output_times times.txt
expect_error "two ways to give times of output" 'exclude each other' "${simulate[@]}" -output_times 1e-7 -output_dt 1e-7
expect_error "negative tolerance" 'step tolerance -1' "${simulate[@]}" -step_tolerance -1
expect_error "negative time between checkpoints" 'between two checkpoints -1 s' "${simulate[@]}" -checkpoint_every -1
expect_error "way to resume that is none" 'resume.*auto, anyway, discard' "${simulate[@]}" -resume perhaps
expect_error "unknown analysis" 'analysis.*dynamic, static, relax' "${simulate[@]}" -analysis modal
expect_error "static without steps" 'static_steps.*at least 1' "${simulate[@]}" -analysis static -static_steps 0
expect_error "zero axis" 'axis' "${simulate[@]}" -a_joint revolute -a_axis 0,0,0
expect_error "axis of a joint without one" 'a_axis: a fixed joint has no axis' "${simulate[@]}" -a_axis 0,0,1
expect_error "bodies deep inside each other" '(deep|penetrat)' "${simulate[@]}" -b_position 0.003,0,0.004 -b_rotation 3.14159265,0,0
printf 'time,torque\n0,1\n5e-7,2\n' >short.csv
printf '0,1\n0,2\n' >twice.csv
hinged=("${simulate[@]}" -a_joint revolute)
expect_error "table that ends early" 'covers 0 .. 5e-07 s, the run needs 0 .. 1e-06 s' "${hinged[@]}" -a_torque table,short.csv
expect_error "table with equal times" 'twice.csv: table row 2: time 0 s' "${hinged[@]}" -a_torque table,twice.csv
expect_error "table that is not there" 'nosuch.csv: cannot be read' "${hinged[@]}" -a_rotation_motion table,nosuch.csv
expect_error "static motion without end" 'needs the time' "$elastogear" simulate -bodies a -a_file body.h5 -a_joint revolute \
  -a_rotation_motion speed,2 -analysis static -output new.h5
expect_error "static with an initial speed" 'no initial velocity' "${hinged[@]}" -a_omega0 1 -analysis static
expect_error "speed as a vector on a hinge" 'free or spherical' "${hinged[@]}" -a_omega0 1,2,3
expect_error "two numbers for a speed" 'a_omega0: must be one number, or three' "${hinged[@]}" -a_omega0 1,2
expect_error "initial angle of a fixed body" 'no axis to turn about' "${simulate[@]}" -a_angle0 1
expect_error "mass beside a body file" 'exclude each other' "${simulate[@]}" -a_mass 1
expect_error "torque beside a prescribed motion" 'takes no load' "${hinged[@]}" -a_torque 1 -a_rotation_motion speed,2
expect_error "force on a hinge" 'no axis to slide along' "${hinged[@]}" -a_force 1
expect_error "torque on a free body" 'no axis to turn about' "${simulate[@]}" -a_joint free -a_torque 1
expect_error "unknown prescribed motion" 'a_rotation_motion: must be .speed' "${hinged[@]}" -a_rotation_motion fast
expect_error "body without mass" 'mass 0 kg must be positive' "$elastogear" simulate -bodies a -a_mass 0 -a_inertia 1,1,1,0,0,0 \
  -ts_dt 1e-7 -ts_max_time 1e-6 -output new.h5
expect_error "inertia of no mass distribution" 'principal inertias' "$elastogear" simulate -bodies a -a_mass 1 \
  -a_inertia 1,1,3,0,0,0 -ts_dt 1e-7 -ts_max_time 1e-6 -output new.h5
expect_error "an inertia level that is none" "-inertia" "${simulate[@]}" -inertia cubic
mass=("$elastogear" simulate -bodies a -a_mass 1 -a_inertia 1,1,1,0,0,0 -a_joint free -ts_dt 1e-7 -ts_max_time 1e-6 -output new.h5)
push=("${mass[@]}" -loads push -push_marker a.frame -push_force 1,0,0)
expect_error "load on an unknown body" "push.*no body 'b'" "${push[@]}" -push_marker b.frame
expect_error "load on an unknown marker" "push.*no marker 'tip'; it has: frame" "${push[@]}" -push_marker a.tip
expect_error "load on no marker" 'push_marker.*BODY.MARKER' "${push[@]}" -push_marker tip
expect_error "load without force" 'push_force or -push_torque' "${mass[@]}" -loads push -push_marker a.frame
expect_error "load that is not finite" 'push_force.*nan' "${push[@]}" -push_force 1,nan,0
expect_error "load's table that ends early" "load 'push': the table covers 0 .. 5e-07 s" "${push[@]}" -push_signal table,short.csv
expect_error "key of a load that is not listed" 'pull_force' "${push[@]}" -pull_force 1,0,0
expect_error "load named as a body" "'a' is taken" "${mass[@]}" -loads a -a_marker a.frame
bearing=("${mass[@]}" -bushings bearing -bearing_markers ground,a.frame -bearing_stiffness 1,1,1)
expect_error "bushing with one end" 'bearing_markers: must be two' "${bearing[@]}" -bearing_markers a.frame
expect_error "bushing from ground to ground" "bearing.*must lie between" "${bearing[@]}" -bearing_markers ground,ground
expect_error "negative stiffness" "bearing.*stiffness.*-1" "${bearing[@]}" -bearing_stiffness 1,1,-1
expect_error "sensor on the ground" "sensors_s.*BODY.MARKER" "${mass[@]}" -sensors_s ground
expect_error "point without coordinates" 'a_points.*x,y,z' "${mass[@]}" -a_points tip,1,2
expect_error "two points of a name" "two markers are named 'tip'" "${mass[@]}" -a_points tip,1,2,3,tip,1,2,3
expect_error "negative damping ratio" 'damping ratio -0.1' "${reduce[@]}" -damping_ratio -0.1
expect_error "damping ratio of a full basis" 'full basis' "${reduce[@]}" -damping_ratio 0.1 -basis full
expect_error "point mass on an unknown set" 'NOSUCH' "${reduce[@]}" -point_mass_NOSUCH 1
expect_error "point mass of nothing" 'point_mass_FIX.*positive' "${reduce[@]}" -point_mass_FIX 0
expect_error "marker on an unknown set" 'NOSUCH' "${reduce[@]}" -markers NOSUCH
expect_error "marker weights that are none" 'marker_weights.*equal, area' "${reduce[@]}" -marker_weights mass
expect_error "inertia level full without its invariants" "body 'body' lacks .*-invariants full" "${simulate[@]}" -inertia full
expect_error "invariants that are none" 'invariants.*linear, full' "${reduce[@]}" -invariants all
expect_error "full invariants of a foreign matrix" "program's own mass" "${reduce[@]}" -stiffness k.mtx -mass k.mtx -invariants full
expect_error "basis that is none" 'basis.*modal_residual, full, modal_attachment, krylov, craig_bampton' "${reduce[@]}" -basis best
expect_error "attachment modes of no node" 'modal_attachment needs.*loaded' "${reduce[@]}" -basis modal_attachment
expect_error "attachment modes of an unknown set" 'NOSUCH' "${reduce[@]}" -basis modal_attachment -loaded NOSUCH
expect_error "Krylov basis of a free body" 'held body' "${reduce[@]}" -basis krylov -restrain none
# PETSc's and SLEPc's own options work.
options_of_petsc=(-ts_adapt_type none -ts_monitor -snes_rtol 1e-9 -snes_monitor -ksp_rtol 1e-6 -pc_type shell -elastic_pc_type cholesky
                  -log_view -malloc_debug -options_left -options_view -on_error_abort -memory_view -citations -no_signal_handler)
"${simulate[@]}" -ts_max_time 2e-7 -output petsc.h5 "${options_of_petsc[@]}" >good.log 2>&1 ||
  { echo "FAIL: options of PETSc are refused"; head -20 good.log; failed=$((failed + 1)); }
grep -q "TS dt 1e-07" good.log || { echo "FAIL: -ts_monitor does nothing"; failed=$((failed + 1)); }
"${reduce[@]}" -output petsc.h5 -eps_tol 1e-9 -eps_ncv 30 -st_type sinvert -st_pc_type cholesky -mat_mumps_icntl_14 30 -st_mat_mumps_icntl_14 30 \
  -eps_monitor >good.log 2>&1 || { echo "FAIL: options of SLEPc are refused"; tail -5 good.log; failed=$((failed + 1)); }
rm -f petsc.h5
expect_error "negative shift" 'krylov shift -1 Hz' "${reduce[@]}" -basis krylov -krylov_shift -1
expect_error "shift that is no number" 'krylov_shift.*high' "${reduce[@]}" -basis krylov -krylov_shift high
expect_error "more interface modes than modes" 'interface_modes = 6, must be 1..5' "${reduce[@]}" -basis craig_bampton -interface_modes 6
expect_error "no interface modes" 'interface_modes.*0' "${reduce[@]}" -basis craig_bampton -interface_modes 0
expect_error "undercut gear" "undercut" "$elastogear" mesh -part wheel -pressure_angle 8 -mesh new.msh
expect_error "centre distance that does not exist" 'centre distance' "$elastogear" mesh -part worm -centre_distance 0.02 -mesh new.msh
expect_error "missing result file" 'nosuch.h5' "$elastogear" recover -result nosuch.h5 -output new.h5 -stress_a all
"$elastogear" simulate -bodies a -a_file body.h5 -ts_dt 1e-7 -ts_max_time 3e-7 -output run.h5 >good.log 2>&1 &&
  "${reduce[@]}" -modes 7 -output seven.h5 >>good.log 2>&1 || { echo "FAIL: a good run fails"; cat good.log; exit 1; }
printf 'bodies: [a, b]\na: {file: body.h5}\nb: {file: body.h5, joint: free}\nts: {dt: 1e-7, max_time: 1e-7}\n' >two.yaml
"$elastogear" simulate two.yaml -bodies a -output run_a.h5 >good.log 2>&1 ||
  { echo "FAIL: keys of a body that is left out"; cat good.log; exit 1; }
expect_error "set without stress modes" "no stress modes at the set 'FIX'" "$elastogear" recover two.yaml -result run_a.h5 \
  -stress_a FIX -output new.h5
expect_error "key of a body that no file names" 'c_joint' "$elastogear" simulate two.yaml -bodies a -c_joint free -output new.h5
expect_error "body file of another reduction" 'seven.h5: [78] elastic coordinates, the run has [56]' "$elastogear" recover -result run.h5 \
  -a_file seven.h5 -stress_a FIX -output new.h5
expect_error "state of a missing file" 'nosuch.h5' "${hinged[@]}" -initial_file nosuch.h5
expect_error "state of another joint" "run.h5: body 'a' has 0 joint coordinates, here it has 1" "${hinged[@]}" -initial_file run.h5
expect_error "state of a joint without axis" 'joint without an axis' "${simulate[@]}" -a_joint free -initial_file run.h5
expect_error "info on a foreign file" 'good.log' "$elastogear" info good.log

echo "$passed passed, $failed failed"
((failed == 0))
