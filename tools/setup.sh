# Sourced by tools/run, tools/test and tools/checks.sh. Establishes: root, build (its build folder), cores; and the two
# steps both commands share: the Debian packages that are missing, and a build that is up to date.
# ERGON_BUILD names another build folder.

set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build="${ERGON_BUILD:-$root/build}"
cores="$(nproc)"

fail() {
  printf 'ergon: error: %s\n' "$*" >&2
  exit 1
}

# Prints the packages of tools/packages.txt that are not installed, one a line.
missing_packages() {
  local -a wanted
  mapfile -t wanted <"$root/tools/packages.txt"
  comm -23 <(printf '%s\n' "${wanted[@]}" | sort) \
    <(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null |
      sed -n 's/^installed //p' | sort -u)
}

install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    printf 'ergon: not a Debian system: nothing is installed; tools/packages.txt lists what is needed\n' >&2
    return
  fi
  local -a missing as_root=()
  mapfile -t missing < <(missing_packages)
  if [[ ${#missing[@]} -eq 0 ]]; then return; fi
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null ||
      fail "missing packages, and no sudo to install them; as root: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  local -a apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600)
  printf 'ergon: installing %s\n' "${missing[*]}"
  # Lists that are absent or stale make the first try fail; they are fetched only then.
  if ! "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null 2>&1 </dev/null; then
    "${apt[@]}" update </dev/null || fail "apt-get update failed: is there a network and a Debian mirror?"
    "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >/dev/null </dev/null ||
      fail "could not install: ${missing[*]}"
  fi
  mapfile -t missing < <(missing_packages)
  [[ ${#missing[@]} -eq 0 ]] || fail "still missing after the installation: ${missing[*]}"
}

# Brings the targets named up to date (all of them when none is named).
build_targets() {
  mkdir -p "$build"
  (
    flock 9 # two commands may share a build folder
    # A folder that was copied or moved still points at where it was configured.
    if [[ -f $build/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$build/CMakeCache.txt"; then
      rm -rf "$build/CMakeCache.txt" "$build/CMakeFiles" "$build/build.ninja"
    fi
    if [[ ! -f $build/build.ninja ]]; then
      cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release 9>&- || fail "cmake failed"
    fi
    ninja -C "$build" -j "$cores" "$@" 9>&- || fail "the build failed"
  ) 9>"$build/.lock"
}
