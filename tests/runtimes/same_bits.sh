#!/bin/bash
# Compares what photile_fingerprint prints on a runtime with what it prints on PoCL as it comes.
#
#   same_bits.sh FINGERPRINT CACHE RUNTIME[,VARIABLE=VALUE]... [ARGUMENT OF FINGERPRINT]...
#
# Exit code 77: one of the two is not installed.
set -euo pipefail
fingerprint=$1
cache=$2
setting=$3
shift 3
folder=$(dirname "$0")
"$folder/on_runtime.sh" "$cache" "$setting"  # ends here where the runtime is not installed

# What PoCL prints is computed once for all tests that ask it the same.
expected=$cache/expected$(printf -- '-%s' "$@").txt
if [ ! "$expected" -nt "$fingerprint" ]; then
  mkdir -p "$cache"
  partial=$(mktemp "$expected.XXXXXX")
  trap 'rm -f "$partial"' EXIT
  "$folder/on_runtime.sh" "$cache" pocl "$fingerprint" "$@" >"$partial"
  mv "$partial" "$expected"
fi
lines=$(wc -l <"$expected")
# Several other runtimes print one fingerprint after another.
"$folder/on_runtime.sh" "$cache" "$setting" "$fingerprint" "$@" | {
  count=0
  while mapfile -t -n "$lines" block && [ ${#block[@]} -gt 0 ]; do
    diff "$expected" <(printf '%s\n' "${block[@]}")
    count=$((count + 1))
  done
  [ $count -gt 0 ]
  echo "$lines hashes agree, $count times"
}
