#!/usr/bin/python3
"""Measures photile's accuracy and writes docs/accuracy.md.

    bench/pictures/accuracy.py [SCENES] [--redraw] [--only validation|consistency]

Runs `photile validate`, and renders three views with more and more photons beside path-traced
references. SCENES is the folder that holds kitchen/ and references/. Takes tens of minutes. Needs
the built command and the Debian packages python3-matplotlib, python3-numpy and python3-openimageio.
"""

import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages, scene_arguments

packages.require("matplotlib", "numpy", "OpenImageIO")

import numpy as np

from tools import picture_error, plots

RESULTS = ROOT / "docs/accuracy"
PHOTONS = [10_000 * 4**i for i in range(5)]
LEAST_NEIGHBOURS = 12
REFERENCE_SAMPLES = 512


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--only", choices=("validation", "consistency"),
                        help="measure this alone, and take the other from docs/accuracy")
    parser.add_argument("--redraw", action="store_true",
                        help="use the results in docs/accuracy instead of measuring")
    return parser.parse_args()


def validation(photile, file):
    """Runs photile validate; a reading that is not within 1% is a result, not an error."""
    done = subprocess.run([photile, "validate", "--json", file], check=False)
    if done.returncode not in (0, 1) or not file.is_file():
        sys.exit(f"accuracy.py: error: photile validate ended with {done.returncode}")


def views(scenes):
    """Name, scene, size and reference (None: to be path-traced) of each view."""
    return (("Cornell box", ROOT / "scenes/cornell-box/cornell-box.gltf", "96x96", None),
            ("living room", ROOT / "scenes/living-room/living-room.gltf", "128x96", None),
            ("kitchen", scenes / "kitchen/kitchen-diffuse.gltf", "256x192",
             scenes / "references/kitchen-diffuse-256x192.exr"))


def neighbours(photons):
    """k, growing as the photons to the power 2/3."""
    return round(LEAST_NEIGHBOURS * (photons / PHOTONS[0]) ** (2 / 3))


def render(photile, scene, size, picture, *options):
    subprocess.run([photile, "render", scene, "--size", size, "-o", picture, "--quiet", *options],
                   check=True)
    return picture_error.read_picture(picture)


def consistency(photile, scenes):
    """Errors of each view against photons."""
    out = ROOT / "out/accuracy"
    out.mkdir(parents=True, exist_ok=True)
    results = []
    for name, scene, size, reference_file in views(scenes):
        if reference_file is None:
            reference = render(photile, scene, size, out / "reference.exr", "--integrator", "path",
                               "--samples", str(REFERENCE_SAMPLES), "--seed", "1001")
        else:
            reference = picture_error.read_picture(reference_file)
        for photons in PHOTONS:
            k = neighbours(photons)
            picture = render(photile, scene, size, out / "picture.exr", "--set", "light_maps=off",
                             "--photons", str(photons),
                             "-k", str(k), "--samples", "16", "--set", "quota=power")
            error = picture_error.measure(picture, reference)
            results.append({"view": name, "photons": photons, "k": k, **error})
            print(name, photons, k, error["rel_mse"], error["rel_mse_without_worst"], flush=True)
    return results


def slope(rows, key):
    """Of the logarithm of the error over that of the photons, by least squares."""
    x, y = (np.log([row[name] for row in rows]) for name in ("photons", key))
    return np.polyfit(x, y, 1)[0]


def draw(results, file):
    names = list(dict.fromkeys(row["view"] for row in results))
    figure, axes = plots.panels(len(names), "k grows as the photons to the power 2/3")
    for axis, name in zip(axes, names):
        rows = [row for row in results if row["view"] == name]
        photons = np.array([row["photons"] for row in rows], dtype=float)
        for key, label, colour in (("rel_mse", "relMSE", plots.COLOURS[0]),
                                   ("rel_mse_without_worst", "without the worst 5%",
                                    plots.COLOURS[3])):
            axis.plot(photons, [row[key] for row in rows], "-o", color=colour, label=label,
                      markersize=4)
        axis.plot(photons, [1 / (row["k"] - 2) for row in rows], "--", color="#999999",
                  label="1 / (k - 2): noise alone")
        start = rows[0]["rel_mse"]
        axis.plot(photons, start * (photons / photons[0]) ** (-1 / 6), ":", color="#999999",
                  label="power -1/6: borders alone")
        plots.log_log(axis, name, "photon paths")
    axes[0].set_ylabel("relMSE")
    plots.legend_beside(axes)
    plots.save(figure, file)


def percent(measured):
    if measured is None:
        return "- | -"
    error, noise = 100 * measured["error"], 100 * measured["noise"]
    text = f"{error:+.2f} ± {noise:.2f}%"
    if measured["verdict"] == "MISSES":
        text = f"**{text}**"
    elif measured["verdict"] != "ok":
        text += " (too noisy)"
    return f"{measured['value']:.4g} | {text}"


def validation_table(record):
    rows = ["| case | reading | expected | photon maps | error | paths | error |",
            "|---|---|--:|--:|--:|--:|--:|"]
    last = None
    for row in record["readings"]:
        name = "" if row["case"] == last else row["case"]
        last = row["case"]
        rows.append(f"| {name} | {row['place']} | {row['expected']:.4g} {row['unit']} "
                    f"| {percent(row.get('photon_map'))} | {percent(row.get('path'))} |")
    return "\n".join(rows)


