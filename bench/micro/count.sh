#!/bin/sh
# Counts the instructions of fixed cases of corridor-micro with callgrind: a number that, other than a
# time, does not depend on what else the machine does.
#   bench/micro/count.sh            prints a table: benchmark, instructions
#   bench/micro/count.sh --check    compares it with bench/micro/counts.txt: one by more than 2 % fails
#   --build DIR                     the build folder (default: build/release of this checkout)
# Counted is one round of the benchmark's loop, without set-up: what Google Benchmark does between
# starting and stopping its clock. Exit status: 0 counted, and alike; 1 a count deviates; 2 wrong request.
set -eu
export LC_ALL=C
# The same kernels of OpenBLAS on every machine, of those that valgrind can run (it knows no AVX-512).
export OPENBLAS_CORETYPE=Haswell

here=$(cd "$(dirname "$0")" && pwd -P)
build=$here/../../build/release
is_check=false
max_deviation_percent=2

# One per kernel: linearisation, assembly, ordering, symbolic and numeric factorisation (two of
# them), back-substitution, elimination of a whole Bayes tree, all updates of a walk.
cases='graph/linearize/500
linear/matrix/add
linear/order
linear/block/lay_out
linear/block/factorize
linear/cholmod/factorize_supernodal
linear/block/solve
backend/isam2/solve/500
backend/isam2/update_all/500'

die() {
  echo "count.sh: $1" >&2
  exit 2
}

while [ $# -gt 0 ]; do
  case $1 in
    --check) is_check=true; shift ;;
    --build) build=${2:-}; [ -n "$build" ] || die "--build: expected a folder after it"; shift 2 ;;
    -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) die "unknown option '$1'; expected --check or --build DIR" ;;
  esac
done

program=$build/bin/corridor-micro
[ -x "$program" ] || die "$program: no such program; expected a build of the target corridor-micro"
command -v valgrind >/dev/null || die "no valgrind here; expected the Debian package valgrind"

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT INT TERM

# The clock starts in ResumeTiming() and the loop ends in FinishKeepRunning(); a benchmark that pauses
# its clock within the loop begins anew when it goes on. A least time of 0 is one round.
count() {
  rm -f "$scratch"/out*
  valgrind --tool=callgrind --cache-sim=no --callgrind-out-file="$scratch/out" \
    --zero-before='benchmark::State::ResumeTiming()' \
    --dump-before='benchmark::State::FinishKeepRunning()' \
    "$program" --benchmark_min_time=0 --benchmark_filter="^$1\$" >"$scratch/said" 2>&1 ||
    { tail -n 5 "$scratch/said" >&2; die "$1: valgrind failed"; }
  if [ ! -f "$scratch/out.1" ] || [ -f "$scratch/out.2" ]; then
    die "$1: expected one round of one benchmark"
  fi
  awk '$1 == "summary:" { print $2 }' "$scratch/out.1"
}

of_cache() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }

print_table() {
  echo "# Instructions of one round; bench/micro/count.sh. Made $(date -u +%Y-%m-%d) with"
  echo "# $("$(of_cache CMAKE_CXX_COMPILER)" --version | head -n 1), $(of_cache CMAKE_BUILD_TYPE), -march=$(of_cache CORRIDOR_ARCH), $(valgrind --version)"
  for case in $cases; do
    instructions=$(count "$case")  # by itself: a failure ends the script
    printf '%-38s %12s\n' "$case" "$instructions"
  done
}

if ! $is_check; then
  print_table
  exit 0
fi
[ -r "$here/counts.txt" ] || die "$here/counts.txt: no such record; expected the output of count.sh"
print_table >"$scratch/now"
sed -n '2s/^# /recorded with /p' "$here/counts.txt"
sed -n '2s/^# /now          /p' "$scratch/now"
awk -v limit="$max_deviation_percent" '
  /^#/ { next }
  NR == FNR { recorded[$1] = $2; next }
  { is_known = $1 in recorded && recorded[$1] > 0
    percent = is_known ? 100 * ($2 / recorded[$1] - 1) : 0
    is_bad = !is_known || percent > limit || percent < -limit
    num_bad += is_bad
    printf "%-38s %12s %12d %10s%s\n", $1, is_known ? recorded[$1] : "none", $2,
           is_known ? sprintf("%+.2f %%", percent) : "", is_bad ? "  deviates" : ""
    delete recorded[$1] }
  END { for (name in recorded) {
          printf "%-38s %12d %12s %10s  deviates\n", name, recorded[name], "none", ""
          ++num_bad
        }
        exit num_bad > 0 }' "$here/counts.txt" "$scratch/now"
