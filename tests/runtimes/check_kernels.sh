#!/bin/bash
# Runs kernels under one of Oclgrind's checks. Oclgrind exits with 0 even after errors, so a log
# that is not empty is the failure.
#
#   check_kernels.sh CHECK FINGERPRINT LOG OCLGRIND_LAYER ARGUMENT_OF_FINGERPRINT...
#
# CHECK is races (memory, data races and use of the API, in kernels compiled as always) or
# uninitialised. The latter crashes in Oclgrind 21.10 on the shuffles with undefined lanes that LLVM
# makes of three-component vectors, so it runs without optimisation and keeps those as they are; and
# it loses track of comparisons of vectors, so it runs the kernels' scalar variant, that of GPUs.
set -euo pipefail
check=$1 fingerprint=$2 log=$3 layer=$4
[ -e "${PHOTILE_OCLGRIND_ICD:-}" ] || { echo "skipped: no Oclgrind; apt-get install oclgrind"; exit 77; }
cache=$(mktemp -d)
trap 'rm -rf "$cache"' EXIT
export XDG_CACHE_HOME=$cache OCL_ICD_VENDORS=$PHOTILE_OCLGRIND_ICD
export OCLGRIND_LOG=$log OCLGRIND_MAX_ERRORS=20 OCLGRIND_CHECK_API=1
case $check in
  races)
    export OCLGRIND_DATA_RACES=1
    ;;
  uninitialised)
    export OCLGRIND_UNINITIALIZED=1 OCLGRIND_BUILD_OPTIONS='-O0 -fpreserve-vec3-type -UVECTOR_WIDTH'
    export OPENCL_LAYERS=$layer
    ;;
esac
rm -f "$log"
"$fingerprint" "${@:5}"
if [ -s "$log" ]; then
  cat "$log" >&2
  exit 1
fi
