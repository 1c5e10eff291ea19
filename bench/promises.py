#!/usr/bin/python3
"""Whether --target-error and --time-budget keep their promises: a table in docs/trade.md.

    bench/promises.py [SCENES] [--redraw] [--quick]

Renders the two diffuse interiors of SCENES, on which nothing of the model was fitted, and compares what
was asked for with what came out: the error against the references of SCENES, the time of a frame by
--stats. Takes minutes. Needs the built command and the Debian packages python3-numpy and
python3-openimageio.
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

import packages
import scene_arguments
from report_section import replace_section

packages.require("numpy", "OpenImageIO")

import numpy as np

import picture_error

ROOT = scene_arguments.ROOT
RESULTS = ROOT / "docs/trade/promises.json"
INTERIORS = ("kitchen", "classroom")
SIZE = "256x192"
ERRORS = (0.3, 0.2)
BUDGETS = (0.5,)  # seconds
FRAME_STAGES = ("primary hits", "light maps", "radiance estimate", "film")


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--redraw", action="store_true",
                        help="use the results in docs/trade instead of measuring")
    parser.add_argument("--quick", action="store_true",
                        help="one promise of each kind in the bundled Cornell box, not written down")
    return parser.parse_args()


def relative_error(picture, reference):
    """Root of relMSE over the pixels that neither see a lamp nor are next to one that does."""
    lamps = np.pad(~picture_error.without_lamps(reference), 1)
    rows, columns = reference.shape[:2]
    near = np.zeros((rows, columns), dtype=bool)
    for down in range(3):
        for right in range(3):
            near |= lamps[down:down + rows, right:right + columns]
    a, b = picture[~near], reference[~near]
    return float(np.sqrt(((a - b) ** 2 / (b**2 + 0.01 * b.mean() ** 2)).mean()))


def render(command, picture, stats):
    """Runs photile render; returns its statistics."""
    subprocess.run([*command, "--quiet", "--seed", "7", "-o", picture, "--stats", stats], check=True)
    return json.loads(stats.read_text(encoding="utf-8"))


def frame_seconds(record):
    return sum(stage["seconds"] for stage in record["stages"] if stage["stage"] in FRAME_STAGES)


def keep(photile, scene, size, reference, promise, folder):
    """Renders with the options of a promise; the settings chosen, what was expected, what came out.

    The frame is that of a second picture by the same settings, whose kernels need no compiling.
    """
    picture, stats = folder / "picture.exr", folder / "stats.json"
    command = [photile, "render", scene, "--size", size, "--quota", "power"]
    record = render([*command, *promise], picture, stats)
    error = relative_error(picture_error.read_picture(picture), reference)
    chosen = next(stage for stage in record["stages"] if stage["stage"] == "choose settings")
    expected, parameters = chosen["figures"], record["parameters"]
    photons, k, samples = (parameters[key] for key in
                           ("photons_emitted", "neighbours", "samples_per_pixel"))
    again = render([*command, "--quality", "draft", "--photons", str(photons), "-k", str(k),
                    "--samples", str(samples)], picture, stats)
    return {"photons": photons, "k": k, "samples": samples,
            "expected_error": expected["expected relative error"],
            "expected_frame": expected["expected frame seconds"],
            "error": error, "frame": frame_seconds(again)}


def promises(quick):
    """Key of what is promised, wanted, as options."""
    for error in ERRORS[:1] if quick else ERRORS:
        yield "error", error, ["--quality", "draft", "--target-error", f"{100 * error:g}%"]
    for budget in BUDGETS[:1] if quick else BUDGETS:
        yield "frame", budget, ["--time-budget", f"{1000 * budget:g}ms"]


def subjects(options, folder):
    """Name, scene, size and reference of each view."""
    if options.quick:
        scene, reference = ROOT / "scenes/cornell-box/cornell-box.gltf", folder / "reference.exr"
        subprocess.run([options.photile, "render", scene, "--size", "32x32", "--integrator", "path",
                        "--samples", "256", "--quiet", "-o", reference], check=True)
        return [("cornell-box", scene, "32x32", reference)]
    return [(name, options.scenes / name / f"{name}-diffuse.gltf", SIZE,
             options.scenes / "references" / f"{name}-diffuse-{SIZE}.exr") for name in INTERIORS]


def measure(options, folder):
    rows = []
    for view, scene, size, reference_file in subjects(options, folder):
        reference = picture_error.read_picture(reference_file)
        for promised, wanted, more in promises(options.quick):
            got = keep(options.photile, scene, size, reference, more, folder)
            rows.append({"view": view, "promised": promised, "wanted": wanted, **got})
            print(json.dumps(rows[-1]), flush=True)
    return rows


def amount(promised, value):
    return f"{100 * value:.0f}%" if promised == "error" else f"{1000 * value:.0f} ms"


def table(rows):
    lines = ["| scene | wanted | expected | got | kept | chosen |", "|---|--:|--:|--:|---|---|"]
    for row in rows:
        promised = row["promised"]
        kept = "yes" if row[promised] <= row["wanted"] else "**no**"
        values = " | ".join(amount(promised, value) for value in
                            (row["wanted"], row[f"expected_{promised}"], row[promised]))
        lines.append(f"| {row['view']} | {values} | {kept} | `--photons {row['photons']} "
                     f"-k {row['k']} --samples {row['samples']}` |")
    return "\n".join(lines)


def section(record):
    return (f"{table(record['results'])}\n\n{SIZE} pixels; {record['cores']} cores; load average "
            f"{record['load_average']:.0f}.\n")


def main():
    options = arguments()
    if not options.redraw:
        with tempfile.TemporaryDirectory() as folder:
            rows = measure(options, pathlib.Path(folder))
        if options.quick:
            print(table(rows))
            return
        record = {"bench": "promises", "cores": os.cpu_count(), "load_average": os.getloadavg()[1],
                  "results": rows}
        RESULTS.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    replace_section(ROOT / "docs/trade.md", "promises.py",
                    section(json.loads(RESULTS.read_text(encoding="utf-8"))))


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"promises.py: error: {error}")
