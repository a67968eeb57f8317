#!/usr/bin/env bash
# Checks of the source tree: format, include directions, file lengths, names of types, names of laws, shell scripts, paths of
# one machine.
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
mapfile -t engine < <(printf '%s\n' "${sources[@]}" | grep -E '^(symbolic|codegen|runtime|scenes)/')

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

# Two types of one name are one to the linker: each name once in a namespace, over all files, unless it is in an
# anonymous one. The programs of tests are linked apart, so a name may come again in another folder of tests.
type_names() {
  awk '
    FNR == 1 { depth = 0 }
    /^(inline )?namespace .*\{$/ || /^namespace \{$/ {
      name = $0; sub(/^inline /, "", name); sub(/^namespace ?/, "", name); sub(/ ?\{$/, "", name)
      space[++depth] = name; next
    }
    /^\}  \/\/ namespace/ { if (depth > 0) --depth; next }
    /^(struct|class|union|enum|enum class|enum struct) [A-Za-z_0-9]+( final)?( ?:[^;]*)?( ?\{.*)?$/ {
      if ($0 !~ /[{:]/ || $0 ~ /^[a-z ]+[A-Za-z_0-9]+::/) next
      type = $0; sub(/^(enum class|enum struct|struct|class|union|enum) /, "", type); sub(/[^A-Za-z_0-9].*/, "", type)
      key = ""; hidden = depth == 0
      for (i = 1; i <= depth; ++i) { if (space[i] == "") hidden = 1; key = key space[i] "::" }
      if (hidden) next
      key = key type
      split(FILENAME, part, "/"); program = part[1] == "tests" ? part[1] "/" part[2] : ""
      for (n = 1; n <= count[key]; ++n) {
        if (file[key, n] == FILENAME || (program != "" && home[key, n] != "" && home[key, n] != program)) continue
        printf "%s:%d: %s is also the name of a type in %s:%d\n", FILENAME, FNR, key, file[key, n], line[key, n]; bad = 1
      }
      ++count[key]; file[key, count[key]] = FILENAME; line[key, count[key]] = FNR; home[key, count[key]] = program
    }
    END { exit bad }' "${sources[@]}"
}

# No law of the catalogue has code of its own: its name is no text, nor a word in one, of what makes or runs kernels. Distances
# (energies/contact/distances) are the geometry that contact tells apart. Where a name stands all the same, and why:
named_laws='
  scenes/builder.cpp: inertia gravity drag dead_load affine_orthogonality: stated by keys that name no law
  scenes/build_mass.cpp: inertia gravity drag: the same
  scenes/build_affine.cpp: affine_orthogonality: the same
  scenes/build_contact.cpp: log_barrier friction friction_secant: the same; the ground has this barrier
  scenes/scene_keys.cpp: gravity affine_orthogonality attachment: keys, and the help of one
  scenes/scene.h: log_barrier: the default of `barrier` in [contact]
  scenes/attachment_keys.cpp: attachment joined_points pinned_to_triangle held_above_triangle: defaults of `law` in [[attachment]], and its help
  scenes/scene_text.cpp: attachment: the key
  scenes/scene_reference.cpp: stable_neo_hookean: the scene that is shown
  scenes/catalogue.cpp: log_barrier: an example in a message
  runtime/contact/pair_stiffness.cpp: log_barrier: an example in a message
  runtime/contact/ground.cpp: friction: the word, in a message
  runtime/output/report.cpp: friction: the word, in a report
  scenes/run.cpp: friction: the word, in a report
'
law_names() {
  local laws
  laws="$(find energies -name '*.energy' -not -path '*/distances/*' 2>/dev/null | sed 's|.*/||; s|\.energy$||' | sort)"
  [[ -n $laws ]] || return 0
  awk -v laws="$laws" -v listed="$named_laws" '
    BEGIN {
      for (n = split(laws, name, "\n"); n > 0; --n) law[name[n]] = 1
      for (n = split(listed, line, "\n"); n > 0; --n) {
        gsub(/^ +/, "", line[n]); split(line[n], part, ": *")
        for (w = split(part[2], word, " "); w > 0; --w)
          if (word[w] in law) may[part[1], word[w]] = 1
      }
    }
    FNR == 1 { seen[FILENAME] = 1 }
    /^[ \t]*(\/\/|#[ \t]*include)/ { next }
    {
      # A name of one word is looked for as a whole text, or the part before a colon, for many are words of English too.
      for (rest = $0; match(rest, /"([^"\\]|\\.)*"/); rest = substr(rest, RSTART + RLENGTH)) {
        text = substr(rest, RSTART + 1, RLENGTH - 2)
        whole = text; sub(/:.*/, "", whole)
        n = split(text, word, /[^A-Za-z0-9_]+/)
        for (w = 0; w <= n; ++w) {
          found = w == 0 ? whole : word[w]
          if (!(found in law) || (w > 0 && found !~ /_/)) continue
          if ((FILENAME, found) in may) { used[FILENAME, found] = 1; continue }
          printf "%s:%d: \"%s\" is a law of the catalogue, which needs no code of its own; what is particular to it belongs ", FILENAME, FNR, found
          print "into its file, or into a word of the language"; bad = 1; break
        }
      }
    }
    END {
      for (pair in may) {
        split(pair, part, SUBSEP)
        if (!(part[1] in seen) || (pair in used)) continue
        printf "%s: does not name the law \"%s\" any more; take it off the list in tools/checks.sh\n", part[1], part[2]; bad = 1
      }
      exit bad
    }' "${engine[@]}"
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
  # Lanes over floats are compiled with an option of GCC that clang lacks; the same files over doubles are looked at.
  mkdir -p "$build/tidy"
  awk '
    /^{/ { entry = "" }
    { entry = entry $0 "\n" }
    /^}/ { sub(/,\n$/, "\n", entry); if (entry !~ /ERGON_SINGLE/) { all = all (all == "" ? "" : ",\n") entry } entry = "" }
    END { printf "[\n%s]\n", all }' "$build/compile_commands.json" >"$build/tidy/compile_commands.json"
  find symbolic codegen runtime scenes tools -name '*.cpp' -print0 | sort -z |
    xargs -0 -P "$cores" -n 1 clang-tidy -p "$build/tidy" --quiet 2>/dev/null
}

checks=(format include_directions file_lengths type_names law_names shell_scripts host_paths)
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
