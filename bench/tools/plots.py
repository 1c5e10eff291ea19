"""Plots of pages of docs/, as SVG that is the same for the same results."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402

matplotlib.rcParams["svg.hashsalt"] = "photile"

# Okabe and Ito's colours, which colour-blind readers can tell apart, and two greys.
COLOURS = ("#D55E00", "#E69F00", "#009E73", "#0072B2", "#56B4E9", "#CC79A7", "#000000", "#999999",
           "#BBBB00")


def save(figure, file):
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)


def panels(count, caption):
    """A figure of panels that share their y axis, side by side or, where they are more than four, in
    rows of three; and its axes."""
    columns = count if count <= 4 else 3
    rows = -(-count // columns)
    figure, axes = pyplot.subplots(rows, columns, figsize=(3.4 * columns + 2, 4 * rows), sharey=True,
                                   squeeze=False, layout="constrained")
    figure.supxlabel(caption, fontsize="x-small", color="#666666")
    axes = axes.flatten()
    for unused in axes[count:]:
        unused.set_axis_off()
    return figure, axes[:count]


def label_rows(axes, text):
    """Of the y axis, at the first panel of each row."""
    for axis in axes:
        if axis.get_subplotspec().is_first_col():
            axis.set_ylabel(text)


def log_log(axis, title, x_label):
    axis.set(xscale="log", yscale="log", title=title, xlabel=x_label)
    axis.grid(True, which="major", alpha=0.3)


def legend_beside(axes):
    """In the last panel's margin: this matplotlib cannot place a figure's legend outside."""
    entries = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    axes[-1].legend(entries.values(), entries.keys(), loc="center left",
                    bbox_to_anchor=(1.02, 0.5), frameon=False)
