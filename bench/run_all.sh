#!/bin/bash
# Builds the benches, runs them all and rewrites docs/benchmarks.md with its tables and plots. Takes
# over an hour on two cores; the machine should do nothing else.
# Usage: bench/run_all.sh [--repeats N] [--seconds-per-case S] [--quick]
#   PHOTILE_DEVICE          the OpenCL device, as for photile --device
#   PHOTILE_SHARED_SCENES   folder with classroom/; default: ../shared/scenes, left out if missing
set -euo pipefail
cd "$(dirname "$0")/.."
benches=(knn paper build frame relight)

/usr/bin/python3 -c 'import matplotlib' 2>/dev/null || {
  echo "bench/run_all.sh: error: no matplotlib; install the Debian package python3-matplotlib" >&2
  exit 1
}
cmake --preset release >/dev/null
cmake --build --preset release --target "${benches[@]/#/photile_bench_}"
mkdir -p docs/benchmarks
for bench in "${benches[@]}"; do
  "build/release/bench/photile_bench_$bench" --output "docs/benchmarks/$bench.json" "$@"
done
exec /usr/bin/python3 bench/report.py
