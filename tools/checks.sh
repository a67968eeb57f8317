#!/usr/bin/env bash
# Checks of the source tree: format, include directions, file lengths, shell scripts, paths of one machine.
#   --tidy   clang-tidy as well, over all translation units of the program (minutes; needs a configured build folder)
# Prints "passed: CHECK" or "failed: CHECK" for each, what is wrong above it, and exits with 1 when one failed.
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"
cd "${ERGON_TREE:-$root}" # the tests run the checks on trees of their own

folders=()
for folder in symbolic codegen runtime scenes tools tests; do
  if [[ -d $folder ]]; then folders+=("$folder"); fi
done
mapfile -t sources < <(find "${folders[@]}" -name '*.cpp' -o -name '*.h' | sort)
[[ ${#sources[@]} -gt 0 ]] || fail "no sources in $PWD"

format() { printf '%s\0' "${sources[@]}" | xargs -0 -P "$cores" -n 16 clang-format --dry-run -Werror --style=file; }

# What the sources of a folder may include with quotes, and which library only some may see.
include_directions() {
  awk '
    BEGIN {
      may["symbolic"] = " symbolic "
      may["codegen"] = " symbolic codegen runtime/kernel.h "
      may["runtime"] = " runtime "
      may["scenes"] = " symbolic codegen runtime scenes "
      may["tools"] = " symbolic codegen runtime scenes tools "
      may["tests"] = " symbolic codegen runtime scenes tools tests "
    }
    /^[ \t]*#[ \t]*include[ \t]*["<]/ {
      split(FILENAME, own, "/"); from = own[1]
      what = $0; sub(/^[^"<]*["<]/, "", what); sub(/[">].*/, "", what)
      split(what, target, "/")
      if ($0 ~ /</) {
        if (what ~ /^(ginac|cln)\// && from == "runtime") {
          printf "%s:%d: runtime does not know GiNaC\n", FILENAME, FNR; bad = 1
        }
        next
      }
      if (what !~ /\// || !(target[1] in may)) {
        printf "%s:%d: \"%s\" is not written from the root of the repository\n", FILENAME, FNR, what; bad = 1
      } else if (index(may[from], " " target[1] " ") == 0 && index(may[from], " " what " ") == 0) {
        printf "%s:%d: %s may not include \"%s\"; it may include:%s\n", FILENAME, FNR, from, what, may[from]; bad = 1
      }
    }
    END { exit bad }' "${sources[@]}"
}

file_lengths() {
  awk 'FNR == 401 { printf "%s: more than 400 lines: split it by idea\n", FILENAME; bad = 1 } END { exit bad }' "${sources[@]}"
}

shell_scripts() {
  local script bad=0
  while IFS= read -r script; do
    bash -n "$script" || bad=1
  done < <(grep -rlIE '^#!.*\b(ba)?sh\b' tools .ci 2>/dev/null; find tools -name '*.sh')
  return $bad
}

# Absolute paths into somebody's home or work folder, in anything that is kept.
host_paths() {
  local found # by its text: grep's exit code is that of a failure when one of the folders is not there
  found="$(grep -rnIE '(^|[^A-Za-z0-9_.])/(home|work|root|Users|mnt)/' "${folders[@]}" energies docs .ci CMakeLists.txt \
    README.md CHANGELOG.md 2>/dev/null || true)"
  [[ -z $found ]] || {
    printf '%s\n' "$found"
    return 1
  }
}

tidy() {
  [[ -f $build/compile_commands.json ]] || fail "no $build/compile_commands.json: run tools/test or cmake first"
  find symbolic codegen runtime scenes tools -name '*.cpp' -print0 | sort -z |
    xargs -0 -P "$cores" -n 1 clang-tidy -p "$build" --quiet 2>/dev/null
}

checks=(format include_directions file_lengths shell_scripts host_paths)
case "${1-}" in
  --tidy) checks+=(tidy) ;;
  '') ;;
  *) fail "unknown argument '$1'; usage: tools/checks.sh [--tidy]" ;;
esac

status=0
for check in "${checks[@]}"; do
  # In a subshell of its own, so that one check that fails does not end the others.
  if ("$check"); then
    printf 'passed: %s\n' "${check//_/ }"
  else
    printf 'failed: %s\n' "${check//_/ }"
    status=1
  fi
done
exit $status
