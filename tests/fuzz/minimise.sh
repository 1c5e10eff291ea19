#!/bin/bash
# Brings what a soak has found into the repository: of it and of the inputs that the repository has, the
# smallest set that covers what they cover together, and of those no more than a size. The set becomes
# tests/fuzz/corpus/TARGET.tar.xz, and tests/fuzz/archived_inputs.txt says how many inputs it has. Inputs
# that bear a name, in tests/fuzz/corpus/TARGET, stay as they are: they are seeds and former findings.
# The same inputs give the same archive, byte by byte. Needs the build of the preset "fuzzers".
#
#   tests/fuzz/minimise.sh TARGET...
set -euo pipefail
cd "$(dirname "$0")/../.."
fuzzers=build/fuzzers/tests/fuzz
counts=tests/fuzz/archived_inputs.txt
most_bytes=4096  # of an input: larger ones are left to the soak
declare -A fewer=([glb]=1400 [relight]=2400)  # most of theirs are large
for target in "$@"; do
  named=tests/fuzz/corpus/$target
  archive=$PWD/$named.tar.xz
  soaked=build/soak/$target
  merged=$(mktemp -d)
  mkdir -p "$soaked"
  PHOTILE_FUZZ_TARGET=$target nice -n 19 "$fuzzers/photile_fuzz" -merge=1 \
    -timeout=10 -max_len=$most_bytes "$merged" "$named" "$fuzzers/corpus/$target" "$soaked" \
    > /dev/null 2>&1
  find "$merged" -type f \( -size "+${fewer[$target]:-$most_bytes}c" -o -empty \) -delete
  for input in "$named"/*; do  # inputs are named by their hashes
    rm -f "$merged/$(sha1sum < "$input" | cut -d' ' -f1)"
  done
  (cd "$merged"
   find . -type f -printf '%f\n' | LC_ALL=C sort |
     tar --format=ustar --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 -cf - -T - |
     xz -9e -T1 > "$archive")
  count=$(find "$merged" -type f | wc -l)
  awk -v target="$target" '$1 != target' "$counts" > "$counts.tmp"
  { cat "$counts.tmp"; echo "$target $count"; } | LC_ALL=C sort > "$counts"
  rm -r "$counts.tmp" "$merged"
  echo "$target: $count inputs, $(stat -c %s "$archive") bytes as an archive"
done
