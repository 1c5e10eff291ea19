"""Numbers as people read them, and words in other languages."""

from __future__ import annotations

import json
import math
import pathlib
import re
from collections.abc import Iterable, Sequence
from typing import Any

_words = pathlib.Path(__file__).resolve().parent / "words"
least_glare = 10.0  # ratings below it have no meaning (CIE 117)
_figure = "1,234.5"  # whose translation has the separators of a language
_of_figures = re.compile(r"(?<=\d)[.,](?=\d)|, (?=[-\d])")
_only_figures = re.compile(r"[-\d.,]+%?")
_found_room = re.compile(r"room (\d+)(?:: (.+))?")
_blank = re.compile(r"\{[^}]*\}")
most_letters = 2000  # of a text that patterns are tried on


def number(value: float | None, digits: int) -> str:
    """A number with this many significant digits; large ones are whole: "12500", not "1.25e+04"."""
    if value is None:
        return "nan"
    if 10**digits - 0.5 <= abs(value) < 1e9:
        return f"{value:.0f}"
    return f"{value:.{digits}g}"


def grouped(value: float, digits: int) -> str:
    """The same with groups of three from 10,000 on: "0.5857", "6000", "11,990"."""
    text = number(value, digits)
    return f"{int(text):,}" if text.lstrip("-").isdigit() and abs(int(text)) >= 10000 else text


def place(position: Sequence[float] | None) -> str:
    return ", ".join(f"{one:.2f}" for one in position or ())


def glare(rating: float) -> str:
    return f"<{least_glare:g}" if rating < least_glare else f"{rating:.1f}"


def rounded_up(value: float, steps: Sequence[float]) -> float:
    """The least product, not below the value, of a step (ascending from 1) and a power of ten."""
    decade = 10.0 ** math.floor(math.log10(value))
    return next((step * decade for step in steps if step * decade >= value), 10 * decade)


class _Localised:
    """A number that is formatted with the signs of a language."""

    def __init__(self, value: Any, words: Words) -> None:
        self._value, self._words = value, words

    def __format__(self, how: str) -> str:
        return self._words.figure(format(self._value, how))


class Words:
    """English texts in another language; a text that its file lacks stays English.

    Texts of the file may have blanks, ``{}``: what the record says with numbers and names in it is
    translated by them.

    Raises KeyError with the available languages.
    """

    def __init__(self, language: str = "en", folders: Iterable[pathlib.Path] = ()) -> None:
        self.language = language
        self._words: dict[str, str] = {}
        files = {file.stem: file for folder in (_words, *(each / "words" for each in folders))
                 for file in sorted(folder.glob("*.json"))}
        if language != "en":
            if language not in files:
                raise KeyError(", ".join(["en", *files]))
            self._words = json.loads(files[language].read_text(encoding="utf-8"))
        self._patterns = [(re.compile("(.+?)".join(map(re.escape, _blank.split(english)))), other)
                          for english, other in self._words.items()
                          if "{" in english and len(_blank.sub("", english).strip()) > 3]
        figure = self._words.get(_figure, _figure)
        self._signs = {",": figure[1], ".": figure[5], ", ": "; " if figure[5] == "," else ", "}

    def __call__(self, english: str, *values: Any) -> str:
        text = self._words.get(english)
        if values:
            return (text or english).format(*(value if isinstance(value, str) else _Localised(value, self)
                                              for value in values))
        return self._filled(english) if text is None else text

    def _filled(self, english: str) -> str:
        """A text by the first pattern that fits; the text itself without one. Grids of one of several rooms are named
        "room 2: north wall"."""
        if room := _found_room.fullmatch(english):
            return f"{self('room')} {room[1]}" + (f": {self(room[2])}" if room[2] else "")
        for pattern, other in self._patterns if len(english) < most_letters else ():
            if found := pattern.fullmatch(english):
                return _blank.sub("{}", other).format(*map(self._part, found.groups()))
        name, colon, part = english.rpartition(": ")
        return name + colon + self(part) if colon else english

    def _part(self, text: str) -> str:
        return self.figure(text) if _only_figures.fullmatch(text) else self(text)

    def figure(self, text: str) -> str:
        """A text of numbers with the signs of the language: "1.50, 12,000 lm" is "1,50; 12.000 lm" in
        German."""
        return _of_figures.sub(lambda found: self._signs[found[0]], text)
