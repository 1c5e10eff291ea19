#!/bin/bash
# Writes tests/golden/*.json anew, and tells which tiles have changed, by how much. Look at them, and say
# in the commit why.
set -euo pipefail
cd "$(dirname "$0")/../.."
cmake/build.sh release photile_tests_golden
PHOTILE_RENEW_GOLDEN=1 build/release/tests/golden/photile_tests_golden
git diff --stat -- tests/golden
