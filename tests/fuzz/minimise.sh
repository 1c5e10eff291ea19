#!/bin/bash
# Brings what a soak has found into the corpus of the repository: of both, the smallest set of inputs
# that covers what they cover together, and of those no more than a size. Inputs of the repository that
# bear a name (not a hash) are kept: they are seeds and former findings.
#
#   tests/fuzz/minimise.sh TARGET...
set -euo pipefail
cd "$(dirname "$0")/../.."
most_bytes=4096  # of an input: larger ones are left to the soak
declare -A fewer=([glb]=1400 [relight]=2400)  # most of theirs are large: 5 MB have to do for all targets
for target in "$@"; do
  corpus=tests/fuzz/corpus/$target
  merged=$(mktemp -d)
  PHOTILE_FUZZ_TARGET=$target nice -n 19 build/fuzzers/tests/fuzz/photile_fuzz -merge=1 \
    -timeout=10 -max_len=$most_bytes "$merged" "$corpus" "build/soak/$target" > /dev/null 2>&1
  find "$merged" -size "+${fewer[$target]:-$most_bytes}c" -delete
  find "$corpus" -regextype posix-extended -regex '.*/[0-9a-f]{40}' -delete
  for input in "$merged"/*; do
    cmp -s "$input" /dev/null || grep -qF "$(sha1sum < "$input")" \
      <(sha1sum "$corpus"/* | cut -d' ' -f1 | sed 's/$/  -/') || cp "$input" "$corpus/"
  done
  rm -r "$merged"
  echo "$target: $(find "$corpus" -type f | wc -l) files, $(du -sb "$corpus" | cut -f1) bytes"
done
