"""Numbers as people read them, and words in other languages."""

from __future__ import annotations

import json
import math
import pathlib
from collections.abc import Sequence
from typing import Any

_words = pathlib.Path(__file__).resolve().parent / "words"
least_glare = 10.0  # ratings below it have no meaning (CIE 117)


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


def count(value: float) -> str:
    """"512", "50.0k", "1.2M"."""
    for suffix in ("", "k", "M", "G"):
        if abs(value) < 999.5:
            break
        value /= 1000
    else:
        suffix = "T"
    return f"{value:.1f}{suffix}" if suffix else f"{value:.3g}"


def place(position: Sequence[float] | None) -> str:
    return ", ".join(f"{one:.2f}" for one in position or ())


def glare(rating: float) -> str:
    return f"<{least_glare:g}" if rating < least_glare else f"{rating:.1f}"


def rounded_up(value: float, steps: Sequence[float]) -> float:
    """The least product, not below the value, of a step (ascending from 1) and a power of ten."""
    decade = 10.0 ** math.floor(math.log10(value))
    return next((step * decade for step in steps if step * decade >= value), 10 * decade)


class Words:
    """English texts in another language; a text that its file lacks stays English.

    Raises KeyError with the available languages.
    """

    def __init__(self, language: str, folders: Sequence[pathlib.Path]) -> None:
        self.language = language
        self._words: dict[str, str] = {}
        files = {file.stem: file for folder in (_words, *(each / "words" for each in folders))
                 for file in sorted(folder.glob("*.json"))}
        if language != "en":
            if language not in files:
                raise KeyError(", ".join(["en", *files]))
            self._words = json.loads(files[language].read_text(encoding="utf-8"))

    def __call__(self, english: str, *values: Any) -> str:
        text = self._words.get(english, english)
        return text.format(*values) if values else text
