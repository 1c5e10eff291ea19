#!/bin/bash
# Installs Intel's OpenCL runtime for CPUs into build/intel-runtime, where the tests find it. Optional:
# a second runtime to compare PoCL with. Needs python3-venv and pip's package index.
# Usage: cmake/setup-intel-runtime.sh
set -euo pipefail
folder=$(cd "$(dirname "$0")/.." && pwd)/build/intel-runtime
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet intel-opencl-rt intel-cmplr-lib-rt
library=$(find "$folder/venv" -name libintelocl.so | head -n 1)
[ -n "$library" ] || {
  echo "cmake/setup-intel-runtime.sh: error: intel-opencl-rt has no libintelocl.so" >&2
  exit 1
}
mkdir -p "$folder/icd"
echo "$library" >"$folder/icd/intel.icd"
echo "Intel's OpenCL runtime is in $folder; ctest -L runtimes uses it"
