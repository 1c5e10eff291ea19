"""Plots of docs/benchmarks.md, as SVG that is the same for the same results."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402

import report_ratios  # noqa: E402

matplotlib.rcParams["svg.hashsalt"] = "photile"

# Okabe and Ito's colours, which colour-blind readers can tell apart, and two greys.
COLOURS = ("#D55E00", "#E69F00", "#009E73", "#0072B2", "#56B4E9", "#CC79A7", "#000000", "#999999",
           "#BBBB00")

# The library's structures are solid, rivals dashed.
STYLES = {
    "uniform-grid": ("#D55E00", "-", "o"),
    "kdtree-2d": ("#E69F00", "-", "s"),
    "kdtree-3d": ("#009E73", "-", "^"),
    "kdtree-global": ("#0072B2", "-", "v"),
    "kdtree-left-balanced": ("#BBBB00", "-", "D"),
    "wide-bvh": ("#CC79A7", "-", "P"),
    "hashed-grid": ("#000000", "-", "*"),
    "brute-force": ("#999999", "-", "x"),
    "nanoflann": ("#000000", "--", "o"),
    "nanoflann-heap": ("#56B4E9", "--", "s"),
    "nanoflann-morton": ("#888888", "--", "^"),
    "embree": ("#CC79A7", "--", "v"),
}
SUMMARY_K = 50


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


def draw_times(axis, rows):
    """Microseconds a query against photons, a line a structure, with the spread of the repeats."""
    for structure, (colour, line, marker) in STYLES.items():
        chosen = sorted((row for row in rows if row["structure"] == structure),
                        key=lambda row: row["photons"])
        if not chosen:
            continue
        photons = [row["photons"] for row in chosen]
        median, low, high = ([1e6 * row["seconds"][key] / row["queries"] for row in chosen]
                             for key in ("median", "min", "max"))
        axis.plot(photons, median, line, marker=marker, color=colour, label=structure,
                  markersize=4)
        axis.fill_between(photons, low, high, color=colour, alpha=0.15, linewidth=0)


def several_counts(rows, workload):
    return len({row["photons"] for row in rows if row["workload"] == workload}) > 1


def draw_workload(rows, workload, caption, file):
    """A panel a value of k."""
    rows = [row for row in rows if row["workload"] == workload]
    ks = sorted({row["k"] for row in rows})
    figure, axes = panels(len(ks), caption)
    for axis, k in zip(axes, ks):
        draw_times(axis, [row for row in rows if row["k"] == k])
        log_log(axis, f"k = {k}", "photons")
    label_rows(axes, "microseconds a query")
    legend_beside(axes)
    figure.suptitle(workload)
    save(figure, file)


def draw_summary(rows, workloads, caption, file):
    """Figure 6 of the paper: a panel a workload."""
    figure, axes = panels(len(workloads), caption)
    for axis, workload in zip(axes, workloads):
        draw_times(axis, [row for row in rows
                          if row["workload"] == workload and row["k"] == SUMMARY_K])
        log_log(axis, f"{workload}, k = {SUMMARY_K}", "photons")
    label_rows(axes, "microseconds a query")
    legend_beside(axes)
    save(figure, file)


def draw_ratios(knn, caption, folder):
    """Times over those of the uniform grid: a picture a workload of several numbers of photons, a panel a
    value of k; returns (workload, file name) of these."""
    cases = {case: structures for case, structures in report_ratios.ratios(knn["results"]).items()
             if several_counts(knn["results"], case[0])}
    drawn = []
    for workload in dict.fromkeys(workload for workload, _ in cases):
        ks = sorted(k for name, k in cases if name == workload)
        figure, axes = panels(len(ks), caption)
        for axis, k in zip(axes, ks):
            for structure, of_photons in cases[workload, k].items():
                colour, line, marker = STYLES[structure]
                photons = sorted(of_photons)
                axis.plot(photons, [of_photons[count] for count in photons], line, marker=marker,
                          color=colour, label=structure, markersize=4)
            axis.axhline(1, color=STYLES[report_ratios.BASE][0])
            log_log(axis, f"k = {k}", "photons")
        label_rows(axes, f"times as long as {report_ratios.BASE}")
        legend_beside(axes)
        figure.suptitle(workload)
        drawn.append((workload, f"knn-ratios-{workload}.svg"))
        save(figure, folder / drawn[-1][1])
    return drawn


def draw_knn(knn, caption, folder):
    """Figure 6 for the README, and a picture a workload; returns (workload, file name) of these."""
    rows = [row for row in knn["results"] if "seconds" in row]
    workloads = [name for name in dict.fromkeys(row["workload"] for row in rows)
                 if several_counts(rows, name)]
    if not workloads:  # a smoke test
        workloads = list(dict.fromkeys(row["workload"] for row in rows))
    draw_summary(rows, workloads, caption, folder / "knn.svg")
    drawn = []
    for workload in workloads:
        name = f"knn-{workload}.svg"
        draw_workload(rows, workload, caption, folder / name)
        drawn.append((workload, name))
    return drawn
