"""Tables of texts, which the templates draw, and the targets of a record."""

from __future__ import annotations

from typing import Any

Table = dict[str, Any]


def targets_of(record: dict[str, Any]) -> list[dict[str, Any]]:
    """What is required, each with what is judged by it. Older results have one target for all grids."""
    one = [record["target"]] if record.get("target") else []
    found: list[dict[str, Any]] = record.get("targets", one)
    return found


def table(heading: str, columns: list[str], rows: list[list[Any]], words: tuple[int, ...] = (),
          names: tuple[int, ...] = (), **more: Any) -> Table:
    """A table whose rows have texts, or lists of them for lines.

    words   columns whose texts are translated
    names   columns whose texts stay as they are; the others are numbers
    more    what the template asks for: `kind` of its style, `of` how many it has the worst, a `plan`, a `remark`
    """
    return {"heading": heading, "columns": columns, "rows": rows, "words": words, "names": names, **more}
