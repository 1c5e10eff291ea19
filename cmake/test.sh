#!/bin/bash
# Installs what is needed, builds photile and runs every test but the slow ones (those run by
# ctest --preset slow).
# Usage: cmake/test.sh [OPTION OF ctest]...
set -euo pipefail
cd "$(dirname "$0")/.."
cmake/setup.sh
cmake/build.sh release
exec ctest --preset release --parallel "$(nproc)" "$@"
