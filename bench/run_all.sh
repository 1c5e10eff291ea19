#!/bin/bash
# Builds the benches, runs them all and writes a page with their tables and plots. Takes about an hour
# on two cores; the machine should do nothing else.
# Usage: bench/run_all.sh [option]...
#   --quick                 tiny sizes: shows that everything works, times nothing
#   --full                  scale up to 4 million triangles and 100 million photons (24 GB)
#   --results FOLDER        where JSON files and plots go, and the page beside it as FOLDER.md;
#                           default: build/benchmarks
#   --docs                  rewrites docs/measured/benchmarks.md and what belongs to it
#   --benches FOLDER        where the benches are; nothing is built then
#   --repeats N, --seconds-per-case S   as for each bench that repeats its cases
#   PHOTILE_DEVICE          the OpenCL device, as for photile --device
#   PHOTILE_SHARED_SCENES   folder with classroom/; default: ../shared/scenes, left out if missing
set -euo pipefail
cd "$(dirname "$0")/.."
results=build/benchmarks benches=
options=() repeats=() profile_options=() scale_options=()
while (($#)); do
  case $1 in
    --quick) options+=("$1") profile_options+=("$1") ;;
    --full) scale_options+=("$1") ;;
    --results) results=$2 && shift ;;
    --docs) results=docs/measured/benchmarks ;;
    --benches) benches=$2 && shift ;;
    --repeats | --seconds-per-case) repeats+=("$1" "$2") && shift ;;
    *) echo "bench/run_all.sh: error: unknown option '$1'; see the head of the file" >&2 && exit 2 ;;
  esac
  shift
done

/usr/bin/python3 -c 'import matplotlib' 2>/dev/null || {
  echo "bench/run_all.sh: error: no matplotlib; install the Debian package python3-matplotlib" >&2
  exit 1
}
programs=(angle knn paper build frame relight lights kernels startup scale borders area)
if [[ -z $benches ]]; then
  benches=build/release/bench
  cmake --preset release >/dev/null
  cmake --build --preset release --target "${programs[@]/#/photile_bench_}" photile_profiled_estimate
fi
mkdir -p "$results"
for bench in "${programs[@]}"; do
  extra=()
  [[ $bench == scale ]] && extra=("${scale_options[@]}")
  [[ $bench =~ ^(angle|borders|scale)$ ]] || extra+=("${repeats[@]}")
  "$benches/photile_bench_$bench" --output "$results/$bench.json" "${options[@]}" "${extra[@]}"
done
# Lists by libraries of Python, where those and photile's module can be imported.
if PYTHONPATH=$PWD/build/release/python /usr/bin/python3 -c 'import photile, scipy' 2> /dev/null; then
  sizes=()
  [[ ${options[*]} == *--quick* ]] && sizes=(--photons 2000 --queries 4096 --repeats 1)
  PYTHONPATH=$PWD/build/release/python /usr/bin/python3 bench/rivals/python_neighbours.py \
    --output "$results/python_neighbours.json" "${sizes[@]}"
else
  echo "bench/run_all.sh: lists by Python's libraries are left out: install scipy, pykdtree and open3d, and build photile's module" >&2
fi
bench/kernels/profile.py --benches "$benches" --output "$results/profile.json" "${profile_options[@]}"
if [[ $results == docs/measured/benchmarks ]]; then
  for section in borders area angle; do bench/kernels/report_$section.py; done
fi
exec /usr/bin/python3 bench/kernels/report.py --results "$results" --page "$results.md"
