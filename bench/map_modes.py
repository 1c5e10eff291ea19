#!/usr/bin/env python3
"""Maps of triangles against maps of patches on finely tessellated scenes, as a Markdown table.

Renders each scene with each mode several times, modes taking turns, and keeps the median of each
figure. Usage: bench/map_modes.py [--repeats N]
  PHOTILE_SHARED_SCENES   folder with kitchen/ and classroom/; default: ../shared/scenes
"""
import argparse
import json
import os
import statistics
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SHARED = Path(os.environ.get("PHOTILE_SHARED_SCENES", ROOT.parent / "shared/scenes"))
SCENES = [
    ("living room", ROOT / "scenes/living-room/living-room.gltf"),
    ("kitchen", SHARED / "kitchen/kitchen-diffuse.gltf"),
    ("classroom", SHARED / "classroom/classroom-diffuse.gltf"),
]
MODES = ["triangle", "patch", "auto"]
RADIUS = 0.1  # metres


def render(scene: Path, mode: str, folder: Path) -> dict:
    """The figures of one run, by name."""
    stats = folder / "stats.json"
    subprocess.run(
        [ROOT / "build/release/photile", "render", scene, "--maps", mode, "--radius", str(RADIUS),
         "--photons", "300k", "--size", "512x512", "--samples", "1", "--quiet",
         "-o", folder / "picture.exr", "--stats", stats],
        check=True)
    stages = {stage["stage"]: stage for stage in json.loads(stats.read_text())["stages"]}
    maps, groups = stages["build photon maps"], stages["neighbour groups"]
    return {
        "references a photon": maps["figures"]["references per photon"],
        "maps": maps["figures"]["maps"],
        "groups, MiB": groups["host_bytes"] / 2**20,
        "maps, MiB": maps["device_bytes"] / 2**20,
        "groups, s": groups["seconds"],
        "build, s": maps["seconds"] - maps["figures"]["kernel compilation seconds"],
        "frame, ms": 1e3 * (stages["primary hits"]["seconds"] +
                            stages["radiance estimate"]["seconds"]),
        "us a hit": stages["radiance estimate"]["figures"]["microseconds per hit"],
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    repeats = parser.parse_args().repeats
    header = None
    for name, scene in SCENES:
        if not scene.exists():
            print(f"(no {name}: {scene.name} is missing)")
            continue
        runs = {mode: [] for mode in MODES}
        with tempfile.TemporaryDirectory() as folder:
            render(scene, MODES[0], Path(folder))  # compiles kernels, fills the disk cache
            for _ in range(repeats):
                for mode in MODES:
                    runs[mode].append(render(scene, mode, Path(folder)))
        for mode in MODES:
            figures = {key: statistics.median(run[key] for run in runs[mode])
                       for key in runs[mode][0]}
            if header is None:
                header = ["scene", "`--maps`", *figures]
                print("| " + " | ".join(header) + " |")
                print("|---|---|" + "--:|" * len(figures))
            cells = [f"{value:.0f}" if value >= 100 else f"{value:.3g}"
                     for value in figures.values()]
            print(f"| {name} | {mode} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
