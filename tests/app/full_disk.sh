#!/usr/bin/env bash
# A disk that fills after any number of bytes ends reduce, simulate and recover with an error that says so and no signal; the
# file of an earlier run stays as it was, and the same command, given again when there is room, ends in the same file to the bit.
#   full_disk.sh PATH/TO/elastogear PATH/TO/libfaults.so
set -u
elastogear=$(realpath "$1")
faults=$(realpath "$2")
source "$(dirname "$0")/bar.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { cat run.log; echo "FAIL: $*"; exit 1; }

bar 4 1 1 0.01 0.01 0.01 >bar.inp
reduce=("$elastogear" reduce -mesh bar.inp -material_E 2e9 -material_nu 0.3 -material_rho 1200 -restrain FIX -surface TOP
        -stress_nodes FIX -modes 6)
simulate=("$elastogear" simulate -bodies low -low_file body.h5 -gravity 0,0,-9.81 -ts_dt 1e-5 -ts_max_time 6e-5 -checkpoint_every 0)
recover=("$elastogear" recover -result whole_result.h5 -stress_low FIX)
"${reduce[@]}" -output body.h5 >run.log 2>&1 || fail "the body"

# full BYTES COMMAND...: with room for that many bytes in files of this folder.
full() {
  local space=$1
  shift
  (LD_PRELOAD=$faults${LD_PRELOAD:+:$LD_PRELOAD} FAULT=full FAULT_CALL=write FAULT_FILE=$work/ FAULT_SPACE=$space \
    ASAN_OPTIONS=${ASAN_OPTIONS:-}:verify_asan_link_order=0 exec "$@") >run.out 2>run.log
}

same() {
  /usr/bin/python3 - "$@" <<'PYTHON'
import sys
import h5py
import numpy as np

def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: np.asarray(item[()]).tobytes()}) if isinstance(item, h5py.Dataset) else None)
    return found

a, b = (datasets(path) for path in sys.argv[1:])
assert len(a) > 3 and a == b, [name for name in a.keys() | b.keys() if a.get(name) != b.get(name)]
PYTHON
}

# sweep NAME COMMAND...: with more and more room, until there is enough.
sweep() {
  local name=$1 failures=0 status space
  shift
  "$@" -output "whole_$name.h5" >run.log 2>&1 || fail "the undisturbed $name"
  echo old | tee old >"$name.h5"
  for ((space = 1; ; space = space * 3 / 2 + 700)); do
    status=0
    full "$space" "$@" -output "$name.h5" || status=$?
    ((status == 0)) && break
    ((status < 128)) || fail "$name with $space bytes of room ends with signal $((status - 128))"
    grep -q "error: .*$name.*no space left" run.log || fail "$name with $space bytes of room does not say why it ends"
    # Old, or new and whole: recover writes tables after it.
    cmp -s old "$name.h5" || same "whole_$name.h5" "$name.h5" || fail "$name with $space bytes of room spoils the old file"
    ls "$name".h5.tmp* >/dev/null 2>&1 && fail "$name with $space bytes of room leaves a temporary file"
    ((++failures))
    if ((failures % 3 == 0)); then
      "$@" -output "$name.h5" >run.log 2>&1 || fail "$name again, after $space bytes of room"
      same "whole_$name.h5" "$name.h5" || fail "$name differs after $space bytes of room"
      echo old >"$name.h5"
    fi
  done
  ((failures >= 4)) || fail "$name: $failures full disks only"
  same "whole_$name.h5" "$name.h5" || fail "$name differs"
  echo "$name: $failures full disks"
}
sweep result "${simulate[@]}"
sweep stress "${recover[@]}"
sweep body "${reduce[@]}"
echo "all good"
