"""Many lights: stages, layers and files against the number of lights."""

from tools import plots
from kernels.report_tables import figure, table, times

STAGES = {"trace": "trace", "maps": "maps", "estimate": "estimate", "film": "film",
          "write": "write EXR", "relight": "relight"}


def megabytes(count):
    return f"{count / 1e6:.3g}"


def lines(rows):
    for row in rows:
        yield ([f"{row['lights']:,}"] + [times(row[stage]) for stage in STAGES]
               + [megabytes(row[key]) for key in ("layer bytes", "dense bytes", "file bytes")])


def growth(rows, stage):
    """Time with the most lights over that with the fewest."""
    return rows[-1][stage]["median"] / rows[0][stage]["median"]


def text(result):
    rows, settings = result["results"], result["settings"]
    header = ["lights"] + [f"{name}, ms" for name in STAGES.values()] + [
        "layers, MB", "a plane each, MB", "EXR, MB"]
    return "\n\n".join([
        f"A hall with equal lamps in rows below its ceiling, {settings['emitted photons']:,} photons from all "
        f"lamps together, {settings['width']} x {settings['height']}, one sample a pixel, k = 50. *relight* reads the "
        "file and sums the picture with one lamp changed. Up to 8 lights have a plane each. With more, a pixel holds "
        "the lights that reach it, and with more than 64 an EXR has a part for each light.",
        "![Time against lights](benchmarks/lights.svg)",
        table(header, lines(rows)),
        f"From {rows[0]['lights']:,} to {rows[-1]['lights']:,} lights: "
        + ", ".join(f"{name} x {figure(growth(rows, stage))}" for stage, name in STAGES.items()) + "."])


def draw(result, caption, folder):
    rows = result["results"]
    figure, axes = plots.panels(1, caption)
    for index, (stage, name) in enumerate(STAGES.items()):
        axes[0].plot([row["lights"] for row in rows], [row[stage]["median"] for row in rows],
                     marker="o", markersize=3, label=name, color=plots.COLOURS[index])
    plots.log_log(axes[0], "same photons", "lights")
    axes[0].set_ylabel("seconds")
    plots.legend_beside(axes)
    plots.save(figure, folder / "lights.svg")
