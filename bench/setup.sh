# Shared by bench/reproduce.sh and tests/run.sh, which source it: packages, number of jobs, timed steps.
# It does nothing by itself and changes nothing outside the checkout except installing Debian packages.

# The checkout, wherever the caller stands and however it was reached.
corridor_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

# Numbers and sort orders must not depend on the user's locale; ccache and git want a home.
export LC_ALL=C.UTF-8
export HOME=${HOME:-/root}

corridor_say() { printf '\n== %s\n' "$*"; }

corridor_die() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 2
}

# corridor_packages PURPOSE... : the packages of bench/debian-packages.txt without a purpose of their
# own, and those whose purpose (second word of the line) is one of the arguments.
corridor_packages() {
  awk -v purposes=" $* " '
    /^#/ || NF == 0 { next }
    NF == 1 || index(purposes, " " $2 " ") { print $1 }' "$corridor_root/bench/debian-packages.txt"
}

# Those of the arguments that dpkg does not report as installed.
corridor_missing_packages() {
  local package
  for package in "$@"; do
    # The status of an installed package ends in "installed"; an unknown one makes dpkg-query fail.
    case "$(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null || true)" in
      "install ok installed" | "hold ok installed") ;;
      *) printf '%s\n' "$package" ;;
    esac
  done
}

# corridor_install PURPOSE... : installs what is missing and nothing else. With everything in place it
# needs neither root nor a network.
corridor_install() {
  command -v dpkg-query >/dev/null ||
    corridor_die "no dpkg-query here; expected Debian 12 (or install the packages of bench/debian-packages.txt by hand)"
  local -a wanted missing
  mapfile -t wanted < <(corridor_packages "$@")
  mapfile -t missing < <(corridor_missing_packages "${wanted[@]}")
  if [ "${#missing[@]}" -eq 0 ]; then
    echo "all ${#wanted[@]} packages are there"
    return
  fi
  echo "missing: ${missing[*]}"
  [ "$(id -u)" -eq 0 ] || corridor_die "installing packages needs root; run as root, or: apt-get install --no-install-recommends ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  apt-get update --quiet &&
    apt-get install --yes --quiet --no-install-recommends "${missing[@]}"
}

# As many compilers or cases at once as there are cores, with 2 GiB of memory for each: the files that
# see the headers of Open3D or MRPT take that much.
corridor_jobs() {
  local cores memory_gib
  cores=$(nproc)
  memory_gib=$(awk '/^MemAvailable:/ { print int($2 / 1048576) }' /proc/meminfo)
  local jobs=$((memory_gib / 2 < cores ? memory_gib / 2 : cores))
  echo $((jobs > 0 ? jobs : 1))
}

corridor_steps=()

# corridor_step NAME COMMAND... : runs the command under a heading and remembers how long it took.
# The status is the command's. The command runs without `set -e`: a function of several commands joins
# them with &&.
corridor_step() {
  local name=$1 status=0 started=$SECONDS
  shift
  corridor_say "$name"
  ("$@") || status=$?
  corridor_steps+=("$(printf '%6d s  %s%s' $((SECONDS - started)) "$name" "$([ "$status" -eq 0 ] || echo "  FAILED ($status)")")")
  return "$status"
}

corridor_print_steps() {
  corridor_say "time per step"
  printf '%s\n' "${corridor_steps[@]}" "$(printf '%6d s  total' "$SECONDS")"
}
