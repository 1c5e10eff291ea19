"""UGR tables of CIE 117:1995 and CIE 190:2010: a luminaire in standard rooms, by the tabular method.

Luminaires hang 2 m above the eyes in a regular array, the first half a spacing from the walls; the
observer is at the middle of a wall and looks straight on. Luminances are intensity over projected
opening; those farther aside than T/R = 3, or lower than 85 degrees from straight down, are left out.
The background is the mean indirect illuminance of the walls between the two planes over pi. What falls
directly on the floor is counted luminaire by luminaire, where the report has zonal multipliers for a
spacing of 1 H.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import texts

Floats = NDArray[np.float64]
# Across and along the line of sight, in multiples of the height of the luminaires above the eyes.
rooms = [(across, along) for across, all_along in
         ((2, (2, 3, 4, 6, 8, 12)), (4, (2, 3, 4, 6, 8, 12)), (8, (4, 6, 8, 12)), (12, (4, 6, 8)))
         for along in all_along]
reflectances = [(0.7, 0.5, 0.2), (0.7, 0.3, 0.2), (0.5, 0.5, 0.2), (0.5, 0.3, 0.2), (0.3, 0.3, 0.2)]
views = ("crosswise", "endwise")  # the luminaires' length is at a right angle to the line of sight, or along it
height = 2.0  # metres
farthest_aside = 3.0
lowest_cosine = math.cos(math.radians(85))


class Luminaire:
    """Intensities on a grid of angles, bilinear between them and 0 beyond, and the luminous opening."""

    def __init__(self, record: dict[str, Any]) -> None:
        self.flux: float = record["flux"]
        self._axes: Floats = np.array(record["axes"])
        self._polar, self._azimuth = np.array(record["polar"]), np.array(record["azimuth"])
        self._candela = np.array(record["intensity"]).reshape(len(self._azimuth), len(self._polar))
        self.opening = record["opening"]

    def intensity(self, directions: Floats) -> Floats:
        zero, quarter, pole = (directions @ axis for axis in self._axes)
        polar = np.arccos(np.clip(pole, -1, 1))
        azimuth = np.arctan2(quarter, zero)
        first, last = self._azimuth[0], self._azimuth[-1]
        azimuth -= 2 * math.pi * np.floor((azimuth - first) / (2 * math.pi))
        if first + 2 * math.pi - last < 1e-9:  # a full circle, up to rounding
            azimuth = np.minimum(azimuth, last)
        beyond = (azimuth > last) | (polar < self._polar[0]) | (polar > self._polar[-1])

        def place(angles: Floats, angle: Floats) -> tuple[NDArray[np.intp], Floats]:
            cell = np.clip(np.searchsorted(angles, angle, "right") - 1, 0, len(angles) - 2)
            return cell, (angle - angles[cell]) / (angles[cell + 1] - angles[cell])

        (i, u), (j, v) = place(self._azimuth, azimuth), place(self._polar, polar)
        candela = sum(weight * self._candela[i + a, j + b] for a, b, weight in
                      ((0, 0, (1 - u) * (1 - v)), (0, 1, (1 - u) * v), (1, 0, u * (1 - v)), (1, 1, u *
                      v)))
        return np.where(beyond, 0.0, candela)

    def projected_area(self, directions: Floats) -> Floats:
        """The projected area of the opening from there, m2."""
        wide, deep, heights = self.opening["x"], self.opening["y"], np.array(self.opening["heights"])
        x, y, z = np.abs(directions.T)
        across_x = deep * heights[np.where(directions[:, 0] < 0, 2, 0)] * x
        across_y = wide * heights[np.where(directions[:, 1] < 0, 3, 1)] * y
        across_z = wide * deep * z
        # An ellipse covers pi / 4 of its rectangle; a cylinder's side is as wide as its ellipse is from there.
        disc = math.pi / 4
        shapes: dict[str, Callable[[], Any]] = {
            "box": lambda: across_x + across_y + across_z,
            "upright cylinder": lambda: disc * across_z + np.hypot(across_x, across_y),
            "cylinder along x": lambda: disc * across_x + np.hypot(across_y, across_z),
            "cylinder along y": lambda: disc * across_y + np.hypot(across_x, across_z),
            "ellipsoid": lambda: disc * np.hypot(np.hypot(across_x, across_y), across_z)}
        area: Floats = shapes[self.opening["shape"]]()
        return area


def _in_lamp(luminaire: Luminaire, endwise: bool, directions: Floats) -> Floats:
    """Directions to the right, ahead and up, in the axes of the lamp. The length is the longer side of
    the opening; of
        a square one it lies along y, as in EULUMDAT."""
    x_is_ahead = endwise == (luminaire.opening["x"] > luminaire.opening["y"])
    return directions[:, [1, 0, 2]] if x_is_ahead else directions


def _places(first: float, last: float, spacing: float) -> Floats:
    """The middles of equal parts of about one spacing."""
    count = max(1, math.floor((last - first) / spacing + 0.5))
    return first + (last - first) * (np.arange(count) + 0.5) / count


def transfer_factors(room: tuple[float, float], of: tuple[float, float, float]) -> tuple[float, ...]:
    """Indirect flux that reaches the walls for each lumen that falls directly on the floor (the plane
    of the eyes), the walls and the ceiling (the plane of the luminaires): F_T,FW, F_T,WW-1 and F_T,CW
    of CIE 190, by radiosity of three surfaces."""
    a, b = room
    x, y = 1 + a * a, 1 + b * b
    # The form factor between two squares of a box of height 1 (Hottel; Howell C-11).
    facing = 2 / (math.pi * a * b) * (
        0.5 * math.log(x * y / (x + b * b)) + a * math.sqrt(y) * math.atan(a / math.sqrt(y))
        + b * math.sqrt(x) * math.atan(b / math.sqrt(x)) - a * math.atan(a) - b * math.atan(b))
    to_walls, from_walls = 1 - facing, (1 - facing) * a * b / (2 * (a + b))
    exchange = np.array([[0, from_walls, facing], [to_walls, 1 - 2 * from_walls, to_walls],
                         [facing, from_walls, 0]]) * np.array([of[2], of[1], of[0]])
    every = np.linalg.inv(np.eye(3) - exchange) - np.eye(3)  # all reflections of floor, walls, ceiling
    return tuple(every[1])


class _DownwardLight:
    """The distribution of the light below a luminaire."""

    def __init__(self, luminaire: Luminaire, endwise: bool) -> None:
        polar, around = 90, 72
        gamma = math.pi / 2 / polar * (np.arange(polar) + 0.5)
        azimuth = 2 * math.pi / around * (np.arange(around) + 0.5)
        gamma, azimuth = (each.ravel() for each in np.meshgrid(gamma, azimuth, indexing="ij"))
        ways = np.stack([np.sin(gamma) * np.sin(azimuth), np.sin(gamma) * np.cos(azimuth), -np.cos(gamma)], 1)
        intensity = luminaire.intensity(_in_lamp(luminaire, endwise, ways))
        self._share = np.sin(gamma) * math.pi**2 / polar / around * intensity / luminaire.flux
        self._aside, self._ahead = (ways[:, :2] * (height / -ways[:, 2:])).T
        self.whole = min(1.0, float(self._share.sum()))

    def on_floor(self, half_width: float, depth: float) -> float:
        """The fraction that falls directly on the plane of the eyes, in a room full of luminaires: the
        mean of a few positions, because it is smooth."""
        sums = []
        for x in _places(0, half_width, height / 2):
            aside = np.abs(x + self._aside) <= half_width
            for y in _places(0, depth, height / 2):
                ahead = y + self._ahead
                sums.append(self._share[aside & (ahead >= 0) & (ahead <= depth)].sum())
        return float(np.mean(sums))


def _contrast(luminaire: Luminaire, endwise: bool, xs: Floats, ys: Floats) -> float:
    """The sum of L2 omega / p2 over what the observer sees."""
    x, y = (each.ravel() for each in np.meshgrid(xs, ys))
    ways = np.stack([x, y, np.full_like(x, height)], 1)
    distance = np.linalg.norm(ways, axis=1)
    ways /= distance[:, None]
    seen = (np.abs(x) <= farthest_aside * y) & (ways[:, 2] >= lowest_cosine)
    ways, distance = ways[seen], distance[seen]
    in_lamp = _in_lamp(luminaire, endwise, -ways)
    area = luminaire.projected_area(in_lamp)
    bright = area > 0
    ways, distance, in_lamp, area = ways[bright], distance[bright], in_lamp[bright], area[bright]
    sigma = np.degrees(np.arccos(np.minimum(1, ways[:, 1])))
    tau = np.degrees(np.arctan2(np.abs(ways[:, 0]), ways[:, 2]))
    guth = np.exp((35.2 - 0.31889 * tau - 1.22 * np.exp(-2 * tau / 9)) * 1e-3 * sigma
                  + (21 + 0.26667 * tau - 0.002963 * tau**2) * 1e-5 * sigma**2)
    return float(np.sum((luminaire.intensity(in_lamp) / area) ** 2 * area / distance**2 / guth**2))


def table(luminaire: Luminaire, spacing: float) -> dict[str, list[list[float | None]]]:
    """For each view and room the ratings of all reflectances; None where nothing is visible.

    spacing   of the luminaires, over their height above the eyes
    """
    rated: dict[str, list[list[float | None]]] = {}
    for view in views:
        light = _DownwardLight(luminaire, view == "endwise")
        rows = rated[view] = []
        for room in rooms:
            half_width, depth = room[0] * height / 2, room[1] * height
            xs, ys = _places(-half_width, half_width, spacing * height), _places(0, depth, spacing * height)
            floor = light.on_floor(half_width, depth)
            direct = floor, light.whole - floor, 1 - light.whole
            contrast = _contrast(luminaire, view == "endwise", xs, ys)
            wall_area = 2 * height * (2 * half_width + depth)
            row: list[float | None] = []
            for each in reflectances:
                indirect = (luminaire.flux * len(xs) * len(ys) / wall_area
                            * sum(a * b for a, b in zip(direct, transfer_factors(room, each))))
                background = indirect / math.pi
                row.append(8 * math.log10(0.25 / background * contrast)
                           if background > 0 and 0 < contrast < math.inf else None)
            rows.append(row)
    return rated


def _lines(rated: dict[str, list[list[float | None]]], corrected: bool) -> str:
    def text(value: float | None) -> str:
        return "-" if value is None else texts.glare(value) if corrected else f"{value:.1f}"

    lines = [f"{name:<11}" + "  ".join(["".join(f"{each[i]:>6.2f}" for each in reflectances)] * 2)
             for i, name in enumerate(("ceiling", "walls", "floor"))]
    lines.append(f"{'room':<11}{'  crosswise':<32}  endwise")
    for i, room in enumerate(rooms):
        values = ("".join(f"{text(value):>6}" for value in rated[view][i]) for view in views)
        lines.append(f"{f'{room[0]}H x {room[1]}H':<11}" + "  ".join(values))
    return "\n".join(lines) + "\n"


def _csv(rated: dict[str, list[list[float | None]]]) -> str:
    lines = [",".join(["across,along", *(f"{view} " + "/".join(f"{100 * part:.0f}" for part in (c, w, f))
                                         for view in views for c, w, f in reflectances)])]
    for i, room in enumerate(rooms):
        values = ("" if value is None else f"{value:.4g}" for view in views for value in rated[view][i])
        lines.append(",".join([f"{room[0]},{room[1]}", *values]))
    return "\n".join(lines) + "\n"


def _json(rated: dict[str, list[list[float | None]]]) -> str:
    of_rooms: list[dict[str, Any]] = [
        {"across": float(room[0]), "along": float(room[1]), **{view: rated[view][i] for view in views}}
        for i, room in enumerate(rooms)]
    content = {"reflectances": reflectances, "rooms": of_rooms}
    return json.dumps(content, indent=1) + "\n"


def written(record: dict[str, Any]) -> dict[str, str]:
    """The table in the format of a file's ending; ``.txt`` is for reading."""
    luminaire = Luminaire(record)
    rated = table(luminaire, record["spacing"])
    uncorrected = record["per_thousand_lumens"]
    if uncorrected:  # those of a lamp of 1000 lm with the same distribution
        less = 8 * math.log10(luminaire.flux / 1000)
        rated = {view: [[None if value is None else value - less for value in row] for row in rated[view]]
                 for view in views}
    return {".txt": _lines(rated, not uncorrected), ".csv": _csv(rated), ".json": _json(rated)}
