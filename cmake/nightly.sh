#!/bin/bash
# Everything that is too long for every change, and a page of what came out: build/nightly/page.md.
#
#   cmake/nightly.sh [--steps REGEX] [HOURS OF SOAK] [DRAWN MUTANTS]
#
# 1 hour and 30 mutants if not given, and all steps, of whose names REGEX chooses. A step that fails is
# told, and the next one runs. The exit code is 1 where one did, or none was chosen.
set -uo pipefail
cd "$(dirname "$0")/.."
steps=.
if [[ ${1:-} == --steps && $# -ge 2 ]]; then
  steps=$2
  shift 2
elif [[ ${1:-} == -* ]]; then
  sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
hours=${1:-1} mutants=${2:-30}
folder=build/nightly
mkdir -p "$folder"
page=$folder/page.md
jobs=$(nproc)
failed=0 chosen=0

# step NAME COMMAND...: a row of the page, with the last line that it printed.
step() {
  local name=$1 log start=$SECONDS verdict=passed
  shift
  [[ $name =~ $steps ]] || return 0
  chosen=1
  log=$folder/${name// /-}.log
  if ! "$@" > "$log" 2>&1; then
    verdict="**failed**"
    failed=1
  fi
  # Tests end in a table of their labels.
  local told
  told=$(grep -E 'tests (passed|failed)' "$log" || grep -v '^[[:space:]]*$' "$log" | tail -n 1)
  printf '| %s | %s | %d min | %s |\n' "$name" "$verdict" $(((SECONDS - start + 59) / 60)) \
    "$(tail -n 1 <<< "$told" | tr '|' '/' | cut -c 1-160)" >> "$page"
}

{
  printf '# Nightly, %s\n\n' "$(date -u '+%Y-%m-%d %H:%M UTC')"
  printf 'Commit %s on %s, %d cores.\n\n' "$(git rev-parse --short HEAD)" "$(uname -n)" "$jobs"
  printf '| step | verdict | time | last line |\n|---|---|--:|---|\n'
} > "$page"

readers=(scene image measuring saved_maps fuzz)
step "build" cmake/build.sh release
step "quick tests" ctest --preset release --parallel "$jobs"
step "slow tests" ctest --preset slow --parallel "$jobs"
step "build sanitizers" cmake/build.sh sanitizers "${readers[@]/#/photile_tests_}"
step "sanitizers" ctest --preset sanitizers -R "^($(IFS='|'; echo "${readers[*]}"))/"
step "build thread sanitizer" cmake/build.sh threads photile_tests_{view,render}
# On one processor, where oneTBB has no threads of its own: docs/testing.md.
step "thread sanitizer" taskset -c 0 ctest --preset threads -R "^(view|render/several)"
step "build fuzzers" cmake/build.sh fuzzers photile_fuzz
step "soak" bench/soak.sh "$hours"
step "build coverage" cmake/build.sh coverage photile_fuzz
step "coverage" bench/fuzz_coverage.py --more build/soak
step "drawn mutants" bench/drawn_mutants.py --count "$mutants" --seed "$(date -u +%Y%m%d)"
step "quick benches" ctest --test-dir build/release -L bench

cat "$page"
if ((!chosen)); then
  echo "nightly.sh: error: no step matches '$steps'" >&2
  failed=1
fi
exit $failed
