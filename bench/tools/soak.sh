#!/bin/bash
# Hours of what finds the next fault: every reader fuzzed, commands at random. Nothing here has an end
# by itself but the time that it is given.
#
#   bench/tools/soak.sh HOURS [TARGET...]
#
# TARGET: a folder of tests/fuzz/corpus, or "commands"; without one all, in turn. Needs the builds of
# the presets "fuzzers" (target photile_fuzz, which unpacks the corpus) and "release" (target
# photile_tests_property).
# What is found stays in build/soak: inputs as crash-*, timeout-*, oom-*; failed commands in
# commands.log. The corpora grow there and are kept from run to run; tests/fuzz/minimise.sh brings what
# is new in them into the archives of the repository.
set -euo pipefail
cd "$(dirname "$0")/../.."
if [[ $# -lt 1 || ! $1 =~ ^[0-9]+([.][0-9]+)?$ ]]; then
  sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
hours=$1
shift
targets=("$@")
if [[ ${#targets[@]} -eq 0 ]]; then
  targets=(commands)
  for folder in tests/fuzz/corpus/*/; do targets+=("$(basename "$folder")"); done
fi
# Rounded up: 0 would be no end.
seconds=$(awk "BEGIN { print 1 + int($hours * 3600 / ${#targets[@]}) }")

# Bytes of an input at most, as many as the format needs to show what it can: the time of an input
# grows with them.
declare -A longest=([options]=256 [schedules]=512 [points]=1024 [ies]=1024 [ldt]=1024)

mkdir -p build/soak
[[ -d /dev/shm ]] && export TMPDIR=/dev/shm # each input becomes a file, which no disk needs to see
failed=0
for target in "${targets[@]}"; do
  if [[ $target == commands ]]; then
    end=$((SECONDS + seconds)) seed=${PHOTILE_PROPERTIES_SEED:-1000}
    : > build/soak/commands.log
    while ((SECONDS < end)); do
      PHOTILE_PROPERTIES=100 PHOTILE_PROPERTIES_SEED=$seed nice -n 19 \
        build/release/tests/property/photile_tests_property >> build/soak/commands.log 2>&1 ||
        failed=1
      seed=$((seed + 100))
    done
    echo "commands: $((seed - ${PHOTILE_PROPERTIES_SEED:-1000})) tried"
    continue
  fi
  corpus=build/soak/$target
  mkdir -p "$corpus"
  # Neither entropic schedule nor value profile: with so many counters they take 50 times as long as
  # the readers.
  options=(-timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=256 -entropic=0
           "-max_len=${longest[$target]:-4096}")
  [[ -f tests/fuzz/$target.dict ]] && options+=("-dict=tests/fuzz/$target.dict")
  PHOTILE_FUZZ_TARGET=$target nice -n 19 build/fuzzers/tests/fuzz/photile_fuzz "${options[@]}" \
    -max_total_time="$seconds" -print_final_stats=1 -artifact_prefix="build/soak/$target-" \
    "$corpus" "tests/fuzz/corpus/$target" "build/fuzzers/tests/fuzz/corpus/$target" \
    > "build/soak/$target.log" 2>&1 || failed=1
  echo "$target: $(awk '/number_of_executed_units/ { print $2 }' "build/soak/$target.log") executions"
done
find build/soak -maxdepth 1 \( -name '*crash-*' -o -name '*timeout-*' -o -name '*oom-*' \) -print
exit $failed