def sources(record):
    cases = {row["case"]: row["source"] for row in record["readings"]}
    return "\n".join(f"- {case}: {source}." for case, source in cases.items())


def counts(record, method):
    verdicts = [row[method]["verdict"] for row in record["readings"] if method in row]
    return (f"{verdicts.count('ok')} of {len(verdicts)} within 1%, {verdicts.count('MISSES')} beyond, "
            f"{verdicts.count('too noisy')} too noisy to tell")


def consistency_table(results):
    rows = ["| view | photons | k | relMSE | without the worst 5% | mean ratio |",
            "|---|--:|--:|--:|--:|--:|"]
    for row in results:
        rows.append(f"| {row['view']} | {row['photons']:,} | {row['k']} | {row['rel_mse']:.4f} "
                    f"| {row['rel_mse_without_worst']:.4f} | {row['mean_ratio']:.3f} |")
    return "\n".join(rows)


def slopes(results):
    lines = ["| view | power, all pixels | power, without the worst 5% |", "|---|--:|--:|"]
    for name in dict.fromkeys(row["view"] for row in results):
        rows = [row for row in results if row["view"] == name]
        lines.append(f"| {name} | {slope(rows, 'rel_mse'):.2f} "
                     f"| {slope(rows, 'rel_mse_without_worst'):.2f} |")
    return "\n".join(lines)


def seeds(record):
    """"16 to 58"."""
    counts_of_seeds = [row[method]["seeds"] for row in record["readings"] for method in ("photon_map", "path")]
    return f"{min(counts_of_seeds)} to {max(counts_of_seeds)}"


def page(record, results):
    return f"""# Accuracy

After this page you know how far photile's light is from closed forms, and how its error falls with the number of
photons. `bench/pictures/accuracy.py` writes this page.

## Closed forms

`photile validate` measures light that is known, through the code that renders:
seeds of {record['photons'] / 1e6:.3g}M photon paths with k = {record['neighbours']}, and of {record['paths'] / 1e3:.0f}k paths from
the points, {seeds(record)} of them, as many as the noise of a case asks for. Means over whole rooms take a share of
the photons and of k. Error and noise are relative; the noise is half the 99% confidence interval of the mean over the
seeds. Bold errors are beyond 1%.

Photon maps: {counts(record, 'photon_map')}.
Paths: {counts(record, 'path')}.

{validation_table(record)}

Where the values come from:

{sources(record)}

The scenes that follow CIE 171:2006 have its kind of light and surface, not its dimensions: expected
values are computed from form factors, since some of the printed tables are wrong (table 19 of case 5.7,
and others: Ashdown, [CIE 171:2006 errata](https://lightinganalysts.com/cie-1712006-errata)). Its cases of
skies, windows and luminaires with measured photometry are not among these. Means over whole walls include
edges and corners.

## More photons

Three views beside path-traced references: {REFERENCE_SAMPLES:,} samples a pixel by `--integrator path`, for
the kitchen those of another renderer. k grows as the photons to the power 2/3, so that noise and
bias both vanish.

![relMSE against photons](accuracy/consistency.svg)

In theory the noise of a density from the k-th distance is 1 / (k - 2), which falls with the power -2/3;
where irradiance is smooth the squared bias falls with the same power; at the borders of shadows and surfaces
only the area of the bias falls, with the power -1/6. Pictures are a mixture, and the worst pixels are those of
borders. The references' own noise is in every error: it is the floor on which the curves end.

{slopes(results)}

{consistency_table(results)}

The mean of the kitchen stays below that of its reference whatever the number of photons. relMSE is that of [the references](references.md). `tests/validation` tests the first of
these laws on an evenly lit plate, the slope -2/3 within 0.1, with the noise of 16 seeds.

## See also

[Validate on the command line](command-line.md#photile-validate), [trade](trade.md),
[beside path-traced references](references.md).
"""


SEE_ALSO = "## See also"


def by_hand(text):
    """The section of the page that is not measured here."""
    begin = text.find("## Light that few photons find")
    return text[begin:text.index(SEE_ALSO)] if begin >= 0 else ""


def main():
    options = arguments()
    if not options.redraw and not options.photile.is_file():
        sys.exit(f"accuracy.py: error: {options.photile} is missing; build it with cmake/build.sh")
    RESULTS.mkdir(parents=True, exist_ok=True)
    readings, errors = RESULTS / "validation.json", RESULTS / "consistency.json"
    if not options.redraw and options.only != "consistency":
        validation(options.photile, readings)
    if not options.redraw and options.only != "validation":
        errors.write_text(json.dumps(consistency(options.photile, options.scenes), indent=1) + "\n")
    results = json.loads(errors.read_text())
    draw(results, RESULTS / "consistency.svg")
    of_page = ROOT / "docs/accuracy.md"
    kept = by_hand(of_page.read_text())
    of_page.write_text(page(json.loads(readings.read_text()), results).replace(SEE_ALSO, kept + SEE_ALSO))


if __name__ == "__main__":
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"accuracy.py: error: {error}")
