"""The luminaires of a record by type: the tags that plans, drawings and the list of parts have in common."""

from __future__ import annotations

import dataclasses
import math
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_number_at_end = re.compile(r"[ _.-]*\d+([ _.-]\d+)*$")


def tag(index: int) -> str:
    """A to Z, then AA, AB ..."""
    return (tag(index // 26 - 1) if index >= 26 else "") + chr(ord("A") + index % 26)


def outline_of(corners: Floats, is_round: bool) -> Floats:
    """The outline of a luminous opening, whose corners a plan has: a round one is in the scene as a
    rectangle of the same area."""
    if not is_round or len(corners) != 4:
        return corners
    angle = np.linspace(0, 2 * math.pi, 36, endpoint=False)[:, None]
    along, across = ((corners[i] - corners[0]) / math.sqrt(math.pi) for i in (1, 3))
    outline: Floats = corners.mean(axis=0) + np.cos(angle) * along + np.sin(angle) * across
    return outline


Kind = tuple[str, Any, Any]


def kind_of(entry: dict[str, Any], name: str = "file") -> Kind:
    """By what a luminaire and a photometric file, with `name`, of a record belong together: the file, and the colour
    temperature and the maintenance factor that a list of luminaires states."""
    return entry[name], entry.get("kelvin"), entry.get("maintenance_factor")


@dataclasses.dataclass
class Type:
    """Luminaires of one photometric file, or of one name but for the number at its end.

    lumens   of all together, as planned
    watts    the same; 0 = not known
    round    whether its luminous opening is
    colour   "3000 K", where others of the same file have another colour
    maintenance   its own factor; 0 = that of the measurement
    """

    tag: str
    name: str
    pieces: int = 0
    lumens: float = 0.0
    watts: float = 0.0
    round: bool = False
    colour: str = ""
    maintenance: float = 0.0
    data: dict[str, str] = dataclasses.field(default_factory=dict)

    def lines(self) -> list[str]:
        """What identifies it: maker and article, then its name."""
        made = " ".join(filter(None, (self.data.get("maker"), self.data.get("article"))))
        return list(dict.fromkeys(filter(None, (made, self.data.get("luminaire") or self.name,
                                                  self.colour))))


class Luminaires:
    """The types of a record, without skies and suns, which have no position: those with photometric files
    first, in the order of the luminaires.

    of_number   the type of a luminaire, by the number that the record and plans give it
    of_kind     the type of a photometric file
    parts       the types of the list of parts: those with files where there are some
    """

    def __init__(self, record: dict[str, Any]) -> None:
        self.rows = [lamp for lamp in record.get("luminaires", []) if lamp["position"]]
        sheets = {kind_of(part, "name"): part for part in record.get("photometry", [])}
        self.types: list[Type] = []
        kinds = dict.fromkeys([kind for kind in map(kind_of, self.rows) if kind in sheets] + list(sheets))
        self.of_kind = {kind: self._add(kind[0], sheets[kind]) for kind in kinds}
        for kind, one in self.of_kind.items():
            if len({other for name, other, _ in kinds if name == kind[0]}) > 1 and kind[1]:
                one.colour = f"{kind[1]:.0f} K"
        self.parts = list(self.types)
        self.of_number: dict[int, Type] = {}
        others: dict[str, Type] = {}
        for lamp in self.rows:
            if kind_of(lamp) in sheets:
                self.of_number[int(lamp["number"])] = self.of_kind[kind_of(lamp)]
                continue
            name = _number_at_end.sub("", lamp["name"]) or lamp["name"]
            if name not in others:
                others[name] = self._add(name)
            self.of_number[int(lamp["number"])] = others[name]
            others[name].pieces += 1
            others[name].lumens += lamp["lumens"]
        self.parts = self.parts or self.types

    def _add(self, name: str, part: dict[str, Any] | None = None) -> Type:
        """A type, with the sums of its photometric file where it has one."""
        added = Type(tag(len(self.types)), name)
        if part:
            added.pieces, added.lumens, added.watts = int(part["pieces"]), part["lumens"], part["watts"]
            added.round, added.data = bool(part.get("round")), dict(part["data"])
            added.maintenance = part.get("maintenance_factor") or 0.0
        self.types.append(added)
        return added

    def watts(self, lamp: dict[str, Any]) -> float:
        """The power of a luminaire, in proportion where it is dimmed; 0 = not known."""
        kind = self.of_number[int(lamp["number"])]
        return float(kind.watts * lamp["lumens"] / kind.lumens) if kind.lumens > 0 else 0.0

    def tag(self, number: int) -> str:
        """The type's letter and the luminaire's number: "B7"."""
        return (self.of_number[number].tag if number in self.of_number else "") + str(number)
