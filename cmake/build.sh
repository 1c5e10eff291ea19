#!/bin/bash
# Configures and builds a preset (default: release) with as many jobs as cores and memory allow.
# Usage: cmake/build.sh [PRESET [TARGET]...]
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
targets=("${@:2}")
if [ ${#targets[@]} -eq 0 ]; then targets=(all); fi

# The largest source files need about 1.5 GB each to compile.
available_kilobytes=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)
jobs=$((available_kilobytes / 1500000))
cores=$(nproc)
if [ "$jobs" -gt "$cores" ]; then jobs=$cores; fi
if [ "$jobs" -lt 1 ]; then jobs=1; fi

cmake --preset "$preset"
cmake --build --preset "$preset" --parallel "$jobs" --target "${targets[@]}"
