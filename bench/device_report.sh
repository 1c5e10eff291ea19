#!/bin/bash
# Tests and times photile on an OpenCL device: writes results/DEVICE-RUNTIME.json, of which
# docs/measured/devices.md has a row, and build/device-report/DEVICE-RUNTIME.md, a page to post. Ten minutes on
# a GPU, twenty on two cores. What fails is told, and the next part runs.
#
#   bench/device_report.sh [OPTION]...
#
#   --device SELECTOR   as for photile; default: the device that photile takes
#   --name NAME         of the files, in place of DEVICE-RUNTIME
#   --results FOLDER    in place of results/
#   --parts REGEX       only those whose names it finds, beside the last results of the others
#   --quick             tiny sizes and few k: for simulators; times nothing
#   --no-build          what is built is run: in a container of another system
#   --beside SELECTOR   whose picture is compared with; default: PoCL's, where it is there
set -uo pipefail
cd "$(dirname "$0")/.."
usage() {
  sed -n '2,/^set/{/^set/!s/^# \{0,1\}//p}' "$0" >&2
  exit 2
}
build=1 device=${PHOTILE_DEVICE:-} beside=portable parts=. quick=() names=() results=()
while (($#)); do
  case $1 in
    --device) device=${2:?--device needs a selector} && shift ;;
    --beside) beside=${2:?--beside needs a selector} && shift ;;
    --results) results=(--results "${2:?--results needs a folder}") && shift ;;
    --name) names=(--name "${2:?--name needs a name}") && shift ;;
    --parts) parts=${2:?--parts needs a regular expression} && shift ;;
    --no-build) build=0 ;;
    --quick) quick=(--quick) ;;
    *) usage ;;
  esac
  shift
done
release=build/release
layers=$release/tests/device/layers
limit=900 # seconds of a part: a driver may hang
((${#quick[@]})) && limit=3600
if ((build)); then
  cmake --preset release > /dev/null && cmake --build --preset release --target photile_command \
    photile_fence_layer photile_tests_maps photile_tests_estimate photile_bench_kernels || exit 1
fi

folder=${names[1]:-${device:-default}} selector=()
folder=build/device-report/${folder//[^A-Za-z0-9.-]/-}
if [[ $device ]]; then
  selector=(--device "$device")
  export PHOTILE_DEVICE=$device
fi
[[ $parts == . ]] && rm -rf "$folder"
mkdir -p "$folder/parts"
failed=0

# part NAME COMMAND...: with an empty cache, so that compilers have all to do; keeps what it printed,
# how it ended and how long it took.
part() {
  local name=$1 start=$SECONDS code=0
  shift
  [[ $name =~ $parts ]] || return 0
  rm -rf "$folder/cache"
  echo "device_report.sh: $name" >&2
  XDG_CACHE_HOME=$PWD/$folder/cache timeout -k 10 $limit "$@" > "$folder/$name.log" 2>&1 || code=$?
  printf '%s\n' "$name $code $((SECONDS - start))" > "$folder/parts/$name"
  if ((code)); then
    failed=1
    echo "device_report.sh: $name ended with $code: $(tail -n 1 "$folder/$name.log")" >&2
  fi
}

# oracle NAME PROGRAM CASES: tests against double precision, with guards around every buffer; simulators
# look at each access themselves, and Oclgrind 21.10 breaks on sub-buffers.
oracle() {
  local guards=(OPENCL_LAYERS="$PWD/$layers/libphotile_fence_layer.so" PHOTILE_FENCE=guard)
  ((${#quick[@]})) && guards=()
  part "$1" env "${guards[@]}" \
    "$release/tests/$2/photile_tests_$2" "$3" -r xml -o "$folder/$1.xml"
}

# picture NAME ARGUMENT...
picture() {
  part "$1" "$release/photile" render scenes/cornell-box/cornell-box.obj -o "$folder/$1.exr" \
    --quality draft --size 128x128 --set light_maps=off --set profile=on --stats "$folder/$1.json" "${@:2}"
}

part device "$release/photile" devices --json "${selector[@]}"
part test "$release/photile" devices --test "${selector[@]}"
oracle maps maps '~[slow]~[long]'
((${#quick[@]})) || oracle kinds estimate '[device]'
oracle structures estimate 'neighbours equal*'
picture picture "${selector[@]}"
((${#quick[@]})) && sizes=(--quick) || sizes=(--repeats 5)
part kernels "$release/bench/photile_bench_kernels" --plane "${sizes[@]}" --output "$folder/kernels.json"
if "$release/photile" devices --device "$beside" > /dev/null 2>&1; then
  picture beside --device "$beside"
  part compare "$release/photile" compare "$folder/beside.exr" "$folder/picture.exr" \
    --json "$folder/compare.json" -o "$folder/compare.png"
fi
bench/kernels/report_device.py "$folder" "${quick[@]}" "${names[@]}" "${results[@]}" || failed=1
exit $failed
