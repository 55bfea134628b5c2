#!/usr/bin/env bash
# A reduction that is killed (SIGKILL) again and again, at moments that differ, ends in the body file of one that
# was not: equal to the bit in every dataset. It never computes a stored window a second time.
#   killed_reduce.sh PATH/TO/elastogear
set -u
elastogear=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAIL: $*"; exit 1; }

# A bar of n x 4 x 4 hexahedra as .inp, held at its left end FIX; surface TOP.
awk -v n=24 'function node(i, j, k) { return 1 + k + 5 * (j + 5 * i) }
  BEGIN {
    print "*NODE";
    for (i = 0; i <= n; ++i) for (j = 0; j < 5; ++j) for (k = 0; k < 5; ++k)
      printf "%d, %g, %g, %g\n", node(i, j, k), 0.01 * i, 0.011 * j, 0.012 * k;
    print "*ELEMENT, TYPE=C3D8, ELSET=ALL";
    for (i = 0; i < n; ++i) for (j = 0; j < 4; ++j) for (k = 0; k < 4; ++k)
      printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
        node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1);
    print "*NSET, NSET=FIX";
    for (m = 1; m <= 25; ++m) print m;
    print "*SURFACE, NAME=TOP, TYPE=ELEMENT";
    for (e = 4; e <= 16 * n; e += 4) printf "%d, S2\n", e;
  }' >bar.inp
reduce=("$elastogear" reduce -mesh bar.inp -material_E 210e9 -material_nu 0.3 -material_rho 7850 -restrain FIX
        -surface TOP -stress_nodes FIX -modes 250 -window 20)

"${reduce[@]}" -output whole.h5 >whole.log 2>&1 || { cat whole.log; fail "the undisturbed run"; }
[ -e whole.h5.partial ] && fail "the folder of parts stays after a run that ended well"
mkdir whole && mv whole.h5 whole/bar.h5

# Killed as soon as one more window than before is stored and a random moment has passed.
RANDOM=1
stored() { find bar.h5.partial -name 'window_??????.h5' 2>/dev/null | wc -l; }
kills=0
for ((round = 0; round < 60; ++round)); do
  before=$(stored)
  find bar.h5.partial -name 'window_*.h5' -printf '%p %i %T@\n' 2>/dev/null | sort >before.txt
  "${reduce[@]}" -output bar.h5 >bar.log 2>&1 &
  run=$!
  while kill -0 $run 2>/dev/null && (($(stored) == before)); do sleep 0.01; done
  sleep "0.0$((RANDOM % 10))"
  if ! kill -KILL $run 2>/dev/null; then
    wait $run || { cat bar.log; fail "a continued run"; }
    break
  fi
  wait $run 2>/dev/null
  kills=$((kills + 1))
  [ -e bar.h5 ] && break
  find bar.h5.partial -name 'window_*.h5' -printf '%p %i %T@\n' | sort >after.txt
  [ -z "$(comm -23 before.txt after.txt)" ] || fail "a stored window was written again: $(comm -23 before.txt after.txt)"
done
echo "killed $kills times"
((kills >= 3)) || fail "killed $kills times only: the test is too fast or the windows are too large"
[ -s bar.h5 ] || fail "no body file after $round runs"
[ -e bar.h5.partial ] && [ -n "$(ls bar.h5.partial)" ] && ! [ -s bar.h5 ] && fail "parts stay"
grep -q "continued after" bar.log || { cat bar.log; fail "the last run does not say that it continues"; }
mkdir -p ends && mv bar.h5 ends/bar.h5

/usr/bin/python3 - whole/bar.h5 ends/bar.h5 <<'PYTHON' || fail "the body files differ"
import sys
import h5py
import numpy as np

def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found

a, b = (datasets(path) for path in sys.argv[1:])
assert a.keys() == b.keys() and len(a) > 20, a.keys() ^ b.keys()
assert len(a["modes/eigenvalue"]) >= 250
different = [name for name in a if np.asarray(a[name]).tobytes() != np.asarray(b[name]).tobytes()
             and a[name].dtype != object]
assert not different, different
print(len(a), "datasets equal to the bit")
PYTHON

# Parts of another reduction are not used.
("${reduce[@]}" -output other.h5 >other.log 2>&1 & run=$!
 while kill -0 $run 2>/dev/null && ! ls other.h5.partial/window_000000.h5 >/dev/null 2>&1; do sleep 0.01; done
 kill -KILL $run)
"${reduce[@]}" -output other.h5 -material_E 70e9 -modes 40 >other.log 2>&1 || { cat other.log; fail "other options"; }
grep -q "discarded" other.log || { cat other.log; fail "windows of another reduction are not reported"; }
grep -q "continued after" other.log && fail "windows of another reduction were used"
echo "all good"
