"""The progress of long work, told to a function or on a line."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Callable, Union

from . import _photile
from .errors import UsageError

__all__ = ["Progress", "heard_by"]

Progress = Union[None, bool, Callable[[str, int, int, str], object]]


class _Line:
    """Stages on standard error: a line each, which terminals and notebooks see grow."""

    def __init__(self) -> None:
        self._stage, self._text, self._start, self._shown = "", "", 0.0, 0.0
        # The streams of notebooks are no terminals, yet obey a carriage return.
        self._grows = sys.stderr.isatty() or "ipykernel" in sys.modules

    def __call__(self, stage: str, done: int, total: int, unit: str) -> None:
        now = time.monotonic()
        if stage != self._stage:
            self.end()
            self._stage, self._start, self._shown = stage, now, 0.0
        share = f"{100 * done / total:3.0f}% of {total:,} {unit}" if total else f"{done:,} {unit}"
        self._text = f"{stage}: {share}, {now - self._start:.1f} s".ljust(len(self._text))
        if self._grows and now - self._shown >= 0.2:  # a notebook keeps each
            print("\r" + self._text, end="", file=sys.stderr, flush=True)
            self._shown = now

    def end(self) -> None:
        if self._text:
            print("\r" + self._text if self._grows else self._text.rstrip(), file=sys.stderr, flush=True)
        self._text = ""


@contextmanager
def heard_by(progress: Progress) -> Iterator[_photile.Callback]:
    """What the extension calls for the `progress` of a public function, while its work lasts."""
    if not isinstance(progress, bool):
        if progress is not None and not callable(progress):
            raise UsageError(f"progress: {progress!r} is neither a function nor True")
        yield progress
        return
    line = _Line() if progress else None
    try:
        yield line
    finally:
        if line:
            line.end()
