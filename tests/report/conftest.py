"""photile.report as it lies in python/, and a record to draw."""

import importlib.util
import pathlib
import sys

import pytest

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "python/photile/report"

spec = importlib.util.spec_from_file_location("photile_report", FOLDER / "__init__.py",
                                              submodule_search_locations=[str(FOLDER)])
sys.modules[spec.name] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(sys.modules[spec.name])

COLOURS = {"scale": 1000, "steps": 8, "decades": 0, "label": "lux", "contours": "cells",
           "palette": " ".join(f"#{i:02x}0000" for i in range(256))}


def measured(value, error=0.1):
    return {"value": value, "standard_error": error}


def grid_of(name, lux, columns=3, rows=2, level=0.75, **more):
    """A plane of cells of a metre. None = a cell without a sensor."""
    cells = [cell for cell, value in enumerate(lux) if value is not None]
    known = [lux[cell] for cell in cells]
    mean, least, most = sum(known) / len(known), min(known), max(known)
    return {
        "name": name, "points": len(known),
        "plane": {"origin": [0, level, 0], "u": [columns, 0, 0], "v": [0, 0, -rows],
                  "columns": columns, "rows": rows, "cells": cells},
        "statistics": {"Em": measured(mean), "Emin": {**measured(least), "at_most": least},
                       "Emax": {**measured(most), "at_least": most},
                       "Uo": measured(least / mean, 0.01), "Ud": measured(least / most, 0.01)},
        "sensors": [{"position": [cell % columns + 0.5, level, -(cell // columns) - 0.5], "direction": [0, 1, 0],
                     "lux": lux[cell], "standard_error": 0.1} for cell in cells], **more}


@pytest.fixture
def record():
    return {
        "photile": "0.1", "scene": "room <1>.gltf", "date": "2026-11-28", "unit": "lux",
        "response": "planar", "maintenance_factor": 0.8, "integrator": "photon-map", "seed": 1,
        "repeats": 3, "rays": 64, "photons": 20000, "neighbours": 50,
        "room": {"area": 6.0, "sides": [3.0, 2.0], "height": 2.5},
        "luminaires": [{"number": 1, "name": "lamp", "kind": "point", "file": "a.ies",
                        "position": [1.5, 2.2, -1], "lumens": 12000.0}],
        "photometry": [{"name": "a.ies", "pieces": 2, "lumens": 12000.0, "watts": 100.0,
                        "flux": 6000.0, "ra": 90.0, "data": [["maker", "Good & Ltd"]],
                        "intensities": {"C0": [0.0, 100.0, 300.0, 100.0, 0.0],
                                        "C90": [0.0, 50.0, 300.0, 50.0, 0.0]}}],
        "reflectances": [{"material": "wall", "reflectance": 0.61}],
        "grids": [grid_of("working plane", [100, 200, 300, 100, 200, 300])],
        "report": {"project": "", "client": "", "designer": "", "logo": "", "language": "en",
                   "colours": dict(COLOURS)}}
