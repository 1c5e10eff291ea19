"""Results of ``photile glare``, ``daylight``, ``outlook`` and ``measure --daylight-factor`` in a report, as tables and
maps of their planes, and the rooms of a building that ``photile import`` writes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from . import texts
from .isolines import most_cells
from .rooms import Room
from .tables import Table, table

most_observers = 12  # more do not fit on a page

# EN 17037, table A.1: of each level the lux that half of the plane has in half of the daylight hours, and those that
# 95% of it have.
_levels = {"minimum": (300, 100), "medium": (500, 300), "high": (750, 500)}
_halves = (0.5, 0.95)
# IES LM-83-12: the sDA from which on a room is accepted, or preferred, and the highest ASE.
_accepted, _preferred, _highest_exposure, _hours_of_sun = 0.55, 0.75, 0.1, 250


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
    return table("Glare", ["observer", "eyes (x, y, z), m", "UGR", "DGP", "lux at the eye"], rows, words=(0,),
                 kind="figures", of=(most_observers, len(ranked)) if more else None)


def _year_table(grids: list[dict[str, Any]]) -> Table:
    def share(grid: dict[str, Any], key: str) -> str:
        if key not in grid:
            return ""
        error = grid.get("standard_errors", {}).get(key)
        text = f"{100 * grid[key]:.1f}"
        return f"{text}%" if error is None else f"{text} \u00b1 {100 * error:.2g}%"

    def autonomy(grid: dict[str, Any]) -> str:
        return ("preferred" if grid["sDA"] >= _preferred else "accepted") if grid["sDA"] >= _accepted else "not met"

    def exposure(grid: dict[str, Any]) -> str:
        return "" if "ASE" not in grid else "met" if grid["ASE"] <= _highest_exposure else "not met"

    rows = [[grid["name"], f"{grid['mean_lux']:.0f}", share(grid, "DA"), share(grid, "sDA"), autonomy(grid),
             share(grid, "ASE"), exposure(grid)] for grid in grids]
    lux = {f"{grid['target_lux']:g}" for grid in grids if "target_lux" in grid}
    return table("A year of daylight",
                 ["grid", "mean, lux", f"DA {lux.pop()} lux" if len(lux) == 1 else "DA", "sDA", "IES LM-83", "ASE",
                  "IES LM-83"], rows, words=(0, 4, 6), kind="figures",
                 remark="IES LM-83-12: sDA is accepted from 55% of the points on and preferred from 75% on. "
                        "ASE, of the windows without blinds, is at most 10%.")


def _view_table(views: list[dict[str, Any]]) -> Table:
    rows = [[one["grid"], str(one["points"]), f"{one['angle']:.0f}\u00b0",
             "no end" if one["distance"] is None else f"{one['distance']:.0f} m",
             *(str(one["levels"][level]) for level in _levels), one["level"]] for one in views]
    return table("View out (EN 17037)", ["grid", "points", "sight angle", "distance", *_levels, "level"], rows,
                 words=(0, 3, 7), kind="figures",
                 remark="Angle and distance are medians of the points; of each level the points are counted. "
                        "The level is what 75% of them have.")


def _sunlight_table(sun: dict[str, Any]) -> Table:
    most = max((place["hours"] for place in sun["places"]), default=0.0)
    rows = [[str(number), texts.place(place["position"]), f"{place['hours']:.1f}",
             sun["level"] if place["hours"] == most else ""] for number, place in enumerate(sun["places"], 1)]
    return table("Sunlight (EN 17037)", ["window", "position (x, y, z), m", "hours of sun", "level"], rows,
                 words=(3,), kind="figures", remark=f"The sun of {sun['date']} in a cloudless sky.")


def _share_of(values: list[float], least: float) -> float:
    """The part of a plane that has a value or more: its points stand for equal areas."""
    return float(np.mean(np.array(values, float) >= least * (1 - 1e-9)))


def _provision(values: list[float], pairs: Iterable[tuple[float, float]]) -> list[str]:
    """Of each level of EN 17037 the parts of the plane that have its two values, then the highest level that is met."""
    shares = [[_share_of(values, least) for least in pair] for pair in pairs]
    met = [name for name, pair in zip(_levels, shares)
           if all(share >= part for share, part in zip(pair, _halves))]
    return [*(" / ".join(f"{100 * share:.0f}%" for share in pair) for pair in shares), met[-1] if met else "none"]


def _year_provision_table(grids: list[dict[str, Any]]) -> Table:
    rows = []
    for grid in grids:
        lux = [f"{grid['EN 17037'][key]:.0f}" for key in ("target_lux", "minimum_target_lux")]
        medians = [sensor.get("median_lux") for sensor in grid.get("sensors", [])]
        known = medians and None not in medians
        rows.append([grid["name"], *lux, *(_provision(medians, _levels.values()) if known
                                           else ["", "", "", grid["EN 17037"].get("level", "")])])
    return table("Daylight provision by the year (EN 17037)",
                 ["grid", "half of the plane, lux", "95% of it, lux",
                  *(f"{name}: {half}\u00a0/\u00a0{most} lux" for name, (half, most) in _levels.items()), "level"],
                 rows, words=(0, 6), kind="figures",
                 remark="The lux are those of half of the daylight hours. By windows in walls a level is met "
                        "where half of the plane has the first value and 95% of it the second; the parts of the "
                        "plane that have them are stated.")


def factor_table(grids: list[dict[str, Any]], outdoors: float | None) -> Table:
    """Daylight factors, by EN 17037 where the median diffuse illuminance outdoors, lux, is known."""
    targets = [(100 * a / outdoors, 100 * b / outdoors) for a, b in _levels.values()] if outdoors else []
    rows = []
    for grid in grids:
        factors = [float(sensor["lux"]) for sensor in grid["sensors"]]
        ranked = sorted(factors)
        half, most = (ranked[math.floor((1 - part) * len(ranked))] for part in _halves)
        row = [grid["name"], f"{np.mean(factors):.2f}%", f"{np.median(factors):.2f}%", f"{most:.2f}%"]
        needed = [texts.grouped(float(f"{max(100 * a / half, 100 * b / most):.3g}"), 3) if min(half, most) > 0 else ""
                  for a, b in _levels.values()]
        rows.append([*row, *(_provision(factors, targets) if outdoors else needed)])
    columns = ["grid", "mean", "median", "95% of the plane have"]
    if not outdoors:
        return table("Daylight factors", [*columns, *(f"{name}: lux outdoors" for name in _levels)], rows,
                     words=(0,), kind="figures",
                     remark="A level of EN 17037 is met where the median diffuse illuminance outdoors (table "
                            "A.3 of the standard) is as high as stated, or higher.")
    return table("Daylight factors",
                 [*columns, *(f"{name}: {half:.1f}%\u00a0/\u00a0{most:.1f}%"
                              for name, (half, most) in zip(_levels, targets)), "level"],
                 rows, words=(0, 7), kind="figures",
                 remark=f"EN 17037 for a median diffuse illuminance outdoors of {outdoors:,.0f} lux. By windows "
                        "in walls a level is met where half of the plane has the first daylight factor and 95% "
                        "of it the second; the parts of the plane that have them are stated.")


def outdoors_of(contents: Iterable[Any]) -> float | None:
    """The median diffuse illuminance outdoors of the first year among results, lux; None without one."""
    years = (content[0] for content in contents if isinstance(content, list) and content)
    rated = (year.get("EN 17037") for year in years if isinstance(year, dict))
    known = (one.get("median_outdoor_lux") for one in rated if isinstance(one, dict))
    return next((float(lux) for lux in known if isinstance(lux, (int, float)) and lux > 0), None)


class Map:
    """A figure at points on a plane, by the cells in which they lie; the highest of several in one
    cell.

    levels   of its isolines; none for those of the scale
    alone    whether it is a plan of its own, too: the command that asks for these counts them
    """

    def __init__(self, owner: dict[str, Any], grid: str, figure: str, label: str, scale: float,
                 steps: int, points: list[tuple[list[float], float | None]], levels: tuple[float, ...] = (),
                 alone: bool = True) -> None:
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
        self.grid, self.figure, self.alone = grid, figure, alone
        self.values = {"plane": {**plane, "cells": sorted(cells)}, "plan": owner.get("plan")}
        self.numbers: list[float | None] = [cells[cell] for cell in sorted(cells)]
        self.colours = {"scale": scale, "steps": steps, "decades": 0, "label": label, "contours": "cells",
                        "levels": levels}


def _year_maps(grid: dict[str, Any]) -> list[Map]:
    if "plane" not in grid:
        return []

    def drawn(figure: str, label: str, scale: float, values: list[float], levels: tuple[float, ...] = (),
              alone: bool = False) -> Map:
        points: list[tuple[list[float], float | None]] = [
            (sensor["position"], value) for sensor, value in zip(grid["sensors"], values)]
        return Map(grid, grid["name"], figure, label, scale, 10, points, levels, alone)

    def known(key: str) -> bool:
        return all(key in sensor for sensor in grid["sensors"])

    useful = [sensor["UDI"]["100 to 300"] + sensor["UDI"]["300 to 3000"] for sensor in grid["sensors"]]
    maps = [drawn(f"DA {grid['target_lux']:g} lux, line at 50%", "%", 100,
                  [100 * sensor["DA"] for sensor in grid["sensors"]], (50,), True),
            drawn("UDI 100 to 3000 lux", "%", 100, [100 * share for share in useful], (), True)]
    if "ASE" in grid and known("sun_hours"):
        maps.append(drawn(f"sun, line at {_hours_of_sun} h", "h", 2 * _hours_of_sun,
                          [sensor["sun_hours"] for sensor in grid["sensors"]], (_hours_of_sun,)))
    if known("median_lux"):
        lux = sorted({float(one) for pair in _levels.values() for one in pair})
        maps.append(drawn("median lux (EN 17037)", "lux", 1000,
                          [sensor["median_lux"] for sensor in grid["sensors"]], tuple(lux)))
    return maps


def _factor_maps(grids: list[dict[str, Any]]) -> list[Map]:
    return [Map(grid, grid["name"], "daylight factor", "%", 10, 10,
                [(sensor["position"], sensor["lux"]) for sensor in grid["sensors"]], (0.5, 1, 2, 3, 5), False)
            for grid in grids if "plane" in grid]


def _glare_maps(record: dict[str, Any]) -> list[Map]:
    if "plane" not in record:
        return []
    points = [(each["position"], None if _rating(each) is None else
               max(_rating(each) or 0, texts.least_glare)) for each in record["observers"]]
    return [Map(record, "observers", "the highest UGR", "UGR", 32, 8, points)]


class Included:
    """What a report shows beside its own results.

    outdoors   the median diffuse illuminance outdoors by EN 17037, lux; None = not known
    """

    def __init__(self, outdoors: float | None = None) -> None:
        self._outdoors = outdoors
        self.tables: list[Table] = []
        self.maps: list[Map] = []
        self.rooms: list[Room] = []
        self.kilowatt_hours = 0.0  # a year of the lamps over the first grid; 0 = unknown

    def add(self, content: Any) -> None:
        """Raises the exceptions of indexing and arithmetic for what is not a result."""
        if isinstance(content, list) and content and "outline" in content[0]:
            self.rooms += map(Room, content)
        elif isinstance(content, list):
            self.tables += [_year_table(content), _year_provision_table(content)]
            self.maps += [one for grid in content for one in _year_maps(grid)]
            self.kilowatt_hours += sum(float(lamp["kilowatt_hours"])
                                       for lamp in (content[0].get("lamps", []) if content else []))
        elif "view_out" in content or "sunlight" in content:
            if "view_out" in content:
                self.tables.append(_view_table(content["view_out"]))
            if "sunlight" in content:
                self.tables.append(_sunlight_table(content["sunlight"]))
        elif content.get("unit") == "DF %":
            self.tables.append(factor_table(content["grids"], self._outdoors))
            self.maps += _factor_maps(content["grids"])
        else:
            self.tables.append(_glare_table(content["observers"]))
            self.maps += _glare_maps(content)
