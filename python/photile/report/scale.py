"""Scales of values: false colours, tops and steps in round numbers, and levels of isolines."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .texts import rounded_up

Floats = NDArray[np.float64]

# The steps of the scale of illuminance of EN 12464-1: 5, 7.5, 10, 15, 20, 30, 50 ... lux.
standard_steps = (1.0, 1.5, 2.0, 3.0, 5.0, 7.5)
round_steps = (1.0, 1.5, 2.0, 2.5, 3.0, 5.0)  # of a legend: 0, 50, 100 ... or 0, 150, 300 ...
# The part of a step that a band takes, around its middle.
band_begin, band_end = 0.4, 0.6


def automatic_top(values: Floats) -> float:
    """The largest of the values without the uppermost 2%; 0 where none is positive."""
    known = np.sort(values[np.isfinite(values) & (values > 0)])
    return float(known[len(known) - 1 - int(0.02 * len(known))]) if len(known) else 0.0


def steps_of(top: float, wanted: int) -> int:
    """The number of round steps up to a round top that is nearest to the one wanted."""
    decade = 10.0 ** math.floor(math.log10(top))
    counts = [top / (step * size) for step in round_steps for size in (decade / 10, decade)]
    return min((round(count) for count in counts if count > 1.5 and abs(count - round(count)) < 1e-6),
               key=lambda count: (abs(count - wanted), count))


def fitted(colours: dict[str, Any], drawings: Iterable[Floats]) -> dict[str, Any]:
    """The options of false colour with a top, and steps up to it, that suit the values of all drawings
    which share the scale: the least step of EN 12464-1 below which 98% of the values of each lie. A top
    that is given stays."""
    if colours["scale"]:
        return colours
    top = max(map(automatic_top, drawings), default=0.0)
    if not top > 0:
        return {**colours, "scale": 1}
    top = rounded_up(top, standard_steps)
    steps = colours["steps"] if colours["decades"] else steps_of(top, int(colours["steps"]))
    return {**colours, "scale": top, "steps": steps}


def illuminance_steps(low: float, high: float) -> list[float]:
    """The steps of the scale of EN 12464-1 between two illuminances: 5, 7.5, 10, 15, 20, 30, 50 ..."""
    if not (high > 0 and math.isfinite(high)):
        return []
    least = max(low, high / 1000)
    steps, decade = [], 10.0 ** math.floor(math.log10(least))
    while decade < high:
        steps += [step * decade for step in standard_steps if least < step * decade < high]
        decade *= 10
    return steps


class Scale:
    """Colours of values, by the options of false colour."""

    def __init__(self, colours: dict[str, Any]) -> None:
        self.top = float(colours["scale"])
        self.steps, self.decades = int(colours["steps"]), float(colours["decades"])
        self.contours = colours["contours"]
        self.label = colours["label"]
        self.chosen = [float(level) for level in colours.get("levels", ())]  # levels of isolines in place of its own
        self._palette = colours["palette"].split()

    def value_at(self, share: float) -> float:
        return float(self.top * (10 ** ((share - 1) * self.decades) if self.decades else share))

    def marks(self) -> list[tuple[float, float]]:
        """The values that the legend has, with their shares of the scale: levels of isolines and bands, or
        where steps begin and end; 1, 2 and 5 times powers of ten where it is logarithmic."""
        if self.contours in ("isolines", "bands"):
            return [((step + 0.5) / self.steps, level) for step, level in enumerate(self.levels())]
        edges = [(step / self.steps, self.value_at(step / self.steps)) for step in range(self.steps + 1)]
        if not self.decades or self.contours == "steps":
            return edges
        powers = range(math.floor(math.log10(self.value_at(0))), math.floor(math.log10(self.top)) + 1)
        found = [(1 + math.log10(value / self.top) / self.decades, value)
                 for value in (step * 10.0 ** power for power in powers for step in (1, 2, 5))]
        found = [(share, value) for share, value in found if -1e-9 < share < 1 + 1e-9]
        return found if len(found) > 1 else edges

    def levels(self) -> list[float]:
        """The levels of isolines alone: the middles of the legend's steps, as in falsecolor."""
        return [self.value_at((step + 0.5) / self.steps) for step in range(self.steps)]

    def bands(self) -> list[tuple[float, float]]:
        return [(self.value_at((step + band_begin) / self.steps),
                 self.value_at((step + band_end) / self.steps)) for step in range(self.steps)]

    def colour(self, value: float) -> str:
        share = value / self.top
        if self.decades:
            share = 1 + math.log10(share) / self.decades if value > 0 else 0
        if self.contours == "steps":
            share = (math.floor(min(max(share, 0), 1 - 1e-9) * self.steps) + 0.5) / self.steps
        # Halves are rounded up, as std::lround does.
        return str(self._palette[math.floor(min(max(share, 0), 1) * (len(self._palette) - 1) + 0.5)])
