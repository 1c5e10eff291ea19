#!/usr/bin/python3
"""Maps of triangles against maps of patches on finely tessellated scenes, as a Markdown table.

Runs photile_bench_modes, in which modes take turns; medians. Usage: bench/kernels/map_modes.py [--repeats N]
  PHOTILE_SHARED_SCENES   folder with kitchen/ and classroom/; default: ../shared/scenes
"""
import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("PHOTILE_SHARED_SCENES", ROOT.parent / "shared/scenes"))
CLASSROOM = SHARED / "classroom/classroom-diffuse.gltf"
CASES = [  # and the paths; at 4 million, maps of the classroom's triangles would take 25 GB
    ("living room", ROOT / "scenes/living-room/living-room.gltf", 300_000, True),
    ("kitchen", SHARED / "kitchen/kitchen-diffuse.gltf", 300_000, True),
    ("classroom", CLASSROOM, 300_000, True),
    ("classroom", CLASSROOM, 1_000_000, True),
    ("classroom", CLASSROOM, 4_000_000, False),
]
RADIUS = 0.1  # metres


def measure(scene: Path, paths: int, triangles: bool, repeats: int) -> list:
    """The rows of photile_bench_modes."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "modes.json"
        subprocess.run(
            [ROOT / "build/release/bench/photile_bench_modes", scene, "--photons", str(paths),
             "--radius", str(RADIUS), "--repeats", str(repeats), "--output", output,
             "--triangles" if triangles else "--no-triangles"],
            check=True, stdout=subprocess.DEVNULL)
        return json.loads(output.read_text())["results"]


def figures(row: dict) -> dict:
    hits, estimate = (1e3 * row[f"processor time of {stage}"]["median"]
                      for stage in ("primary hits", "the estimate"))
    return {
        "photons": f"{row['photons'] / 1e6:.2f} M",
        "`maps`": row["maps"],
        "references a photon": row["references per photon"],
        "maps": row["number of maps"],
        "groups, MiB": row["groups bytes"] / 2**20,
        "maps, MiB": row["map bytes"] / 2**20,
        "groups, s": row["groups seconds"],
        "build, s": row["build seconds"],
        "frame, ms": 1e3 * row["frame"]["median"],
        "processor: hits, ms": hits,
        "estimate, ms": estimate,
        "estimate, ns a hit": 1e6 * estimate / row["hits"],
    }


def cell(value) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=15)
    repeats = parser.parse_args().repeats
    header = None
    for name, scene, paths, triangles in CASES:
        if not scene.exists():
            print(f"(no {name}: {scene.name} is missing)")
            continue
        for row in measure(scene, paths, triangles, repeats):
            values = figures(row)
            if header is None:
                header = ["scene", *values]
                print("| " + " | ".join(header) + " |")
                print("|---|--:|---|" + "--:|" * (len(values) - 2))
            print("| " + " | ".join([name, *map(cell, values.values())]) + " |", flush=True)


if __name__ == "__main__":
    main()
