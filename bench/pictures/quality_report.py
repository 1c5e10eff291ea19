"""Tables and plots of quality.py, from its JSON."""

import math
import pathlib

import numpy as np

from tools import plots
from tools.report_section import replace_section

REQUESTED = 0.02  # relMSE that first pictures and frames are timed for
REFINED_SECONDS = 10  # of all cores
STYLES = {"photile": ("#009E73", "D"), "photile, photons alone": ("#D55E00", "o"),
          "photile, photons in passes": ("#E69F00", "s"),
          "photile, paths denoised": ("#009E73", "x"),
          "Mitsuba": ("#56B4E9", "^"), "Mitsuba, low discrepancy": ("#56B4E9", "<"),
          "Mitsuba, denoised": ("#0072B2", "v"),
          "Cycles": ("#000000", "1"), "Cycles, denoised": ("#000000", "2"),
          "LuxCore, PhotonGI": ("#CC79A7", "+"), "LuxCore, PhotonGI, denoised": ("#CC79A7", "*")}
MEASURES = {"rel_mse": "relMSE", "flip": "FLIP"}


def processor():
    """The processor's name, as Linux tells it."""
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return "unknown processor"


def curve(rows, tool, cost, measure):
    """(processor seconds, errors) of a tool, by time."""
    chosen = sorted((row[cost]["processor"], row[measure]) for row in rows
                    if row["tool"] == tool and row.get(cost) and row.get(measure) is not None)
    return [time for time, _ in chosen], [error for _, error in chosen]


def time_to(error, times, errors):
    """When the curve, straight between points in logarithms, first falls to `error`; None: never.

    A curve whose first point is below takes the time of that point.
    """
    last = None
    for time, value in zip(times, errors):
        if value <= error:
            if last is None:
                return time
            share = math.log(last[1] / error) / math.log(last[1] / value)
            return last[0] * (time / last[0]) ** share
        last = (time, value)
    return None


def error_at(time, times, errors):
    """The error of the curve at a time: that of its last point where it ends before. None: nothing
    is ready by then."""
    if not times or time < times[0]:
        return None
    return float(np.exp(np.interp(np.log(time), np.log(times), np.log(errors))))


def seconds(value):
    return "not reached" if value is None else f"{value:.2g} s"


def figure(value):
    return "-" if value is None else f"{value:.2g}"


def percent(share):
    return "-" if share is None else f"{100 * share:.1f}%"


def tools(rows):
    return list(dict.fromkeys(row["tool"] for row in rows))


def summary(rows, cores):
    """One view: a line a tool."""
    lines = [f"| tool | first picture of relMSE {REQUESTED} | each further frame of it "
             f"| relMSE after {REFINED_SECONDS} s | FLIP after {REFINED_SECONDS} s |",
             "|---|--:|--:|--:|--:|"]
    for tool in tools(rows):
        missing = [row["missing"] for row in rows if row["tool"] == tool and "missing" in row]
        if missing:
            lines.append(f"| {tool} | {missing[0]} | | | |")
            continue
        first, frame = curve(rows, tool, "first", "rel_mse"), curve(rows, tool, "frame", "rel_mse")
        budget = REFINED_SECONDS * cores
        frame_text = seconds(time_to(REQUESTED, *frame)) if frame[0] else "-"
        lines.append(f"| {tool} | {seconds(time_to(REQUESTED, *first))} | {frame_text} "
                     f"| {figure(error_at(budget, *first))} "
                     f"| {figure(error_at(budget, *curve(rows, tool, 'first', 'flip')))} |")
    return "\n".join(lines)


def pair(cost):
    return f"{cost['processor']:.2f} | {cost['seconds']:.2f}" if cost else "- | -"


def table(rows):
    """One view: a line a picture."""
    lines = ["| tool | setting | first picture: processor s | wall s | further frame: processor s "
             "| wall s | relMSE | without the worst 5% | mottle | FLIP | mean ratio |",
             "|---|---|" + "--:|" * 9]
    for row in rows:
        if "missing" in row:
            lines.append(f"| {row['tool']} | {row['missing']} |" + " |" * 9)
        else:
            lines.append(
                f"| {row['tool']} | {row['setting']} | {pair(row['first'])} "
                f"| {pair(row.get('frame'))} | {row['rel_mse']:.4f} "
                f"| {row['rel_mse_without_worst']:.4f} | {percent(row['mottle'])} "
                f"| {figure(row['flip'])} "
                f"| {row['mean_ratio']:.3f} |")
    return "\n".join(lines)


def draw(rows, measure, file):
    """A panel a view: first pictures solid, further frames dashed."""
    views = list(dict.fromkeys(row["view"] for row in rows))
    drawing, axes = plots.panels(
        len(views), "solid: from the start of the process; dashed: each further frame")
    for axis, view in zip(axes, views):
        chosen = [row for row in rows if row["view"] == view]
        for tool, (colour, marker) in STYLES.items():
            for cost, line in (("first", "-"), ("frame", "--")):
                times, errors = curve(chosen, tool, cost, measure)
                if times:
                    axis.plot(times, errors, line, marker=marker, color=colour, markersize=4,
                              label=tool if cost == "first" else None)
        plots.log_log(axis, view, "processor seconds")
    axes[0].set_ylabel(MEASURES[measure])
    plots.legend_beside(axes)
    plots.save(drawing, file)


def machine(record):
    versions = ", ".join(f"{package} {number}" for package, number in record["versions"].items()
                         if number)
    return (f"{record['cores']} cores, {record['processor']}; load average {record['load_average']:.0f}"
            f"{'; ' + versions if versions else ''}.")


def section(record):
    rows = record["results"]
    parts = [machine(record), "![relMSE against time](quality/rel_mse.svg)",
             "![FLIP against time](quality/flip.svg)"]
    for view in dict.fromkeys(row["view"] for row in rows):
        chosen = [row for row in rows if row["view"] == view]
        parts += [f"### {view.capitalize()}", summary(chosen, record["cores"]), table(chosen)]
    return "\n\n".join(parts) + "\n"


def write(record, folder, page, partly=False):
    """The plots into `folder`; the tables into `page`, unless that is None."""
    for measure in MEASURES:
        draw(record["results"], measure, folder / f"{measure}.svg")
    text = section(record)
    if page:
        replace_section(page, "pictures/quality.py", text, partly=partly)
