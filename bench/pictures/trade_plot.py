#!/usr/bin/python3
"""Draws what `photile trade` measured: error against the time to a first picture and of a frame.

    bench/pictures/trade_plot.py TRADE.json PLOT.svg

Points of one colour vary one setting; the line joins those that nothing faster beats.
"""

import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools.plots import COLOURS, legend_beside, log_log, panels, save

TIMES = {"first_picture_seconds": "seconds to the first picture",
         "frame_seconds": "seconds of a further frame"}
MARKERS = "os^vDPX"


def front(points, time):
    """Those with a smaller error than all that take less time."""
    least, best = [], float("inf")
    for point in sorted(points, key=lambda point: point[time]):
        if point["relative_error"] < best:
            best = point["relative_error"]
            least.append(point)
    return least


def draw(record, file):
    points = record["renderings"]
    varied = list(dict.fromkeys(point["varied"] for point in points))
    figure, axes = panels(len(TIMES), f"{record['scene']}, {record['width']} x {record['height']} "
                                      "pixels")
    for axis, (time, label) in zip(axes, TIMES.items()):
        log_log(axis, "", label)
        best = front(points, time)
        axis.plot([point[time] for point in best], [point["relative_error"] for point in best],
                  color="#bbbbbb", zorder=0)
        for i, name in enumerate(varied):
            own = [point for point in points if point["varied"] == name]
            axis.plot([point[time] for point in own], [point["relative_error"] for point in own],
                      linestyle="", marker=MARKERS[i % len(MARKERS)], markersize=4,
                      color=COLOURS[i % len(COLOURS)], label=name)
    axes[0].set_ylabel("root mean square relative error")
    legend_beside(axes)
    save(figure, file)


def main():
    if len(sys.argv) != 3:
        sys.exit("trade_plot.py: error: give the trade.json to read and the .svg to write")
    draw(json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8")), sys.argv[2])


if __name__ == "__main__":
    try:
        main()
    except (OSError, KeyError, ValueError) as error:
        sys.exit(f"trade_plot.py: error: {sys.argv[1]}: {error}")
