#!/usr/bin/env bash
# An example gives what its first lines say.
#   examples.sh PATH/TO/elastogear PATH/TO/REPOSITORY bar|rotating_beam|hertz|own_mesh
set -euo pipefail
elastogear=$(realpath "$1")
examples=$(realpath "$2")/examples
meshes=$(realpath "$2")/meshes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "FAIL: $*"; exit 1; }
run() { "$elastogear" "$@" >log 2>&1 || { cat log; exit 1; }; }
says() { grep -Eq "$1" log || { cat log; fail "nothing matches '$1'"; }; }
# range FILE COLUMN: smallest and largest value.
range() { awk -F, -v c="$2" 'NR == 2 { low = high = $c } NR > 1 { if ($c < low) low = $c; if ($c > high) high = $c } END { print low, high }' "$1"; }

bar() {
  run reduce "$examples/bar/bar.yaml" -mesh "$meshes/bar.inp"
  run simulate "$examples/bar/bar.yaml"
  run recover "$examples/bar/bar.yaml"
  says 'bar FIX +peak von Mises 7[89]\.'
  range bar_run_end.csv 4 | awk '{ d = $2 - $1; print "swing of the bar", d, "m"; exit !(d > 5.95e-3 && d < 6.1e-3) }' || fail "not 6.0 mm"
}

rotating_beam() {
  run reduce "$examples/rotating_beam/beam.yaml" -mesh "$meshes/beam.inp"
  run simulate "$examples/rotating_beam/beam.yaml"
  /usr/bin/python3 - <<'END'
import numpy as np
t, x, y = np.loadtxt("beam_run_tip.csv", delimiter=",", skiprows=1, usecols=(0, 1, 2)).T
speed, ramp = 0.3, 15.0
angle = speed / ramp * (t**2 / 2 + (ramp / (2 * np.pi))**2 * (np.cos(2 * np.pi * t / ramp) - 1))
lag = (np.sin(angle) * x - np.cos(angle) * (y - y[0]))[t < ramp]
print(f"largest lag of the beam {lag.max():.5f} m")
assert abs(lag.max() - 0.0315) < 1e-4
END
}

hertz() {
  run reduce "$examples/hertz/plate.yaml" -mesh "$meshes/bar.inp"
  run reduce "$examples/hertz/hertz.yaml" -mesh "$meshes/roller.inp"
  run simulate "$examples/hertz/hertz.yaml"
  says 'peak force 136\.1 N'
  awk '/penetration/ { p = 1e17 * $(NF - 1) / 1e9; print "pressure over that of Hertz", p; exit !(p > 0.98 && p < 1.02) }' log || fail "not 1000 MPa"
  run recover "$examples/hertz/hertz.yaml"
  awk '/peak von Mises/ { s = $6 / 558; print "von Mises stress over that of Hertz", s; exit !(s > 0.98 && s < 1.02) }' log || fail "not 558 MPa"
}

own_mesh() {
  run reduce "$examples/own_mesh/pull.yaml" -mesh "$meshes/bar.msh"
  run simulate "$examples/own_mesh/pull.yaml"
  tail -1 pull_end.csv | awk -F, '{ x = $2 - 0.08; print "elongation", x, "m"; exit !(x > 0.3999e-6 && x < 0.4001e-6) }' || fail "not 0.4 um"
  run recover "$examples/own_mesh/pull.yaml"
  says 'bar top +peak von Mises 1 MPa'
}

"$3"
echo "all good"
