#!/bin/bash
# Fetches from PyPI, Python's package index, into build/ what Debian 12 does not have:
#
#   denoiser        Open Image Denoise 2, which `photile render --denoise` loads (build/denoiser)
#   test-packages   numpy 2 and libraries that go with it, which tests of the Python module use (build/test-venv)
#   intel-runtime   Intel's OpenCL runtime for CPUs, which tests compare PoCL with (build/intel-runtime)
#
# What is there is kept. Exit code 1 where something cannot be had. Needs python3-venv.
# Usage: cmake/fetch.sh [--dry-run] PART...
set -euo pipefail
build=$(cd "$(dirname "$0")/.." && pwd)/build
dry_run=0
if [ "${1:-}" = --dry-run ]; then
  dry_run=1
  shift
fi

# venv FOLDER PACKAGE...: a virtual environment of Debian's Python with these packages.
venv() {
  local folder=$1
  shift
  rm -rf "$folder"
  /usr/bin/python3 -m venv "$folder" &&
    "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --retries 1 "$@"
}

# Each makes its folder whole, or fails.

# The libraries find each other in a folder of the name lib. Those for graphics cards stay behind, and
# oneTBB, which photile brings.
denoiser() {
  local parts='OpenImageDenoise\.so\.2$|OpenImageDenoise_core\.|OpenImageDenoise_device_cpu\.'
  venv "$1/venv" pyoidn && mkdir -p "$1/lib" &&
    find "$1/venv" -name 'lib*.so*' | grep -E "$parts" | xargs -I{} mv {} "$1/lib" &&
    rm -r "$1/venv" && [ -e "$1/lib/libOpenImageDenoise.so.2" ]
}

test-packages() {
  venv "$1" 'numpy>=2,<3' pytest OpenImageIO honeybee-radiance ifcopenshell
}

intel-runtime() {
  venv "$1/venv" intel-opencl-rt intel-cmplr-lib-rt && mkdir -p "$1/icd" &&
    find "$1/venv" -name libintelocl.so -print -quit >"$1/icd/intel.icd" && [ -s "$1/icd/intel.icd" ]
}

failed=0
for part in "$@"; do
  case $part in
    denoiser) folder=$build/denoiser for_what='Open Image Denoise 2, for --denoise' ;;
    test-packages) folder=$build/test-venv for_what='numpy 2, OpenImageIO, honeybee-radiance and ifcopenshell, for tests' ;;
    intel-runtime) folder=$build/intel-runtime for_what="Intel's OpenCL runtime, for tests" ;;
    *)
      echo "cmake/fetch.sh: error: there is no '$part'; denoiser, test-packages and intel-runtime are there" >&2
      exit 2
      ;;
  esac
  [ -e "$folder/complete" ] && continue
  echo "to fetch:   $part: $for_what (PyPI, into ${folder#"${build%/build}/"})"
  ((dry_run)) && continue
  rm -rf "$folder"
  mkdir -p "$folder"
  if "$part" "$folder"; then
    touch "$folder/complete"
  else
    rm -rf "$folder"
    echo "cmake/fetch.sh: error: $part was not fetched from PyPI; cmake/fetch.sh $part tries again" >&2
    failed=1
  fi
done
exit $failed
