#!/bin/bash
# Everything that is too long for every change, and a page of what came out: build/nightly/page.md.
#
#   cmake/nightly.sh [--quick] [--list] [--steps REGEX]
#
# --steps runs those steps alone whose names REGEX finds; the page keeps the others' last results, so
# that a night can be run in parts. --list prints their names. A step that fails is told, and the next
# one runs. The exit code is 1 where one did, or none was chosen. How long the steps without an end
# take, here and with --quick:
#
#   PHOTILE_NIGHTLY_SOAK_HOURS    1      0.05   of fuzzing and commands at random
#   PHOTILE_NIGHTLY_MUTANTS       30     4      drawn from the kernels
#   PHOTILE_NIGHTLY_HOST_MUTANTS  10     1      drawn from kernels, groups, surface and trace
#   PHOTILE_NIGHTLY_PROPERTIES    5000   200    commands at random among the slow tests
set -uo pipefail
cd "$(dirname "$0")/.."
steps=. quick=0 list=0
while (($#)); do
  case $1 in
    --quick) quick=1 ;;
    --list) list=1 ;;
    --steps)
      shift
      steps=${1:?--steps needs a regular expression}
      ;;
    *)
      sed -n '2,/^set/{/^set/!s/^# \{0,1\}//p}' "$0" >&2
      exit 2
      ;;
  esac
  shift
done
((quick)) && defaults=(0.05 4 1 200) || defaults=(1 30 10 5000)
hours=${PHOTILE_NIGHTLY_SOAK_HOURS:-${defaults[0]}}
mutants=${PHOTILE_NIGHTLY_MUTANTS:-${defaults[1]}}
host_mutants=${PHOTILE_NIGHTLY_HOST_MUTANTS:-${defaults[2]}}
properties=${PHOTILE_NIGHTLY_PROPERTIES:-${defaults[3]}}
seed=$(date -u +%Y%m%d)
folder=build/nightly
jobs=$(nproc)
failed=0 chosen=0 number=100
commit=$(git rev-parse --short HEAD)
git diff --quiet HEAD || commit+="+" # files are changed
mkdir -p "$folder/rows"

# step NAME COMMAND...: a row of the page, with the last line that it printed.
step() {
  local name=$1 start=$SECONDS verdict=passed
  local log=$folder/${name// /-}.log row=$folder/rows/$((++number))-${name// /-}
  shift
  [[ $name =~ $steps ]] || return 0
  chosen=1
  if ((list)); then
    echo "$name"
    return 0
  fi
  rm -f "$folder"/rows/[0-9][0-9][0-9]-"${name// /-}"
  if ! "$@" > "$log" 2>&1; then
    verdict="**failed**"
    failed=1
  fi
  # CTest passes where every test is skipped.
  if [[ $verdict = passed ]] && grep -q 'tests passed' "$log" && ! grep -q ' Passed ' "$log"; then verdict=skipped; fi
  # Tests end in a table of their labels.
  local told
  told=$(grep -E 'tests (passed|failed)' "$log" || grep -v '^[[:space:]]*$' "$log" | tail -n 1)
  printf '| %s | %s | %d:%02d | %s | %s |\n' "$name" "$verdict" $(((SECONDS - start) / 60)) \
    $(((SECONDS - start) % 60)) "$commit" "$(tail -n 1 <<< "$told" | tr '|' '/' | cut -c 1-160)" \
    | tee "$row"
}

# slow AREA: the slow tests of a folder of tests/.
slow() {
  step "slow $1" env PHOTILE_PROPERTIES="$properties" ctest --preset slow --no-tests=error \
    --parallel "$jobs" -R "^$1/"
}

# What reads files, then the stages; random commands reach what is between them.
sanitized=(scene image loading cloud saved_maps measuring fuzz trace groups surface maps cache daylight
  glare walk bake property)
sanitized_tests="^($(IFS='|'; echo "${sanitized[*]}"))/"
step "build" cmake/build.sh release
step "quick tests" ctest --preset release --parallel "$jobs"
for area in $(ctest --preset slow -N | sed -nE 's|^ *Test +#[0-9]+: ([a-z_]+)/.*|\1|p' | grep -vx bench | sort -u); do
  slow "$area"
done
step "build sanitizers" cmake/build.sh sanitizers "${sanitized[@]/#/photile_tests_}"
step "sanitizers" ctest --preset sanitizers --no-tests=error --parallel "$jobs" -R "$sanitized_tests"
step "build threads" cmake/build.sh threads \
  photile_tests_{view,render,cache,trace,groups,daylight} photile_command
# On one processor, where oneTBB has no threads of its own, and without the test that asks for them:
# docs/reference/testing.md.
step "threads" taskset -c 0 ctest --preset threads --no-tests=error -E reproducib \
  -R "^((view|cache|trace|groups|daylight)/|render/(several|shared_rendering))"
step "build fuzzers" cmake/build.sh fuzzers photile_fuzz
step "soak" bench/tools/soak.sh "$hours"
step "build coverage" cmake/build.sh coverage photile_fuzz
step "coverage" bench/tools/fuzz_coverage.py --more build/soak
step "mutants of kernels" bench/mutants/mutants.py --only kernels --seed "$seed" --draw "$mutants"
step "mutants of the host" bench/mutants/mutants.py --only host --seed "$seed" --draw "$host_mutants"
step "benches" ctest --test-dir build/release --output-on-failure --no-tests=error -R "^bench/"
((list)) && exit 0

page=$folder/page.md
{
  printf '# Nightly, %s\n\n' "$(date -u '+%Y-%m-%d %H:%M UTC')"
  printf 'On %s, %d cores. + behind a commit: files were changed.\n\n' "$(uname -m)" "$jobs"
  printf '| step | verdict | min:s | commit | last line |\n|---|---|--:|---|---|\n'
  cat "$folder"/rows/* 2> /dev/null
} > "$page"
echo "$page"
if ((!chosen)); then
  echo "nightly.sh: error: no step matches '$steps'" >&2
  failed=1
fi
exit $failed
