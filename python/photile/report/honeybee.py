"""Results in the files that Honeybee and Ladybug Tools read."""

from __future__ import annotations

import io
import json
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

_hours_of_common_year = 8760
_group = "blinds"  # of apertures
Files = Iterator[tuple[str, bytes]]


def _json(content: Any, indent: int = 2) -> bytes:
    return (json.dumps(content, indent=indent, ensure_ascii=False) + "\n").encode()


def _info(grid: dict[str, Any], count: int) -> dict[str, Any]:
    return {"name": grid["name"], "identifier": grid["identifier"], "full_id": grid["identifier"],
            "group": "", "count": count}


def measured(record: dict[str, Any]) -> Files:
    """``<grid>.res`` with the lux of a point on each line, ``grids_info.json``, and
    ``grid_summary.csv`` in the form of honeybee-radiance-postprocess (uniformity in per cent)."""
    infos = []
    summary = ["Sensor Grid,Sensor Grid ID,Mean,Minimum,Maximum,Uniformity Ratio\n"]
    for grid in record["grids"]:
        lines = ["nan" if sensor["lux"] is None else f"{sensor['lux']:.6g}" for sensor in grid["sensors"]]
        for number, blank in enumerate(grid.get("blank", [])):  # lines stay those of the grid's points
            lines.insert(blank["before"] + number, "nan")
        yield grid["identifier"] + ".res", "".join(line + "\n" for line in lines).encode()
        infos.append(_info(grid, len(lines)))
        mean, least, most, uniformity = (
            float("nan") if grid["statistics"][name]["value"] is None else grid["statistics"][name]["value"]
            for name in ("Em", "Emin", "Emax", "Uo"))
        summary.append(f"{grid['identifier']},{grid['identifier']},{mean:.6g},{least:.6g},{most:.6g},"
                       f"{100 * uniformity:.4g}\n")
    yield "grids_info.json", _json(infos)
    yield "grid_summary.csv", "".join(summary).encode()


def _number(lux: float) -> str:
    """A number with four digits, or all digits before the point."""
    decimals = 4 if lux < 1 else 3 if lux < 10 else 2 if lux < 100 else 1 if lux < 1000 else 0
    return "0" if lux < 5e-5 else f"{lux:.{decimals}f}"


def _lines(lux: NDArray[np.float32]) -> bytes:
    return "".join(" ".join(map(_number, row)) + "\n" for row in lux.tolist()).encode()


def _array(lux: NDArray[np.float32]) -> bytes:
    stream = io.BytesIO()
    np.save(stream, lux)
    return stream.getvalue()


def of_year(record: dict[str, Any], values: pathlib.Path) -> Files:
    """Results of the hours with the sun up: ``<grid>.ill`` with a line for each point,
    ``<grid>_direct.ill`` of the sun alone, and both as arrays. Blinds are an aperture group with a
    folder for each of their states.

    values   lux by point and hour, as floats: of each grid by the schedule, and in each state where there are
             states; the sun's follow each
    """
    hours, up, with_states = record["hours"], record["up"], record["states"] > 0
    infos, states = [], {}
    with open(values, "rb") as stream:
        def profiles(count: int) -> list[tuple[str, NDArray[np.float32]]]:
            return [(kind, np.fromfile(stream, np.float32, count * hours).reshape(count, hours)[:, up])
                    for kind in ("total", "direct")[:1 + record["sun"]]]

        for grid in record["grids"]:
            name, count = grid["identifier"], grid["count"]
            scheduled = profiles(count)
            for kind, lux in scheduled:
                yield name + {"total": ".ill", "direct": "_direct.ill"}[kind], _lines(lux)
            names = [f"{number}_{_group}" for number in range(record["states"])]
            for state in names or [""]:
                folder = f"{_group}/{state}" if with_states else "__static_apertures__/default"
                for kind, lux in profiles(count) if with_states else scheduled:
                    yield f"{folder}/{kind}/{name}.npy", _array(lux)
            if with_states:
                states[name] = {_group: names}
            light_path = _group if with_states else "__static_apertures__"
            infos.append({**_info(grid, count), "light_path": [[light_path]]})
    yield "sun-up-hours.txt", "".join(f"{hour + 0.5:g}\n" for hour in up).encode()
    yield "grids_info.json", _json(infos)
    yield "grid_states.json", _json(states)
    if with_states and hours == _hours_of_common_year:
        yield "states_schedule.json", _json({_group: {
            "identifier": _group, "schedule": record["state_of_hour"], "is_static": False}}, 1)


def files(record: dict[str, Any], folder: pathlib.Path) -> Files:
    """The content of each file, by its path in Honeybee's folder.

    folder   of the record
    """
    return of_year(record, folder / "values") if "hours" in record else measured(record)
