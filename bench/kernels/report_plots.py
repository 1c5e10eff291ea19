"""Plots of docs/measured/benchmarks.md about searches."""

from kernels import report_ratios
from kernels.report_tables import LISTS, timed, time_name
from tools.plots import label_rows, legend_beside, log_log, panels, save

# The library's structures are solid, rivals dashed, and dotted what has one's cells and another's selection.
STYLES = {
    "uniform-grid": ("#D55E00", "-", "o"),
    "kdtree-2d": ("#E69F00", "-", "s"),
    "kdtree-3d": ("#009E73", "-", "^"),
    "kdtree-global": ("#0072B2", "-", "v"),
    "kdtree-left-balanced": ("#BBBB00", "-", "D"),
    "wide-bvh": ("#CC79A7", "-", "P"),
    "hashed-grid": ("#000000", "-", "*"),
    "brute-force": ("#999999", "-", "x"),
    "uniform-grid-heap": ("#D55E00", ":", "o"),
    "kdtree-2d-radix-64": ("#E69F00", ":", "s"),
    "nanoflann": ("#000000", "--", "o"),
    "nanoflann, newer": ("#56B4E9", "--", "s"),
    "embree": ("#CC79A7", "--", "v"),
}
SUMMARY_K = 50


def style_of(structure):
    """Its colour, line and marker; of one that has none in the table, the same in every plot."""
    number = sum(map(ord, structure))
    chosen = list(STYLES.values())[number % len(STYLES)]
    return STYLES.get(structure, (chosen[0], ":", "<>hX"[number % 4]))


def draw_times(axis, rows):
    """Times a query against photons, a line a structure, with the spread of the repeats."""
    others = dict.fromkeys(row["structure"] for row in rows if row["structure"] not in STYLES)
    for structure in [*STYLES, *others]:
        colour, line, marker = style_of(structure)
        chosen = sorted((row for row in rows if row["structure"] == structure),
                        key=lambda row: row["photons"])
        if not chosen:
            continue
        photons = [row["photons"] for row in chosen]
        median, low, high = ([1e6 * row["time"][key] / row["queries"] for row in chosen]
                             for key in ("median", "min", "max"))
        axis.plot(photons, median, line, marker=marker, color=colour, label=structure,
                  markersize=4)
        axis.fill_between(photons, low, high, color=colour, alpha=0.15, linewidth=0)


def drawn_rows(knn):
    """All but lists, and but trees that differ from the one drawn in the size of their leaves."""
    return [row for row in timed(knn) if LISTS not in row["structure"]
            and (row["structure"] in STYLES or "-radix-" not in row["structure"])]


def several_counts(rows, workload):
    return len({row["photons"] for row in rows if row["workload"] == workload}) > 1


def draw_workload(rows, workload, caption, label, file):
    """A panel a value of k."""
    rows = [row for row in rows if row["workload"] == workload]
    ks = sorted({row["k"] for row in rows})
    figure, axes = panels(len(ks), caption)
    for axis, k in zip(axes, ks):
        draw_times(axis, [row for row in rows if row["k"] == k])
        log_log(axis, f"k = {k}", "photons")
    label_rows(axes, label)
    legend_beside(axes)
    figure.suptitle(workload)
    save(figure, file)


def draw_summary(rows, workloads, caption, label, file):
    """Figure 6 of the paper: a panel a workload."""
    figure, axes = panels(len(workloads), caption)
    for axis, workload in zip(axes, workloads):
        draw_times(axis, [row for row in rows
                          if row["workload"] == workload and row["k"] == SUMMARY_K])
        log_log(axis, f"{workload}, k = {SUMMARY_K}", "photons")
    label_rows(axes, label)
    legend_beside(axes)
    save(figure, file)


def draw_ratios(knn, caption, folder):
    """Times over those of the uniform grid: a picture a workload of several numbers of photons, a panel a
    value of k; returns (workload, file name) of these."""
    cases = {case: structures for case, structures in report_ratios.ratios(drawn_rows(knn)).items()
             if several_counts(knn["results"], case[0])}
    drawn = []
    for workload in dict.fromkeys(workload for workload, _ in cases):
        ks = sorted(k for name, k in cases if name == workload)
        figure, axes = panels(len(ks), caption)
        for axis, k in zip(axes, ks):
            for structure, of_photons in cases[workload, k].items():
                colour, line, marker = style_of(structure)
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
    rows = drawn_rows(knn)
    label = f"{time_name(knn).replace('seconds', 'microseconds')} a query"
    workloads = [name for name in dict.fromkeys(row["workload"] for row in rows)
                 if several_counts(rows, name)]
    if not workloads:  # a smoke test
        workloads = list(dict.fromkeys(row["workload"] for row in rows))
    draw_summary(rows, workloads, caption, label, folder / "knn.svg")
    drawn = []
    for workload in workloads:
        name = f"knn-{workload}.svg"
        draw_workload(rows, workload, caption, label, folder / name)
        drawn.append((workload, name))
    return drawn
