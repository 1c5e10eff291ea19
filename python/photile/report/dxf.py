"""Planes of values as drawings in DXF, in metres, for the architect's plan: by ezdxf.

Where a plane is horizontal, x and y are those of the scene seen from the side that the plane faces, so that the
drawing lies on the architect's; elsewhere they run along the plane's sides from its corner. z is the height.
"""

from __future__ import annotations

import importlib
import io
import itertools
import math
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .isolines import Contours, Writing, on_cells, place_numbers
from .luminaires import Luminaires, outline_of
from .plans import letter_width
from .scale import illuminance_steps
from .texts import Words, number

Floats = NDArray[np.float64]
# Not all installations have it: types are checked without it.
ezdxf: Any = importlib.import_module("ezdxf")
enums, units, zoom = (importlib.import_module(f"ezdxf.{name}") for name in ("enums", "units", "zoom"))

layers = {"ROOM": 7, "FURNITURE": 8, "AREA": 4, "POINTS": 1, "VALUES": 7, "ISOLINES": 3, "LUMINAIRES": 6}
_along = (1.0, 0.0, 0.0)
_sub_path = re.compile(r"M[^M]*")
_place = re.compile(r"[ML](-?[\d.]+) (-?[\d.]+)")


def _line(text: str) -> str:
    """A text on one line: lines of the file have a meaning of their own."""
    return " ".join(text.split())


class Frame:
    """The coordinates of the drawing on a plane of the scene's world."""

    def __init__(self, plane: dict[str, Any], horizontal: bool) -> None:
        self._origin, u, v = (np.array(plane[side], float) for side in ("origin", "u", "v"))
        self.size = np.array([np.linalg.norm(u), np.linalg.norm(v)])
        self._u, self._v = u / self.size[0], v / self.size[1]
        normal = np.cross(self._u, self._v)
        if horizontal:
            self._axes = np.array([_along, np.cross(normal, _along), normal])
            self._zero = np.zeros(3)
        else:
            self._axes, self._zero = np.array([self._u, self._v, normal]), self._origin

    def of_world(self, places: Any) -> Floats:
        """Positions of the drawing [x, y, z]."""
        found: Floats = (np.reshape(np.asarray(places, float), (-1, 3)) - self._zero) @ self._axes.T
        return found

    def of_plane(self, metres: Any) -> Floats:
        """The same of positions along the plane's sides from its corner."""
        metres = np.reshape(np.asarray(metres, float), (-1, 2))
        return self.of_world(self._origin + metres[:, :1] * self._u + metres[:, 1:] * self._v)


def _unturned(outline: Floats) -> tuple[Floats, float]:
    """An outline with its longest edge along x, and the angle by which that was turned, radians."""
    edges = np.roll(outline, -1, axis=0) - outline
    longest = edges[np.argmax(np.hypot(*edges.T).round(6))]
    angle = math.atan2(longest[1], longest[0]) % math.pi
    cosine, sine = math.cos(angle), math.sin(angle)
    turned = outline @ np.array([[cosine, -sine], [sine, cosine]])
    first = min(range(len(turned)), key=lambda i: tuple(turned[i].round(6)))
    return np.roll(turned, -first, axis=0), angle


