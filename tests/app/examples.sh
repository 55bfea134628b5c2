#!/usr/bin/env bash
# The small examples give what their first lines say.
#   examples.sh PATH/TO/elastogear PATH/TO/REPOSITORY
set -euo pipefail
elastogear=$(realpath "$1")
repository=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

run() { "$elastogear" "$@" >log 2>&1 || { cat log; exit 1; }; }
# column FILE NUMBER: smallest and largest value.
range() { awk -F, -v c="$2" 'NR == 2 { low = high = $c } NR > 1 { if ($c < low) low = $c; if ($c > high) high = $c } END { print low, high }' "$1"; }

bar=$repository/examples/bar/bar.yaml
run reduce "$bar" -mesh "$repository/meshes/bar.inp"
run simulate "$bar"
run recover "$bar"
grep -Eq 'bar FIX +peak von Mises 7[89]\.' log || { cat log; echo "FAIL: not 79 MPa at the held end"; exit 1; }
range bar_run_end.csv 4 | awk '{ d = $2 - $1; print "swing of the bar", d, "m"; exit !(d > 5.95e-3 && d < 6.1e-3) }' ||
  { echo "FAIL: not 6.0 mm"; exit 1; }

beam=$repository/examples/rotating_beam/beam.yaml
run reduce "$beam" -mesh "$repository/meshes/beam.inp"
run simulate "$beam"
/usr/bin/python3 - <<'END'
import numpy as np
t, x, y = np.loadtxt("beam_run_tip.csv", delimiter=",", skiprows=1, usecols=(0, 1, 2)).T
speed, ramp = 0.3, 15.0
angle = speed / ramp * (t**2 / 2 + (ramp / (2 * np.pi))**2 * (np.cos(2 * np.pi * t / ramp) - 1))
lag = (np.sin(angle) * x - np.cos(angle) * (y - y[0]))[t < ramp]
print(f"largest lag of the beam {lag.max():.5f} m")
assert abs(lag.max() - 0.0315) < 1e-4
END
echo "all good"
