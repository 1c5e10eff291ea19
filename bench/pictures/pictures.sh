#!/bin/bash
# Makes the pictures of README.md and docs/ anew, with build/release: the living room, the edges of maps,
# the window, the cells of light maps, the worked example and the gallery.
# Takes about an hour, nearly all of it for the paths that the gallery is compared with, and 8 GiB.
# Needs, beyond cmake/setup.sh, the built target photile_bench_light_maps.
# Usage: bench/pictures/pictures.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
photile=build/release/photile
pictures=docs/pictures
outputs=$(mktemp -d)
trap 'rm -rf "$outputs"' EXIT

# The photon estimate alone: few photons for so many neighbours make the dark edges wide, many
# neighbours make the rest calm.
for maps in naive triangle; do
  "$photile" render scenes/cornell-box/cornell-box.gltf --set light_map_rays=0 --set "maps=$maps" \
    --size 960x960 --samples 16 --photons 200k --neighbours 1000 --quiet -o "$pictures/$maps.png"
done

# window TITLE SCREENSHOTS PLACE... -- OPTION...: opens a window with these options on a screen in memory
# until its title is TITLE, clicks at the places, and keeps a screenshot after each of the last
# SCREENSHOTS clicks. Buttons are held for longer than the window takes to be drawn.
window() {
  export title=$1 screenshots=$2 places="" outputs photile
  shift 2
  while [ "$1" != -- ]; do
    places+=" ${1/ /,}"
    shift
  done
  shift
  rm -f "$outputs"/screenshot-*
  xvfb-run --auto-servernum --server-args "-screen 0 1280x960x24 -noreset" bash -c '
    "$photile" view "$@" --outputs "$outputs" --quiet &
    process=$!
    until xdotool search --name "$title" > /dev/null; do sleep 1; done
    left=$(wc -w <<< "$places")
    for place in $places; do
      xdotool mousemove ${place/,/ }; sleep 0.4
      xdotool mousedown 1; sleep 0.4
      xdotool mouseup 1; sleep 2
      if ((left-- > screenshots)); then continue; fi
      until xdotool search --name "$title" > /dev/null; do sleep 1; done
      xdotool keydown F12; sleep 0.4; xdotool keyup F12; sleep 2
    done
    kill "$process"  # Ctrl+Q would ask about luminaires that are not saved
    wait' - "$@"
}

# A click reads the light on the table, another shows illuminance.
window "16 of 16 samples, 0.5M" 2 "707 512" "98 523" -- \
  scenes/living-room/living-room.gltf --size 960x720 --quality good
mv "$outputs/screenshot-0001.png" "$pictures/view.png"
mv "$outputs/screenshot-0002.png" "$pictures/view-illuminance.png"

# The photon map of a triangle of the right wall: few photons, so that they can be told apart.
window "1 of 1 samples, 0.03M" 1 "17 344" "1020 495" -- \
  scenes/cornell-box/cornell-box-specular.gltf --size 960x720 --samples 1 --photons 30k
mv "$outputs/screenshot-0001.png" "$pictures/photon-map.png"

# The sun of a morning in a room without lamps; the click is on the panel.
window "4 of 4 samples, 0.5M" 1 "150 120" -- scenes/gallery/sun-and-sky.gltf --size 960x720 --samples 4 \
  --quality good --site 52.5,13.4,1 --time 2026-06-21T09:00
mv "$outputs/screenshot-0001.png" "$pictures/view-daylight.png"

# The same room with a lamp that two clicks place, on "place" and under the ceiling.
cp scenes/gallery/downlight.ies "$outputs"
window "4 of 4 samples, 0.5M" 1 "28 198" "780 25" "150 120" -- scenes/gallery/sun-and-sky.gltf \
  --size 960x720 --samples 4 --quality good --luminaires "$outputs/lamps.json"
mv "$outputs/screenshot-0001.png" "$pictures/view-luminaires.png"

build/release/bench/photile_bench_light_maps --only "living room" --paths 1000000 \
  --nodes "$pictures/light-map-nodes.png" > /dev/null

bench/lighting/worked_example.py
bench/pictures/gallery.py
