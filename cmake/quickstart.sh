#!/bin/bash
# Installs what is needed, builds photile and renders a bundled scene to out/living-room.exr and
# out/living-room.png.
# Usage: cmake/quickstart.sh [OPTION OF photile render]...
set -euo pipefail
cd "$(dirname "$0")/.."
cmake/setup.sh
cmake/build.sh release photile_command  # tests and benches take twice as long again
mkdir -p out
build/release/photile render scenes/living-room/living-room.gltf \
  -o out/living-room.exr -o out/living-room.png "$@"
echo "out/living-room.exr and out/living-room.png are ready"
