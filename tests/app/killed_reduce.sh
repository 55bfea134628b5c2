#!/usr/bin/env bash
# A reduction that is killed (SIGKILL) again and again, at chosen writes, ends in the body file of one that was not: equal
# to the bit in every dataset. It never computes a stored window a second time.
#   killed_reduce.sh PATH/TO/elastogear PATH/TO/libfaults.so
set -u
elastogear=$(realpath "$1")
faults=$(realpath "$2")
source "$(dirname "$0")/bar.sh"
source "$(dirname "$0")/faults.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAIL: $*"; exit 1; }

bar 24 4 4 0.01 0.011 0.012 >bar.inp
# A ring of 15 x 3 x 4 hexahedra around z, held on the inside; it repeats 15 times.
awk -v n=15 'function node(i, j, k) { return 1 + k + 5 * (j + 4 * (i % n)) }
  BEGIN {
    print "*NODE"; pi = atan2(0, -1);
    for (i = 0; i < n; ++i) for (j = 0; j < 4; ++j) for (k = 0; k < 5; ++k)
      printf "%d, %.15g, %.15g, %g\n", node(i, j, k), (0.03 + 0.01 * j) * cos(2 * pi * i / n),
        (0.03 + 0.01 * j) * sin(2 * pi * i / n), 0.012 * k;
    print "*ELEMENT, TYPE=C3D8, ELSET=ALL";
    for (i = 0; i < n; ++i) for (j = 0; j < 3; ++j) for (k = 0; k < 4; ++k)
      printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++e, node(i, j, k), node(i, j + 1, k), node(i + 1, j + 1, k),
        node(i + 1, j, k), node(i, j, k + 1), node(i, j + 1, k + 1), node(i + 1, j + 1, k + 1), node(i + 1, j, k + 1);
    print "*NSET, NSET=FIX";
    for (i = 0; i < n; ++i) for (k = 0; k < 5; ++k) print node(i, 0, k);
    print "*SURFACE, NAME=TOP, TYPE=ELEMENT";
    for (e = 4; e <= 12 * n; e += 4) printf "%d, S2\n", e;
  }' >ring.inp

common=(-material_E 210e9 -material_nu 0.3 -material_rho 7850 -restrain FIX -surface TOP -stress_nodes FIX)

# scenario MESH PIECE OPTION...: the pieces are called PIECE_??????.h5
scenario() {
  local mesh=$1 piece=$2 where
  shift 2
  local reduce=("$elastogear" reduce -mesh "$mesh.inp" "${common[@]}" "$@")
  "${reduce[@]}" -output whole.h5 >whole.log 2>&1 || { cat whole.log; fail "the undisturbed run"; }
  [ -e whole.h5.partial ] && fail "the folder of parts stays after a run that ended well"
  mkdir -p whole ends && mv whole.h5 "whole/$mesh.h5"

  # Killed before and after a piece takes its name, while one is written, and before the body file takes its name.
  for where in "1 write ${piece}_" "1 renamed ${piece}_" "2 rename ${piece}_" "1 rename ${piece}_" "2 renamed ${piece}_" \
    "1 write $mesh.h5.tmp" "1 rename $mesh.h5$"; do
    find "$mesh.h5.partial" -name "${piece}_*.h5" -printf '%p %i %T@\n' 2>/dev/null | sort >before.txt
    # shellcheck disable=SC2086  # several words
    killed_at $where "${reduce[@]}" -output "$mesh.h5"
    [ -e "$mesh.h5" ] && fail "killed at $where, but there is a body file"
    find "$mesh.h5.partial" -name "${piece}_*.h5" -printf '%p %i %T@\n' | sort >after.txt
    [ -z "$(comm -23 before.txt after.txt)" ] ||
      fail "a stored piece was written again: $(comm -23 before.txt after.txt)"
    echo "$mesh: killed at $where, stored pieces: $(wc -l <after.txt)"
  done
  "${reduce[@]}" -output "$mesh.h5" >run.log 2>&1 || { cat run.log; fail "a continued run"; }
  [ -s "$mesh.h5" ] || fail "no body file"
  grep -q "continued after" run.log || { cat run.log; fail "the last run does not say that it continues"; }
  mv "$mesh.h5" "ends/$mesh.h5"
  compare "whole/$mesh.h5" "ends/$mesh.h5" 200 || fail "the body files differ"
}

compare() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import sys
import h5py
import numpy as np

def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
    return found

a, b = (datasets(path) for path in sys.argv[1:3])
assert a.keys() == b.keys() and len(a) > 20, a.keys() ^ b.keys()
assert len(a["modes/eigenvalue"]) >= int(sys.argv[3])
different = [name for name in a if np.asarray(a[name]).tobytes() != np.asarray(b[name]).tobytes()
             and a[name].dtype != object]
assert not different, different
print(len(a), "datasets equal to the bit")
PYTHON
}

scenario bar window -symmetry none -modes 250 -window 20
scenario ring harmonic -modes 500

# One window with all eigenvalues, by LAPACK, and one frequency interval without an end on a body that repeats.
bar 4 1 1 0.08 0.02 0.02 >all.inp
for all in "all -modes 48" "all -modes 48 -eps_type krylovschur" "ring -eps_interval 1e12,inf"; do
  # shellcheck disable=SC2086  # several words
  set -- $all
  reduce=("$elastogear" reduce -mesh "$1.inp" "${common[@]}" -basis modal "${@:2}" -output all.h5)
  "${reduce[@]}" >run.log 2>&1 || { cat run.log; fail "$all"; }
  mv all.h5 whole/all.h5
  killed_at 1 rename "all.h5$" "${reduce[@]}"
  "${reduce[@]}" >run.log 2>&1 || { cat run.log; fail "continued with $all"; }
  grep -q "continued after" run.log || { cat run.log; fail "$all: the last run does not say that it continues"; }
  compare whole/all.h5 all.h5 1 || fail "$all: the body files differ"
  rm all.h5
done

# Parts of another reduction are not used.
reduce=("$elastogear" reduce -mesh bar.inp "${common[@]}" -symmetry none -window 20 -modes 250)
killed_at 1 renamed window_000000.h5 "${reduce[@]}" -output other.h5
"${reduce[@]}" -output other.h5 -material_E 70e9 -modes 40 >other.log 2>&1 || { cat other.log; fail "other options"; }
grep -q "discarded" other.log || { cat other.log; fail "windows of another reduction are not reported"; }
grep -q "continued after" other.log && fail "windows of another reduction were used"
echo "all good"
