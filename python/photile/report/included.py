"""Results of ``photile glare`` and ``photile daylight`` in a report: tables, and maps of their planes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from . import texts
from .isolines import most_cells

most_observers = 12  # more do not fit on a page
Table = dict[str, Any]


def _measured(entry: dict[str, Any], key: str, digits: int) -> str:
    measured = entry.get(key)
    if not measured:
        return ""
    return f"{measured['value']:.{digits}f} \u00b1 {measured['standard_error']:.{digits}f}"


def _rating(observer: dict[str, Any]) -> float | None:
    """The rating; None where no lamp is visible."""
    return None if observer["ugr"] is None else float(observer["ugr"]["value"])


def _glare_table(observers: list[dict[str, Any]]) -> Table:
    def rank(each: dict[str, Any]) -> float:
        rating = _rating(each)
        return math.inf if rating is None else -rating

    ranked = sorted(observers, key=rank)
    more = len(ranked) > most_observers
    rows = []
    for each in ranked[:most_observers]:
        rating = _rating(each)
        rows.append([each["name"], texts.place(each["position"]),
                     texts.glare(rating) if rating is not None and rating < texts.least_glare
                     else _measured(each, "ugr", 1),
                     _measured(each, "dgp", 3), _measured(each, "illuminance", 0)])
    return {"heading": "Glare", "of": (most_observers, len(ranked)) if more else None,
            "words": (0,), "names": (), "rows": rows,
            "columns": ["observer", "eyes (x, y, z), m", "UGR", "DGP", "lux at the eye"]}


def _daylight_table(grids: list[dict[str, Any]]) -> Table:
    def share(grid: dict[str, Any], key: str) -> str:
        if key not in grid:
            return ""
        error = grid.get("standard_errors", {}).get(key)
        text = f"{100 * grid[key]:.1f}"
        return f"{text}%" if error is None else f"{text} \u00b1 {100 * error:.2g}%"

    rows = [[grid["name"], f"{grid['mean_lux']:.0f}", *(share(grid, key) for key in ("DA", "sDA", "ASE")),
             *(f"{grid['EN 17037'][key]:.0f}" for key in ("target_lux", "minimum_target_lux"))]
            for grid in grids]
    return {"heading": "A year of daylight", "of": None, "words": (0,), "names": (), "rows": rows,
            "columns": ["grid", "mean, lux", "DA", "sDA", "ASE", "EN 17037: half of the area, lux",
                        "95% of it, lux"]}


class Map:
    """A figure at points on a plane, by the cells in which they lie; the highest of several in one
    cell."""

    def __init__(self, owner: dict[str, Any], grid: str, figure: str, label: str, scale: float,
                 steps: int, points: list[tuple[list[float], float | None]]) -> None:
        plane = owner["plane"]
        origin, u, v = (np.array(plane[key], float) for key in ("origin", "u", "v"))
        counts = [int(plane[key]) for key in ("columns", "rows")]
        area = np.linalg.norm(u) * np.linalg.norm(v)
        if not (0 < area < math.inf and min(counts) > 0 and counts[0] * counts[1] <= most_cells
                and all(side.shape == (3,) for side in (origin, u, v))):
            raise ValueError("the plane has no area or too many cells")
        cells: dict[int, float] = {}
        for position, value in points:
            column, row = (math.floor(np.dot(np.array(position, float) - origin, side)
                                      / np.dot(side, side) * count)
                           for side, count in zip((u, v), counts))
            if value is not None and 0 <= column < counts[0] and 0 <= row < counts[1]:
                cell = row * counts[0] + column
                cells[cell] = max(value, cells.get(cell, -math.inf))
        self.grid, self.figure = grid, figure
        self.values = {"plane": {**plane, "cells": sorted(cells)}, "plan": owner.get("plan")}
        self.numbers: list[float | None] = [cells[cell] for cell in sorted(cells)]
        self.colours = {"scale": scale, "steps": steps, "decades": 0, "label": label, "contours": "cells"}


def _daylight_maps(grid: dict[str, Any]) -> list[Map]:
    if "plane" not in grid:
        return []
    shares = {
        f"DA {grid['target_lux']:g} lux": [sensor["DA"] for sensor in grid["sensors"]],
        "UDI 100 to 3000 lux": [sensor["UDI"]["100 to 300"] + sensor["UDI"]["300 to 3000"]
                                for sensor in grid["sensors"]]}
    return [Map(grid, grid["name"], figure, "%", 100, 10,
                [(sensor["position"], 100 * share) for sensor, share in zip(grid["sensors"], all_shares)])
            for figure, all_shares in shares.items()]


def _glare_maps(record: dict[str, Any]) -> list[Map]:
    if "plane" not in record:
        return []
    points = [(each["position"], None if _rating(each) is None else
               max(_rating(each) or 0, texts.least_glare)) for each in record["observers"]]
    return [Map(record, "observers", "the highest UGR", "UGR", 32, 8, points)]


class Included:
    def __init__(self) -> None:
        self.tables: list[Table] = []
        self.maps: list[Map] = []
        self.kilowatt_hours = 0.0  # a year of the lamps over the first grid; 0 = unknown

    def add(self, content: Any) -> None:
        """Raises the exceptions of indexing and arithmetic for what is not a result."""
        if isinstance(content, list):
            self.tables.append(_daylight_table(content))
            self.maps += [one for grid in content for one in _daylight_maps(grid)]
            self.kilowatt_hours += sum(float(lamp["kilowatt_hours"])
                                       for lamp in (content[0].get("lamps", []) if content else []))
        else:
            self.tables.append(_glare_table(content["observers"]))
            self.maps += _glare_maps(content)
