#!/usr/bin/env bash
# Random search for the profile `tuned`: as many candidates for every system, on development seeds
# only, frozen with the hash of the search. Candidate 0 is the default profile.
#   bench/tune.sh [--out DIR] [--candidates N]       the whole search, then bench/tuning/tuned_params.cpp
#   bench/tune.sh --out DIR --candidate K            candidate K alone: a task of a job array
#   bench/tune.sh --out DIR --candidates N --freeze  chooses among finished candidates
# Slurm: sbatch --array=0-63 --wrap='bench/tune.sh --out DIR --candidate $SLURM_ARRAY_TASK_ID', then --freeze.
# Exit status: 0 done, 1 a candidate could not be run, 2 wrong request.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

space=$corridor_root/bench/tuning/space.txt
frozen=$corridor_root/bench/tuning/tuned_params.cpp
program=$corridor_root/build/release/bin/corridor-bench
out=$corridor_root/reports/out/tuning
candidates=64
candidate=
freeze_only=false

# Development worlds: a report's seeds begin at 1001. Errors above the cap count as the cap, and so
# do cases without one: lost is lost.
scenario=paper-corridor
first_seed=1
num_seeds=8
cap_m=5

number() {
  case $2 in "" | *[!0-9]*) corridor_die "$1 '$2': expected a whole number" ;; esac
}
while [ $# -gt 0 ]; do
  case $1 in
    --out) out=${2:-}; [ -n "$out" ] || corridor_die "--out: expected a folder after it"; shift 2 ;;
    --candidates) candidates=${2:-}; number --candidates "$candidates"; shift 2 ;;
    --candidate) candidate=${2:-}; number --candidate "$candidate"; shift 2 ;;
    --freeze) freeze_only=true; shift ;;
    -h | --help) sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) corridor_die "unknown option '$1'; expected --out, --candidates, --candidate or --freeze" ;;
  esac
done
[ -x "$program" ] || corridor_die "$program: no such program; expected a release build (cmake --workflow --preset release)"

systems() { awk '!/^#/ && NF { print $1 }' "$space" | sort -u; }

# overrides_of SYSTEM K: "parameter = value" lines. A draw is a hash of what it is for, so that it
# depends on nothing else.
overrides_of() {
  [ "$2" -gt 0 ] || return 0
  awk -v system_name="$1" '!/^#/ && $1 == system_name' "$space" | while read -r _ parameter kind values; do
    draw=$(printf '%s/%s/%s' "$1" "$2" "$parameter" | sha256sum | cut -c1-12)
    awk -v parameter="$parameter" -v kind="$kind" -v values="$values" -v draw="$draw" 'BEGIN {
      for (i = 1; i <= length(draw); ++i) u = 16 * u + index("0123456789abcdef", substr(draw, i, 1)) - 1
      u /= 16 ^ length(draw)
      n = split(values, v, " ")
      if (kind == "choice") value = v[int(u * n) + 1]
      else if (kind == "linear") value = sprintf("%.4g", v[1] + u * (v[2] - v[1]))
      else if (kind == "log") value = sprintf("%.4g", v[1] * exp(u * log(v[2] / v[1])))
      else if (kind == "count") value = sprintf("%d", v[1] * exp(u * log(v[2] / v[1])) + 0.5)
      else { print "unknown kind " kind > "/dev/stderr"; exit 1 }
      print parameter " = " value
    }'
  done
}

suite_of() {
  printf 'name = "tune-%s"\ndescription = "Candidate %s of the random search"\nsystems = [' "$1" "$1"
  systems | sed 's/.*/"&"/' | paste -sd, | tr -d '\n'
  printf ']\nscenarios = ["%s"]\nfirst_seed = %s\nnum_seeds = %s\n' "$scenario" "$first_seed" "$num_seeds"
  printf '[limits]\ntime_s = 120\nmemory_mib = 4096\n'
  for system in $(systems); do
    printf '[overrides.%s]\n' "$system"
    overrides_of "$system" "$1"
  done
}

# Runs candidate K unless its cases are there, and writes DIR/K/scores.txt: system, mean of the
# capped position RMSE [m], number of cases that were not lost.
try_candidate() {
  local folder=$out/$1
  mkdir -p "$folder"
  suite_of "$1" >"$folder/suite.toml"
  "$program" run "$folder/suite.toml" --out "$folder/runs" --no-report --resume --quiet --jobs "$(corridor_jobs)" \
    >"$folder/said.txt" 2>&1 || [ $? -eq 1 ] || { cat "$folder/said.txt" >&2; return 1; }
  for system in $(systems); do
    cat "$folder"/runs/runs/*."$system"@*/result.json | awk -v system_name="$system" -v cap="$cap_m" -v n="$num_seeds" '
      match($0, /"position_rmse_m": *[0-9.eE+-]+/) {
        split(substr($0, RSTART, RLENGTH), field, ":")
        rmse = field[2] + 0
        if (rmse < cap) { sum += rmse; ++good }
      }
      END { printf "%s %.6f %d\n", system_name, (sum + (n - good) * cap) / n, good }'
  done >"$folder/scores.txt"
}

# What was searched and what came of it.
search_hash() {
  { cat "$space"; for k in $(seq 0 $((candidates - 1))); do cat "$out/$k/suite.toml" "$out/$k/scores.txt"; done; } |
    sha256sum | cut -d' ' -f1
}

freeze() {
  local hash best score k value_lines
  for k in $(seq 0 $((candidates - 1))); do
    [ -s "$out/$k/scores.txt" ] || corridor_die "$out/$k/scores.txt: not there; expected candidates 0 to $((candidates - 1)) to be finished"
  done
  hash=$(search_hash)
  {
    printf '// Written by bench/tune.sh; do not edit. Its search is described in bench/tuning/README.md.\n'
    printf '#include "bench/tuning/tuned_params.hpp"\n\nnamespace corridor::tuning {\n\n'
    printf 'const std::vector<TunedParams>& all_tuned_params() {\n'
    printf '  static const std::vector<TunedParams> all = {\n'
    for system in $(systems); do
      best=$(for k in $(seq 0 $((candidates - 1))); do awk -v k="$k" -v s="$system" '$1 == s { print $2, k }' "$out/$k/scores.txt"; done | sort -n | head -n 1)
      score=${best% *}
      k=${best#* }
      printf '      {"%s",\n       "%s",\n       %s,\n       %s,\n       %s,\n       %s,\n       %s,\n       {\n' \
        "$system" "$hash" "$candidates" "$k" "$num_seeds" \
        "$(awk -v s="$system" '$1 == s { print $2 }' "$out/0/scores.txt")" "$score"
      overrides_of "$system" "$k" | sed 's/\(.*\) = \(.*\)/           {"\1", "\2"},/'
      printf '       }},\n'
    done
    printf '  };\n  return all;\n}\n\n}  // namespace corridor::tuning\n'
  } >"$frozen"
  if command -v clang-format >/dev/null; then clang-format -i "$frozen"; fi
  echo "$frozen: written, search $hash"
}

if [ -n "$candidate" ]; then
  try_candidate "$candidate"
elif $freeze_only; then
  freeze
else
  for k in $(seq 0 $((candidates - 1))); do
    try_candidate "$k"
    printf 'candidate %s: %s\n' "$k" "$(paste -sd';' "$out/$k/scores.txt")"
  done
  freeze
fi
