#!/bin/bash
# Installs the add-on for a Blender of its own and runs its test there. Without Blender the test is
# skipped and says so.
#   addon.sh PHOTILE SOURCE-FOLDER SCRATCH-FOLDER
set -eu
photile=$1 source=$2 scratch=$3/addon
command -v blender > /dev/null || {
  echo "skipped: there is no blender; apt-get install blender"
  exit 77
}
rm -rf "$scratch"
mkdir -p "$scratch/scripts/addons" "$scratch/config"
cp -r "$source/python/blender/photile" "$scratch/scripts/addons/photile"
export BLENDER_USER_SCRIPTS=$scratch/scripts BLENDER_USER_CONFIG=$scratch/config
blender -b --factory-startup --python-exit-code 1 \
  --python "$source/tests/blender/addon_test.py" -- "$photile" "$scratch" > "$scratch/log" 2>&1 ||
  { tail -n 30 "$scratch/log"; exit 1; }
grep "the add-on works" "$scratch/log" || { tail -n 30 "$scratch/log"; exit 1; }
