#!/usr/bin/env bash
# From a fresh Debian 12 to the paper's two tables: installs what is missing, builds, runs the suite
# `paper` and leaves its report in reports/out/paper/. Needs root only while packages are missing.
# Every run starts from nothing; the results of the run before are kept in reports/out/paper.previous/.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

usage="usage: bench/reproduce.sh    (no arguments; see README.md for single commands)"
case "${1:-}" in
  "") ;;
  -h | --help) echo "$usage"; exit 0 ;;
  *) corridor_die "unknown argument '$1'; $usage" ;;
esac

jobs=$(corridor_jobs)
out=$corridor_root/reports/out/paper
cd "$corridor_root"

# Takes the results folder away from nobody; the lock stays with this script while it renames.
lock_out() {
  [ -e "$out/.lock" ] || return 0
  exec 9>"$out/.lock"
  flock --nonblock 9 || corridor_die "$out: another run is writing to this folder; expected its end"
}
(lock_out)

build() {
  cmake --preset release &&
    cmake --build --preset release --target corridor-bench --parallel "$jobs"
}

run_suite() {
  mkdir -p "$(dirname "$out")" || return
  if [ -e "$out" ]; then
    lock_out
    rm -rf "$out.previous" && mv "$out" "$out.previous" && rm -f "$out.previous/.lock" || return
    exec 9>&-
  fi
  # One case at a time: the report holds times.
  build/release/bin/corridor-bench run paper --out "$out" --jobs 1
}

status=0
corridor_step "packages" corridor_install
corridor_step "build" build
corridor_step "suite 'paper'" run_suite || status=$?
corridor_print_steps
[ ! -e "$out/index.html" ] || printf '\nThe report: %s\n' "$out/index.html"
exit "$status"
