"""Plots of docs/benchmarks.md."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402

# Okabe and Ito's colours, which colour-blind readers can tell apart. The library's structures are
# solid, rivals dashed.
STYLES = {
    "uniform-grid": ("#D55E00", "-", "o"),
    "kdtree-2d": ("#E69F00", "-", "s"),
    "kdtree-3d": ("#009E73", "-", "^"),
    "kdtree-global": ("#0072B2", "-", "v"),
    "brute-force": ("#999999", "-", "x"),
    "nanoflann": ("#000000", "--", "o"),
    "nanoflann-heap": ("#56B4E9", "--", "s"),
    "nanoflann-morton": ("#888888", "--", "^"),
    "embree": ("#CC79A7", "--", "v"),
}


def curve(rows):
    """Photons, microseconds a query, and their spread."""
    rows = sorted(rows, key=lambda row: row["photons"])
    micro = [[1e6 * row["seconds"][key] / row["queries"] for row in rows]
             for key in ("median", "min", "max")]
    return [row["photons"] for row in rows], *micro


def draw_workload(rows, workload, file):
    ks = sorted({row["k"] for row in rows})
    figure, axes = pyplot.subplots(1, len(ks), figsize=(3.4 * len(ks) + 2, 4), sharey=True,
                                   squeeze=False, layout="constrained")
    for axis, k in zip(axes[0], ks):
        for structure, (colour, line, marker) in STYLES.items():
            chosen = [row for row in rows if row["structure"] == structure and row["k"] == k]
            if not chosen:
                continue
            photons, median, low, high = curve(chosen)
            axis.plot(photons, median, line, marker=marker, color=colour, label=structure,
                      markersize=4)
            axis.fill_between(photons, low, high, color=colour, alpha=0.15, linewidth=0)
        axis.set(xscale="log", yscale="log", title=f"k = {k}", xlabel="photons")
        axis.grid(True, which="major", alpha=0.3)
    axes[0][0].set_ylabel("microseconds a query")
    handles, labels = axes[0][0].get_legend_handles_labels()
    # In the last panel's margin: this matplotlib cannot place a figure's legend outside.
    axes[0][-1].legend(handles, labels, loc="center left", bbox_to_anchor=(1.02, 0.5),
                       frameon=False)
    figure.suptitle(workload)
    figure.savefig(file, dpi=100, metadata={"Software": None})
    pyplot.close(figure)


def draw(knn, folder):
    """One picture a workload; returns (workload, file name) each."""
    rows = [row for row in knn["results"] if "seconds" in row]
    drawn = []
    for workload in dict.fromkeys(row["workload"] for row in rows):
        name = f"knn-{workload}.png"
        draw_workload([row for row in rows if row["workload"] == workload], workload,
                      folder / name)
        drawn.append((workload, name))
    return drawn