class Drawing:
    """The drawing of a grid with a plane.

    values   at the grid's sensors; isolines run at the steps of EN 12464-1 between them
    """

    def __init__(self, grid: dict[str, Any], values: list[float | None], luminaires: Luminaires,
                 words: Words) -> None:
        # The time of writing and random marks would make the same drawing another file.
        ezdxf.options.write_fixed_meta_data_for_testing = True
        self._document = ezdxf.new("R2010")
        self._document.units = units.M
        self._document.header["$MEASUREMENT"] = 1
        for name, colour in layers.items():
            self._document.layers.add(name, color=colour)
        self._space = self._document.modelspace()
        self._words, self._luminaires = words, luminaires
        plane, plan = grid["plane"], grid.get("plan") or {}
        self._frame = Frame(plane, plan.get("reach", 0) > 0)
        self._writing = Writing()
        self._surround(plan)
        self._add_values(plane, values)
        self._blocks: dict[str, Floats] = {}
        reach = float(plan.get("reach", 0))
        zoom.window(self._space, *self._frame.of_plane([(-reach, -reach), self._frame.size + reach])[:, :2])
        rows = {int(row["number"]): row for row in luminaires.rows}
        for lamp in plan.get("lamps", []):
            self._add_luminaire(lamp, rows[int(lamp["number"])])

    def written(self) -> bytes:
        """The file."""
        classes = self._document.classes
        classes.add_required_classes(self._document.dxfversion)
        classes.classes = dict(sorted(classes.classes.items()))  # ezdxf adds them in the order of a set
        stream = io.StringIO()
        self._document.write(stream)
        return bytes(self._document.encode(stream.getvalue()))

    def _add_line(self, layer: str, places: Floats, close: bool = False) -> None:
        self._space.add_lwpolyline(places[:, :2], close=close,
                                   dxfattribs={"layer": layer, "elevation": float(places[0, 2])})

    def _add_text(self, layer: str, text: str, place: Any, height: float, turned: float = 0.0) -> None:
        entity = self._space.add_text(_line(text), dxfattribs={
            "layer": layer, "height": height, "rotation": turned})
        entity.set_placement(tuple(place), align=enums.TextEntityAlignment.MIDDLE_CENTER)

    def _surround(self, plan: dict[str, Any]) -> None:
        for layer, path in (("ROOM", plan.get("walls", "")), ("FURNITURE", plan.get("furniture", ""))):
            for part in _sub_path.findall(path):
                places = np.array(_place.findall(part), float)
                if len(places) > 1:
                    self._add_line(layer, self._frame.of_plane(places))
        if plan.get("room"):
            (left, low), (right, high) = plan["room"]
            self._add_rectangle("ROOM", left, low, right, high)
        self._add_rectangle("AREA", 0, 0, *self._frame.size)

    def _add_rectangle(self, layer: str, left: float, low: float, right: float, high: float) -> None:
        corners = [[left, low], [right, low], [right, high], [left, high]]
        self._add_line(layer, self._frame.of_plane(corners), True)

    def _add_values(self, plane: dict[str, Any], values: list[float | None]) -> None:
        by_cell = on_cells(plane, values)
        rows, columns = by_cell.shape
        cell = self._frame.size / (columns, rows)
        height = 0.2 * float(min(cell))
        known = by_cell[~np.isnan(by_cell)]
        middles = self._frame.of_plane((np.argwhere(~np.isnan(by_cell))[:, ::-1] + 0.5) * cell)
        for value, place in zip(known, middles):
            text = self._words.figure(number(value, 3))
            self._space.add_point(place, dxfattribs={"layer": "POINTS"})
            self._add_text("VALUES", text, place + (0, 0.8 * height, 0), height)
            width = letter_width * height * len(text)
            self._writing.add((place[0], place[1] + 0.8 * height), 0.0, width, height)
        if min(columns, rows) < 2 or not len(known):
            return
        contours = Contours(by_cell, self._frame.size)
        for level in illuminance_steps(min(known), max(known)):
            for line in contours.lines(level):
                self._add_isoline(self._frame.of_plane(line), number(level, 3), height)

    def _add_isoline(self, places: Floats, text: str, height: float) -> None:
        closed = bool(np.allclose(places[0], places[-1]))
        self._add_line("ISOLINES", places[:-1] if closed else places, closed)
        text = self._words.figure(text)
        width = letter_width * height * len(text)
        for x, y, angle in place_numbers(places[:, :2], width, height, self._writing, 80 * height):
            self._add_text("ISOLINES", text, (x, y, places[0, 2]), height, math.degrees(angle))

    def _add_luminaire(self, lamp: dict[str, Any], in_scene: dict[str, Any]) -> None:
        """A block of its type, turned as it is, with its tag, type and name as attributes."""
        number_of_lamp = int(lamp["number"])
        kind = self._luminaires.of_number[number_of_lamp]
        place, = self._frame.of_world(in_scene["position"])
        outline, turn = np.empty((0, 2)), 0.0
        if len(lamp.get("outline") or []) >= 3:
            corners = outline_of(np.array(lamp["outline"], float), kind.round)
            outline, turn = _unturned(self._frame.of_plane(corners)[:, :2] - place[:2])
        block = self._space.add_blockref(self._block_of(kind.tag, outline), tuple(place), dxfattribs={
            "layer": "LUMINAIRES", "rotation": math.degrees(turn)})
        block.add_auto_attribs({"TAG": self._luminaires.tag(number_of_lamp),
                                "TYPE": _line(" ".join(kind.lines())), "NAME": _line(in_scene["name"])})

    def _block_of(self, tag: str, outline: Floats) -> str:
        """The name of the block of a type: those of one type may differ in size."""
        for index in itertools.count(1):
            name = f"LUMINAIRE_{tag}" + (f"_{index}" if index > 1 else "")
            known = self._blocks.get(name)
            if known is None:
                break
            if len(known) == len(outline) and np.allclose(known, outline, atol=1e-3):
                return name
        self._blocks[name] = outline
        block = self._document.blocks.new(name)
        on_layer: dict[str, Any] = {"layer": "LUMINAIRES"}
        if len(outline):
            block.add_lwpolyline(outline, close=True, dxfattribs=on_layer)
        else:
            block.add_circle((0, 0), 0.05, dxfattribs=on_layer)
        for attribute, flags in (("TAG", 0), ("TYPE", 1), ("NAME", 1)):  # 1: hidden
            block.add_attdef(attribute, (0, 0), dxfattribs={**on_layer, "height": 0.1, "flags": flags})
        return name
