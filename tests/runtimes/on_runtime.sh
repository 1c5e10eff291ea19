#!/bin/bash
# Runs a test program on one OpenCL runtime alone, with a folder of compiled kernels of its own.
#
#   on_runtime.sh CACHE RUNTIME[,VARIABLE=VALUE]... [COMMAND [ARGUMENT]...]
#
# RUNTIME is pocl, oclgrind, or other: each folder of .icd files in PHOTILE_TEST_RUNTIMES (separated
# by colons), by default the one that cmake/fetch.sh intel-runtime makes. pocl+other is PoCL together
# with each of those, as two platforms. The variables are set for the command, which has to load the
# layer where OPENCL_LAYERS is one of them. CACHE is the folder below which compiled kernels are kept
# between runs. Without a command nothing is run. Exit code 77 says that the runtime is not installed:
# ctest counts the test as skipped.
set -euo pipefail
skip() {
  echo "skipped: $*"
  exit 77
}
cache=$1
IFS=, read -ra setting <<<"$2"
shift 2
runtime=${setting[0]}
variables=("${setting[@]:1}")

# run VENDORS LIBRARIES COMMAND...: VENDORS as the OpenCL loader takes it, LIBRARIES a folder that
# the runtime's libraries need to find each other, or nothing.
run() {
  local vendors=$1 libraries=$2
  shift 2
  [ $# -gt 0 ] || return 0
  # Only the runtime and its own settings decide what is compiled: layers around it, and parts of its
  # device, share the kernels.
  local compiled='' layer='' variable name
  for variable in ${variables[@]+"${variables[@]}"}; do
    case $variable in
      POCL_* | CL_CONFIG_*) compiled+=" $variable" ;;
      OPENCL_LAYERS=*) layer=${variable#*=} ;;
    esac
  done
  name=$(printf '%s' "$runtime$vendors$compiled" | cksum | cut -d' ' -f1)
  local own=$cache/$name/libraries library
  mkdir -p "$own"
  # Intel's runtime brings a loader of its own beside its libraries, which rejects layers: the system's
  # is used.
  for library in ${libraries:+"$libraries"/*.so*}; do
    case ${library##*/} in libOpenCL.so*) ;; *) ln -sf "$library" "$own" ;; esac
  done
  local loaded=$cache/$name/layer.$$
  env XDG_CACHE_HOME="$cache/$name" OCL_ICD_VENDORS="$vendors" PHOTILE_LAYER_MARK="$loaded" \
    ${libraries:+LD_LIBRARY_PATH="$own"} "${variables[@]}" "$@"
  # An OpenCL loader passes over a layer that it cannot load.
  if [ -n "$layer" ]; then
    rm "$loaded" || { echo "on_runtime.sh: error: $layer was not loaded" >&2 && exit 1; }
  fi
}

case $runtime in
  pocl)
    [ -e /etc/OpenCL/vendors/pocl.icd ] || skip "no PoCL; apt-get install pocl-opencl-icd"
    run /etc/OpenCL/vendors/pocl.icd '' "$@"
    ;;
  oclgrind)
    [ -e "${PHOTILE_OCLGRIND_ICD:-}" ] || skip "no Oclgrind; apt-get install oclgrind"
    run "$PHOTILE_OCLGRIND_ICD" '' "$@"
    ;;
  other | pocl+other)
    [ "$runtime" = other ] || [ -e /etc/OpenCL/vendors/pocl.icd ] || skip "no PoCL; apt-get install pocl-opencl-icd"
    found=0
    IFS=: read -ra folders <<<"${PHOTILE_TEST_RUNTIMES:-$PHOTILE_INTEL_RUNTIME}"
    for folder in "${folders[@]}"; do
      [ -d "$folder" ] || continue
      found=1
      vendors=$folder
      if [ "$runtime" = pocl+other ]; then
        vendors=$cache/pocl+other
        mkdir -p "$vendors"
        cp /etc/OpenCL/vendors/pocl.icd "$folder"/*.icd "$vendors"
      fi
      run "$vendors" "$(dirname "$(cat "$folder"/*.icd | head -n 1)")" "$@"
    done
    [ $found = 1 ] || skip "no OpenCL runtime but Debian's; cmake/fetch.sh intel-runtime brings one"
    ;;
  *)
    echo "on_runtime.sh: error: unknown runtime '$runtime'" >&2
    exit 2
    ;;
esac
