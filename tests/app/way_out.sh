#!/usr/bin/env bash
# The program ends, with one line and a code other than 0, where its output is closed or its memory limited, and when one
# rank of two fails alone. Many that run alone do not get into each other's way.
#   way_out.sh PATH/TO/elastogear PATH/TO/mpiexec
set -u
elastogear=$(realpath "$1")
mpiexec=$2
source "$(dirname "$0")/bar.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { echo "FAIL: $*"; exit 1; }
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

bar 4 1 1 0.01 0.01 0.01 >bar.inp
reduce=("$elastogear" reduce -mesh bar.inp -material_E 210e9 -material_nu 0.3 -material_rho 7850 -restrain FIX -modes 3 -output body.h5)

# ended CODE REGEX COMMAND...: it ends within seconds, and standard error is one line.
ended() {
  local code=$1 pattern=$2 status=0
  shift 2
  timeout 30 "$@" >out.log 2>err.log || status=$?
  [[ $status == "$code" ]] || { cat out.log err.log; fail "$* ended with $status, not $code"; }
  grep -Eq "$pattern" err.log || { cat err.log; fail "no '$pattern' of $*"; }
}
one_line() { [[ $(grep -c "error" err.log) == 1 ]] || { cat err.log; fail "more than one error"; }; }

export -f fail
ended 141 'reduce: error: what reads the output has gone' bash -c '"${@:1}" | true; exit "${PIPESTATUS[0]}"' bash "$elastogear" reduce -help
one_line
[[ -c /dev/full ]] && ended 1 'reduce: error: standard output: No space left' bash -c '"$@" >/dev/full' bash "${reduce[@]}" && one_line

alone() { for _ in $(seq 8); do "$elastogear" info body.h5 >alone.log 2>&1 || { cat alone.log; return 1; }; done; }
"${reduce[@]}" >out.log 2>&1 || { cat out.log; fail "the good case"; }
alone & first=$!
alone & second=$!
{ wait $first && wait $second; } || fail "two at a time"

if (ulimit -v 4000000 && "$elastogear" -version) >out.log 2>&1; then  # sanitizers need more
  # OpenBLAS 0.3.29 takes its memory when the program is loaded, and tries for ever where there is none.
  least=200000
  until (ulimit -v $least && timeout 2 "$elastogear" -version) >out.log 2>&1; do least=$((least + 50000)); done
  for limit in $least $((least + 100000)); do
    for threads in "OPENBLAS_NUM_THREADS=1" "-u OPENBLAS_NUM_THREADS"; do
      # shellcheck disable=SC2086  # several words
      (ulimit -v $limit && ended 1 'limit of memory.*raise it|out of memory|[Rr]esource' env $threads "${reduce[@]}") || exit 1
    done
  done
  [[ $(ulimit -v 3000000; "${reduce[@]}" 2>&1) == *written* ]] || fail "with enough memory"
  # shellcheck disable=SC2016  # of the inner shell
  ended 1 'reduce: error: the limit of memory' "$mpiexec" --oversubscribe -n 2 bash -c \
    '[[ $OMPI_COMM_WORLD_RANK == 1 ]] && ulimit -v $1; exec "${@:2}"' bash $((least + 150000)) "${reduce[@]}"
fi
echo "all good"
