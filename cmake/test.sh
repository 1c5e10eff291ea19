#!/bin/bash
# Installs what is needed, builds photile and runs every test but the slow ones (those run by
# ctest --preset slow). The last lines say how many tests were skipped, and why.
# Usage: cmake/test.sh [OPTION OF ctest]...
set -euo pipefail
cd "$(dirname "$0")/.."
cmake/setup.sh --tests --packages
cmake/fetch.sh denoiser test-packages intel-runtime & # while the compiler has the processor
fetching=$!
cmake/build.sh release
wait $fetching || true # it has said what is missing; tests that need it are skipped
results=$PWD/build/release/Testing/results.xml failed=0
ctest --preset release --parallel "$(nproc)" --output-junit "$results" \
  --test-output-size-passed 100000 "$@" || failed=$?
cmake/skipped_tests.py "$results"
exit $failed
