"""Melanopic equivalent daylight illuminance (melanopic EDI, CIE S 026:2018), by illuminance at the eye and the colour
temperatures of luminaires.

melanopic EDI is illuminance times the melanopic daylight efficacy ratio (DER) of the light, which its spectrum has.
The ratio of white LEDs is approximated by those of the CIE's typical ones.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from .luminaires import kind_of
from .tables import Table, table

# The illuminants LED-B1 to LED-B5 of CIE 15:2018, blue LEDs with phosphors: correlated colour temperature, and
# melanopic DER from their spectra, the melanopic action spectrum of CIE S 026 and V(lambda) at each nanometre, over
# that of D65, 1.326 mW/lm.
_temperatures = (2733.0, 2998.0, 4103.0, 5109.0, 6598.0)
_ratios = (0.406, 0.458, 0.632, 0.690, 0.855)
_lowest, _highest = 2500.0, 7000.0  # kelvin, beyond which the ratios of other LEDs say nothing
_daylight = 1.0  # of D65, by definition
_thresholds = (136, 250)  # lux: WELL v2, feature L03, for 1 point and for 3 points


def ratio_of(temperature: float) -> float | None:
    """The melanopic DER of a white LED of a colour temperature, kelvin; None beyond those that are known."""
    if not _lowest <= temperature <= _highest:
        return None
    return float(np.interp(temperature, _temperatures, _ratios))


def _ratio_of_file(part: dict[str, Any]) -> float | None:
    """That of a photometric file; None where it states no colour temperature, or a range of them."""
    found = re.fullmatch(r"(\d+) K", dict(part["data"]).get("colour temperature", ""))
    return ratio_of(float(found[1])) if found else None


def _ratio_of_all(ratios: set[float | None]) -> float | None:
    """The ratio that all lights have; None where one is unknown or they differ."""
    return ratios.copy().pop() if len(ratios) == 1 else None


def _ratios_of(record: dict[str, Any]) -> tuple[float | None, dict[str, float | None]]:
    """The ratio of all lights together, and those of lights that are measured apart, by their names."""
    of_kind = {kind_of(part, "name"): _ratio_of_file(part) for part in record.get("photometry", [])}
    of_name: dict[str, set[float | None]] = {}
    for lamp in record.get("luminaires", []):
        outside = not lamp["position"]  # skies and suns
        if lamp["lumens"] > 0 or outside:
            of_name.setdefault(lamp["name"], set()).add(_daylight if outside else of_kind.get(kind_of(lamp)))
    names = [light["name"] for light in record.get("lights", [])]
    others = {one for name, ratios in of_name.items() if name not in names for one in ratios}
    apart = {name: _ratio_of_all(of_name.get(name, others)) for name in names}
    return _ratio_of_all({one for ratios in of_name.values() for one in ratios}), apart


def _at_eyes(record: dict[str, Any]) -> list[dict[str, Any]]:
    """Grids of cylindrical illuminance; beside a horizontal one also those of vertical illuminance, but for walls."""
    grids = [grid for grid in record.get("grids", []) if grid.get("sensors")]
    every = record.get("response") == "cylindrical"
    up = next((np.array(grid["sensors"][0]["direction"], float) for grid in grids
               if grid["name"] in ("working plane", "cylindrical")), None)

    def vertical(grid: dict[str, Any]) -> bool:
        directions = np.array([sensor["direction"] for sensor in grid["sensors"]], float)
        return up is not None and not grid["name"].endswith(" wall") and bool((np.abs(directions @ up) < 0.1).all())

    return [grid for grid in grids if every or grid["name"] == "cylindrical"
            or ("semi-cylindrical" not in grid["name"] and vertical(grid))]


def _edi(sensor: dict[str, Any], together: float | None, apart: dict[str, float | None]) -> float | None:
    if together is not None:
        return together * float(sensor["lux"])
    found = 0.0
    for name, light in sensor.get("lights", {}).items():
        ratio = apart.get(name)
        if light["lux"] > 0 and ratio is None:
            return None
        found += float(light["lux"]) * (ratio or 0)
    return found if "lights" in sensor else None


def melanopic_table(record: dict[str, Any]) -> Table | None:
    """A row for each grid at the height of eyes; None where there are none or a light's colour is unknown."""
    together, apart = _ratios_of(record)
    rows = []
    for grid in _at_eyes(record):
        values = [_edi(sensor, together, apart) for sensor in grid["sensors"]]
        known = np.array([value for value in values if value is not None])
        lux = grid["statistics"]["Em"]["value"]
        if len(known) < len(values) or not lux:
            continue
        rows.append([grid["name"], f"{lux:.0f}", f"{known.mean() / lux:.2f}", f"{known.mean():.0f}",
                     f"{known.min():.0f}", *(f"{100 * (known >= least).mean():.0f}%" for least in _thresholds)])
    if not rows:
        return None
    return table("Melanopic EDI (CIE S 026)",
                 ["grid", "mean, lux", "melanopic DER", "melanopic EDI, lux", "least, lux",
                  *(f"{least} lux or more" for least in _thresholds)], rows, words=(0,), kind="figures",
                 remark="An approximation: the spectra of luminaires are those that typical LEDs of their "
                        "colour temperature have (LED-B1 to LED-B5 of CIE 15:2018); others of the same colour "
                        "have up to 35% more. Colours are those that photometric files or lists of luminaires "
                        "state; light from outside counts "
                        "as D65. WELL v2 (L03) asks for 136 lux (1 point) or 250 lux (3 points) vertically at "
                        "the eyes.")
