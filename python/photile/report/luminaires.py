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


@dataclasses.dataclass
class Type:
    """Luminaires of one photometric file, or of one name but for the number at its end.

    lumens   of all together, as planned
    watts    the same; 0 = not known
    round    whether its luminous opening is
    """

    tag: str
    name: str
    pieces: int = 0
    lumens: float = 0.0
    watts: float = 0.0
    round: bool = False
    data: dict[str, str] = dataclasses.field(default_factory=dict)

    def lines(self) -> list[str]:
        """What identifies it: maker and article, then its name."""
        made = " ".join(filter(None, (self.data.get("maker"), self.data.get("article"))))
        return list(dict.fromkeys(filter(None, (made, self.data.get("luminaire") or self.name))))


class Luminaires:
    """The types of a record, without skies and suns, which have no position: those with photometric files
    first, in the order of the luminaires.

    of_number   the type of a luminaire, by the number that the record and plans give it
    parts       the types of the list of parts: those with files where there are some
    """

    def __init__(self, record: dict[str, Any]) -> None:
        self.rows = [lamp for lamp in record.get("luminaires", []) if lamp["position"]]
        sheets = {part["name"]: part for part in record.get("photometry", [])}
        self.types: list[Type] = []
        of_file = {name: self._add(name, sheets[name]) for name in
                   dict.fromkeys([lamp["file"] for lamp in self.rows if lamp["file"] in sheets] + list(sheets))}
        self.parts = list(self.types)
        self.of_number: dict[int, Type] = {}
        others: dict[str, Type] = {}
        for lamp in self.rows:
            if lamp["file"] in sheets:
                self.of_number[int(lamp["number"])] = of_file[lamp["file"]]
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
        self.types.append(added)
        return added

    def watts(self, lamp: dict[str, Any]) -> float:
        """The power of a luminaire, in proportion where it is dimmed; 0 = not known."""
        kind = self.of_number[int(lamp["number"])]
        return float(kind.watts * lamp["lumens"] / kind.lumens) if kind.lumens > 0 else 0.0

    def tag(self, number: int) -> str:
        """The type's letter and the luminaire's number: "B7"."""
        return (self.of_number[number].tag if number in self.of_number else "") + str(number)
