#!/usr/bin/env bash
# Fuzzes the readers of datasets/: builds the preset 'fuzz' and lets libFuzzer try inputs on each target.
#   tests/fuzz.sh [--seconds N] [--total N] [--jobs N] [--keep] [TARGET...]
#     --seconds N   per target (default 600)
#     --total N     for all targets together, instead of --seconds, and from the same random seed
#     --jobs N      targets at a time (default: as many as there are cores, 2 GiB of memory for each)
#     --keep        puts what the targets' corpora have grown by, minimised, into tests/fuzz/grown
# Without a target, all of them. Exit status: 0 nothing found, 1 findings, 2 wrong request.
# Needs root only while packages are missing. tests/fuzz/README.md says what to do with a finding.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../bench/setup.sh"

seconds=600 total='' jobs=$(corridor_jobs) keep=false
seed=0  # libFuzzer's word for another one every time
wanted=()

number() {
  [[ "$2" =~ ^[1-9][0-9]*$ ]] || corridor_die "$1 '$2': expected a whole number > 0"
}

while [ $# -gt 0 ]; do
  case "$1" in
    --seconds) number "$1" "${2:-}"; seconds=$2; shift 2 ;;
    --total) number "$1" "${2:-}"; total=$2; shift 2 ;;
    --jobs) number "$1" "${2:-}"; jobs=$2; shift 2 ;;
    --keep) keep=true; shift ;;
    -h | --help) sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; exit 0 ;;
    -*) corridor_die "unknown option '$1'; expected --seconds, --total, --jobs, --keep or targets" ;;
    *) wanted+=("$1"); shift ;;
  esac
done

cd "$corridor_root"
build=$corridor_root/build/fuzz
here=$corridor_root/tests/fuzz
grown=$build/corpus     # what libFuzzer added to the seeds, kept from run to run
found=$build/findings   # inputs that broke something
logs=$build/logs

# Readable stacks, and no words about what libraries of others leave to the end of the process.
export ASAN_SYMBOLIZER_PATH=${ASAN_SYMBOLIZER_PATH:-$(command -v llvm-symbolizer-14 || true)}
export UBSAN_OPTIONS=print_stacktrace=1
export LSAN_OPTIONS="suppressions=$corridor_root/tests/support/leaks.supp:print_suppressions=0"

build_fuzzers() {
  cmake --preset fuzz >"$build.log" &&
    cmake --build --preset fuzz --parallel "$jobs"
}

# fuzz_one NAME MAX_LEN SECONDS
fuzz_one() {
  local name=$1 max_len=$2 time=$3 dictionary=$here/dictionaries/$1.dict status=0
  local -a inputs=("$grown/$name" "$here/corpus/$name")
  [ ! -d "$here/regressions/$name" ] || inputs+=("$here/regressions/$name")
  mkdir -p "$grown/$name" "$found/$name" "$logs"
  # An input of at most 4 KiB that takes 10 s or 2 GiB is a finding.
  "$build/bin/fuzz_$name" "${inputs[@]}" -max_total_time="$time" -max_len="$max_len" \
    -rss_limit_mb=2048 -timeout=10 -artifact_prefix="$found/$name/" -print_final_stats=1 \
    -seed="$seed" $([ ! -e "$dictionary" ] || echo "-dict=$dictionary") >"$logs/$name.log" 2>&1 || status=$?
  report "$name" "$status"
  return "$status"
}

# What earlier runs found and was kept joins what this checkout's runs found.
unpack_grown() {
  local archive name
  for archive in "$here"/grown/*.tar.gz; do
    [ -e "$archive" ] || continue
    name=$(basename "$archive" .tar.gz)
    mkdir -p "$grown/$name"
    tar --extract --gzip --skip-old-files --file="$archive" --directory="$grown/$name"
  done
}

# Inputs that together reach all that the corpus of a target reaches and its seeds do not, in an
# archive whose bytes depend on nothing else.
keep_grown() {
  local name merged=$build/merged
  while read -r name _; do
    rm -rf "$merged" && mkdir -p "$merged"
    cp "$here/corpus/$name"/* "$merged"
    "$build/bin/fuzz_$name" -merge=1 -rss_limit_mb=2048 -timeout=10 "$merged" "$grown/$name" \
      >"$logs/$name.merge.log" 2>&1
    (cd "$here/corpus/$name" && for seed in *; do rm -f "$merged/$seed"; done)
    mkdir -p "$here/grown"
    tar --create --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 \
      --directory="$merged" . | gzip --no-name --best >"$here/grown/$name.tar.gz"
    printf '%-18s %6d inputs kept, %s\n' "$name" "$(find "$merged" -type f | wc -l)" \
      "$(du -h "$here/grown/$name.tar.gz" | cut -f1)"
  done <<<"$list"
}

# One line per target from libFuzzer's log.
report() {
  awk -v name="$1" -v status="$2" '
    / cov: / { for (i = 1; i < NF; ++i) if ($i == "cov:") edges = $(i + 1) }
    /^stat::number_of_executed_units:/ { runs = $2 }
    /^stat::average_exec_per_sec:/ { rate = $2 }
    /^SUMMARY: / { summary = substr($0, 10) }
    /Test unit written to/ { file = $NF }
    END {
      printf "%-18s %10d runs %8d/s  %5d edges  %s\n", name, runs, rate, edges,
        status == 0 ? "nothing found" : "FOUND " summary
      if (status != 0) printf "%-18s %s\n", "", file != "" ? file : "see the log"
    }' "$logs/$1.log"
}

# The lines of fuzzers.txt that were asked for.
targets() {
  [ ${#wanted[@]} -gt 0 ] || { cat "$build/fuzzers.txt"; return; }
  local name
  for name in "${wanted[@]}"; do
    grep "^$name " "$build/fuzzers.txt" ||
      corridor_die "no target '$name'; expected one of $(cut -d' ' -f1 "$build/fuzzers.txt" | xargs)"
  done
}

# The targets of $list, $jobs at a time. Every one has its turn, whatever the others found.
fuzz_all() {
  echo "$seconds s per target, $jobs at a time; logs in build/fuzz/logs, findings in build/fuzz/findings"
  export -f fuzz_one report
  export build here grown found logs seconds seed
  xargs --max-procs="$jobs" --max-lines=1 bash -c 'fuzz_one "$0" "$1" "$seconds"' <<<"$list"
}

mkdir -p "$corridor_root/build"
corridor_step "packages" corridor_install tests
corridor_step "build 'fuzz'" build_fuzzers
list=$(targets)
# A check before a change goes in asks the same questions every time; long runs ask new ones.
[ -z "$total" ] || { seed=1; seconds=$((total * jobs / $(wc -l <<<"$list"))); }
[ "$seconds" -gt 0 ] || seconds=1
status=0
unpack_grown
corridor_step "fuzzing" fuzz_all || status=1
if $keep; then corridor_step "corpora" keep_grown || status=1; fi
corridor_print_steps
exit "$status"
