#!/bin/bash
# Renders the pictures of README.md to docs/pictures with build/release/photile.
# Needs 8 GiB of memory.
# Usage: docs/make_pictures.sh
set -euo pipefail
cd "$(dirname "$0")/.."
photile=build/release/photile
pictures=docs/pictures
mkdir -p "$pictures"

"$photile" render scenes/living-room/living-room.gltf --size 960x640 \
  -o "$pictures/living-room.png"

# The photon estimate alone: few photons for so many neighbours make the dark edges wide, many neighbours make the rest calm.
for maps in naive triangle; do
  "$photile" render scenes/cornell-box/cornell-box.gltf --quality draft --maps "$maps" \
    --size 400x400 --samples 16 --photons 200k --neighbours 1000 --quiet -o "$pictures/$maps.png"
done

# The window, on a screen in memory: a click reads the light on the table, another shows illuminance.
# Buttons are held for longer than the window takes to be drawn.
outputs=$(mktemp -d)
trap 'rm -rf "$outputs"' EXIT
export photile outputs
xvfb-run --auto-servernum --server-args "-screen 0 1280x960x24" bash -c '
  "$photile" view scenes/living-room/living-room.gltf --size 800x600 --quality good \
    --outputs "$outputs" --quiet &
  until xdotool search --name "16 of 16 samples, 0.5M"; do sleep 1; done
  for place in "560 470" "108 464"; do
    xdotool mousemove $place; sleep 0.4
    xdotool mousedown 1; sleep 0.4
    xdotool mouseup 1; sleep 2
    xdotool keydown F12; sleep 0.4; xdotool keyup F12; sleep 2
  done
  xdotool key ctrl+q
  wait'
mv "$outputs/screenshot-0001.png" "$pictures/view.png"
mv "$outputs/screenshot-0002.png" "$pictures/view-illuminance.png"

# The photon map of a triangle of the right wall: few photons, so that they can be told apart.
xvfb-run --auto-servernum --server-args "-screen 0 1280x960x24" bash -c '
  "$photile" view scenes/cornell-box/cornell-box-specular.gltf --size 640x480 --samples 1 \
    --photons 30k --outputs "$outputs" --quiet &
  until xdotool search --name "1 of 1 samples, 0.03M"; do sleep 1; done
  for place in "27 310" "480 330"; do
    xdotool mousemove $place; sleep 0.4
    xdotool mousedown 1; sleep 0.4
    xdotool mouseup 1; sleep 1
  done
  xdotool keydown F12; sleep 0.3; xdotool keyup F12; sleep 2
  xdotool key ctrl+q
  wait'
mv "$outputs/screenshot-0001.png" "$pictures/photon-map.png"
