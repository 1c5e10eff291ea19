"""Scale: time and memory of each stage against triangles and photons."""

import math

from tools import plots
from kernels.report_tables import table

LEAST_SECONDS = 0.01  # shorter stages are noise
LEAST_POINTS = 3
TOLERANCE = 0.1  # of an exponent fitted to a handful of single runs
NAMES = {"ray tracing structure": "BVH", "trace photons": "trace", "neighbour groups": "groups",
         "build photon maps": "maps", "radiance estimate": "estimate"}


def curves(result):
    """Rows by (axis, mesh), ascending; failed ones last."""
    found = {}
    for row in result["results"]:
        found.setdefault((row["axis"], row["mesh"]), []).append(row)
    return found


def points_of(axis, rows, stage):
    """(size, seconds) of a stage."""
    return [(row[axis], record["seconds"]) for row in rows if "failure" not in row
            for record in row["stages"] if record["stage"] == stage]


def slope(points):
    """Of the line through log y against log x that leaves the least squares."""
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    x_mean, y_mean = sum(xs) / len(xs), sum(ys) / len(ys)
    return (sum((x - x_mean) * (y - y_mean) for x, y in zip(xs, ys))
            / sum((x - x_mean) ** 2 for x in xs))


def exponent(points):
    """The fitted exponent, and that of n log n over the same sizes; None where too little is
    measured."""
    points = [(n, seconds) for n, seconds in points if seconds >= LEAST_SECONDS]
    if len(points) < LEAST_POINTS:
        return None
    return slope(points), slope([(n, n * math.log(n)) for n, _ in points])


def stages_of(result):
    return list(dict.fromkeys(record["stage"] for row in result["results"] if "failure" not in row
                              for record in row["stages"]))


def faster_than_n_log_n(result):
    """(stage, axis, mesh, exponent) of the stages that grow faster."""
    for (axis, mesh), rows in curves(result).items():
        for stage in stages_of(result):
            fit = exponent(points_of(axis, rows, stage))
            if fit and fit[0] > fit[1] + TOLERANCE:
                yield stage, axis, mesh, fit[0]


def exponents(result):
    found = curves(result)
    lines = []
    for stage in stages_of(result):
        cells = [NAMES.get(stage, stage)]
        for (axis, mesh), rows in found.items():
            points = points_of(axis, rows, stage)
            if not points:
                cells += ["", ""]
                continue
            fit = exponent(points)
            verdict = ""
            if fit:
                verdict = f"{fit[0]:.2f}" + (" **!**" if fit[0] > fit[1] + TOLERANCE else "")
            cells += [f"{points[-1][1]:.3g}", verdict]
        lines.append(cells)
    memory = ["peak of the process, GB"]
    for rows in found.values():
        done = [row for row in rows if "failure" not in row]
        memory += [f"{done[-1]['peak bytes'] / 1e9:.2g}" if done else "", ""]
    lines.append(memory)
    header = ["stage"]
    for (axis, mesh), rows in found.items():
        done = [row for row in rows if "failure" not in row]
        largest = f"{done[-1][axis]:,} {axis}" if done else "none"
        header += [f"{mesh}, {largest}: s", "exponent"]
    return table(header, lines)


def failures(result):
    return "\n".join(
        f"- {row['mesh']}, {row['detail']} "
        f"{'cells' if row['mesh'] == 'hall' else 'subdivisions'}, "
        f"{row['emitted photons']:,} photons emitted: {row['failure']}; larger ones not tried"
        for row in result["results"] if "failure" in row)


def text(result):
    worse = sorted({NAMES.get(stage, stage) for stage, *_ in faster_than_n_log_n(result)})
    parts = [
        "One run a size, each in a process of its own; one sample a pixel at 512 x 384, k = 50. "
        "*hall* is a generated mesh, written as glTF and read again; the others are the scenes of "
        "that name with every triangle cut into four, again and again. Triangles grow under a million "
        "emitted photons; photons grow in the hall of 10,240 triangles. Exponents are fitted to the "
        f"sizes at which a stage takes {LEAST_SECONDS:g} s or more; **!** marks those above n log n.",
        "![Seconds of each stage against size](benchmarks/scale.svg)",
        "![Peak memory against size](benchmarks/scale-memory.svg)",
        exponents(result),
        "No stage grows faster than n log n." if not worse else
        "Faster than n log n: " + ", ".join(worse) + ".",
        failures(result),
    ]
    return "\n\n".join(part for part in parts if part)


def draw(result, caption, folder):
    found = curves(result)
    figure, axes = plots.panels(len(found), caption)
    colours = plots.COLOURS
    for axis, ((grows, mesh), rows) in zip(axes, found.items()):
        largest = (1, 0.0)
        for index, stage in enumerate(stages_of(result)):
            points = points_of(grows, rows, stage)
            if not points:
                continue
            axis.plot(*zip(*points), marker="o", markersize=3, label=NAMES.get(stage, stage),
                      color=colours[index % len(colours)])
            largest = max(largest, points[-1], key=lambda point: point[1])
        sizes = [row[grows] for row in rows if "failure" not in row]
        guide = [largest[1] * n * math.log(n) / (largest[0] * math.log(largest[0])) for n in sizes]
        axis.plot(sizes, guide, "--", color="#999999", label="n log n")
        plots.log_log(axis, mesh, grows)
    axes[0].set_ylabel("seconds")
    plots.legend_beside(axes)
    plots.save(figure, folder / "scale.svg")

    axes_names = list(dict.fromkeys(axis for axis, _ in found))
    figure, axes = plots.panels(len(axes_names), caption)
    for axis, grows in zip(axes, axes_names):
        for index, ((curve_axis, mesh), rows) in enumerate(found.items()):
            points = [(row[grows], row["peak bytes"] / 1e9) for row in rows if "failure" not in row]
            if curve_axis == grows and points:
                axis.plot(*zip(*points), marker="o", markersize=3, label=mesh,
                          color=colours[index % len(colours)])
        plots.log_log(axis, "peak of the process", grows)
        axis.legend(frameon=False)
    axes[0].set_ylabel("GB")
    plots.save(figure, folder / "scale-memory.svg")
