#!/usr/bin/env bash
# Installs what is missing, builds the release and runs every test of it.
#   tests/run.sh          release build and its tests (20 minutes at most on 2 cores)
#   tests/run.sh --full   also formatting, build and tests with AddressSanitizer and
#                         UndefinedBehaviorSanitizer, and two minutes of fuzzing (40 minutes at most)
# Tests that need recorded data look for it in $CORRIDOR_BENCH_DATA and are skipped, with a message,
# where it is not. Needs root only while packages are missing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../bench/setup.sh"

is_full=false
for argument in "$@"; do
  case "$argument" in
    --full) is_full=true ;;
    -h | --help) sed -n '2,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    *) corridor_die "unknown argument '$argument'; expected --full or nothing" ;;
  esac
done

jobs=$(corridor_jobs)
cd "$corridor_root"
# For the sanitizer build: what libraries of others leave to the end of the process.
export LSAN_OPTIONS="suppressions=$corridor_root/tests/support/leaks.supp:print_suppressions=0"

build() {
  cmake --preset "$1" &&
    cmake --build --preset "$1" --parallel "$jobs"
}

# Seconds of fuzzing, for all targets together.
fuzz_s=120

# Seconds that the tests of a room may take in the release build, one after another. Those of bench
# start the program some 400 times, at a third of a second each: it links the libraries of all doors.
# Those of datasets simulate and read some ten thousand logs to find the noise that was put in.
room_budgets_s='slam=100 baselines=100 bench=200 datasets=150 reports=100 architecture=60 fuzz=60'

run_tests() {
  local status=0
  ctest --preset "$1" --parallel "$jobs" --output-junit "$corridor_root/build/$1/tests.xml" |
    tee "build/$1/tests.log" || status=$?
  [ "$1" != release ] || print_rooms "build/$1/tests.log"
  return "$status"
}

# From the summary per label that ctest ends with, "slam = 12.3 sec*proc (101 tests)".
print_rooms() {
  awk -v stated="$room_budgets_s" '
    BEGIN { print "\ntime of the tests per room, with its budget"
            for (i = split(stated, pairs, " "); i > 0; i--) { split(pairs[i], pair, "="); budget[pair[1]] = pair[2] } }
    / = .* sec\*proc \(/ { printf "%8.1f s of %s s  %s%s\n", $3, budget[$1], $1, ($3 > budget[$1] ? "  OVER BUDGET" : "") }' "$1"
}

our_sources() {
  find slam baselines datasets bench reports tests -path reports/out -prune -o \
    \( -name '*.cpp' -o -name '*.hpp' \) -print | sort
}

check_format() {
  our_sources | xargs clang-format --dry-run -Werror &&
    echo "$(our_sources | wc -l) files are formatted"
}

# Number in attribute $2 of the summary that ctest wrote for preset $1.
count_of() {
  local file=build/$1/tests.xml
  [ -e "$file" ] || { echo 0; return; }
  awk -v name="$2" 'match($0, "[ \t]" name "=\"[0-9]+\"") {
    text = substr($0, RSTART, RLENGTH); gsub(/[^0-9]/, "", text); print text; exit }' "$file"
}

failed_steps=0
presets=(release)
rm -f build/release/tests.xml build/dev/tests.xml
if $is_full; then
  presets+=(dev)
  corridor_step "packages" corridor_install tests
  corridor_step "formatting" check_format || failed_steps=$((failed_steps + 1))
else
  corridor_step "packages" corridor_install
fi

for preset in "${presets[@]}"; do
  if corridor_step "build '$preset'" build "$preset"; then
    corridor_step "tests of '$preset'" run_tests "$preset" || failed_steps=$((failed_steps + 1))
  else
    failed_steps=$((failed_steps + 1))
  fi
done

if $is_full; then
  corridor_step "fuzzing" tests/fuzz.sh --total "$fuzz_s" || failed_steps=$((failed_steps + 1))
fi

corridor_print_steps
tests=0 failed=0 skipped=0
for preset in "${presets[@]}"; do
  tests=$((tests + $(count_of "$preset" tests)))
  failed=$((failed + $(count_of "$preset" failures)))
  skipped=$((skipped + $(count_of "$preset" skipped) + $(count_of "$preset" disabled)))
done
printf '\n%d skipped, %d steps failed\n' "$skipped" "$failed_steps"
printf '%d passed, %d failed\n' $((tests - failed - skipped)) "$failed"
[ "$failed_steps" -eq 0 ]
