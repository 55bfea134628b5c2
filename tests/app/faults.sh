# shellcheck shell=bash
# Ends a program at a call of its own choosing (tests/faults/faults.c).

# struck FAULT NTH CALL FILE COMMAND...: the command's exit code, its output in run.log; FAULT (kill, term) strikes at the
# NTH CALL (write, rename: before it, renamed: after it) on files whose path holds FILE. `faults` is the library's path.
struck() {
  local what=$1 nth=$2 call=$3 file=$4 status=0
  shift 4
  rm -f struck.log
  # The sanitizers' library need not come first.
  (LD_PRELOAD=${faults:?}${LD_PRELOAD:+:$LD_PRELOAD} FAULT=$what FAULT_AT=$nth FAULT_CALL=$call FAULT_FILE=$file FAULT_LOG=$PWD/struck.log \
    ASAN_OPTIONS=${ASAN_OPTIONS:-}:verify_asan_link_order=0 exec "$@") >run.log 2>&1 || status=$?
  [ -e struck.log ] || { cat run.log; echo "FAIL: no call number $nth of $call on $file"; exit 1; }
  return $status
}

# As struck kill; the killed program must have gone at once.
killed_at() {
  local status=0
  struck kill "$@" 2>/dev/null || status=$?  # the shell would tell of each
  ((status == 137)) || { cat run.log; echo "FAIL: killed at $*, ended with $status"; exit 1; }
}
