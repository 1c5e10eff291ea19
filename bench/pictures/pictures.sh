#!/bin/bash
# Makes the pictures of README.md and docs/ anew, with build/release: the living room, the edges of maps,
# the live page, the cells of light maps, the worked example and the gallery.
# Takes about an hour, nearly all of it for the paths that the gallery is compared with, and 8 GiB.
# Needs, beyond cmake/setup.sh, the built target photile_bench_light_maps.
# Usage: bench/pictures/pictures.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
photile=build/release/photile
pictures=docs/pictures
bare="document.querySelectorAll('body > :not(canvas)').forEach((part) => { part.style.visibility = 'hidden'; });"

# The photon estimate alone: few photons for so many neighbours make the dark edges wide, many
# neighbours make the rest calm.
for maps in naive triangle; do
  "$photile" render scenes/cornell-box/cornell-box.gltf --set light_map_rays=0 --set "maps=$maps" \
    --size 960x960 --samples 16 --photons 200k --neighbours 1000 --quiet -o "$pictures/$maps.png"
done

# A click reads the light on the table.
bench/pictures/page_shot.py "$pictures/view.png" --size 1120x700 --then "page.point(660, 480)" -- \
  scenes/living-room/living-room.gltf

# The photon map of a triangle of the right wall: few photons, so that they can be told apart.
bench/pictures/page_shot.py "$pictures/photon-map.png" --size 960x720 \
  --then "page.live.photons.turn(true); page.live.photons.click(660, 480); $bare" -- \
  scenes/cornell-box/cornell-box-specular.gltf --samples 1 --photons 30k

build/release/bench/photile_bench_light_maps --only "living room" --paths 1000000 \
  --nodes "$pictures/light-map-nodes.png" > /dev/null

bench/lighting/worked_example.py
bench/pictures/gallery.py
