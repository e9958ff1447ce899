#!/usr/bin/env bash
# Runs clang-tidy over every library and program source of the release build. A script of its own, since
# it takes about as long as all of tests/run.sh.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../bench/setup.sh"

jobs=$(corridor_jobs)
cd "$corridor_root"

check_tidy() {
  our_sources |
    xargs --max-procs="$jobs" --max-args=1 clang-tidy --quiet -p build/release --warnings-as-errors='*' 2>&1 |
    sed -E '/^[0-9]+ warnings? (generated|treated as error)/d; /^Suppressed /d; /^Use -/d' &&
    echo "clang-tidy has nothing to say"
}

# The tests' sources are not among them: their macros make most checks fire on code nobody wrote.
our_sources() {
  find slam baselines datasets bench reports -path reports/out -prune -o -name '*.cpp' -print | sort
}

corridor_step "packages" corridor_install tests
# Generated headers must be there.
build() { cmake --preset release && cmake --build --preset release --parallel "$jobs"; }
corridor_step "build" build
corridor_step "clang-tidy" check_tidy
corridor_print_steps
