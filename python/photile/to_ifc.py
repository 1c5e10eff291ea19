"""Results of ``photile measure`` and ``photile glare`` as properties of the rooms of an IFC file: ``python3 -m photile.to_ifc``.

Needs ifcopenshell of PyPI, 0.8 or 0.9. buildingSMART defines the illuminance that a room requires
(Pset_SpaceLightingRequirements, since IFC 4.3 Pset_SpaceLightingDesign), and no property for one that was
found. Results therefore have a property set of their own.
"""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .command_line import exit_code, one_line
from .converters import write_files
from .errors import InputError, UsageError
from .ifc_building import ifc_module, in_ifc_child, most_above_ceiling, open_ifc
from .report.luminaires import kind_of
from .report.tables import targets_of

__all__ = ["write"]

_set = "Photile_SpaceLighting"  # "Pset_" is buildingSMART's


@dataclass(frozen=True)
class _Found:
    """What was measured in a room."""

    mean: float  # lux
    least: float  # lux
    uniformity: float
    maintenance: float | None  # factor; None where its luminaires differ
    watts: float | None  # of its luminaires; None where a photometric file does not state it
    ugr: float | None  # the highest of its observers
    required: float | None  # lux, as the IFC file has it
    met: bool | None  # None without a requirement

    def line(self, name: str) -> str:
        power = "" if self.watts is None else f", {self.watts:.4g} W"
        power += "" if self.ugr is None else f", UGR {self.ugr:.1f}"
        required = "" if self.required is None else f", required {self.required:g} lx"
        verdict = "" if self.met is None else ": met" if self.met else ": NOT MET"
        return f"{name}: Em {self.mean:.4g} lx, Uo {self.uniformity:.3f}{power}{required}{verdict}"


def _read(file: Path) -> Any:
    """Errors: InputError."""
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}; name a file of photile") from None
    except ValueError:
        raise InputError(f"{file}: this is not valid JSON; name a file of photile") from None


def _holds(room: dict[str, Any], position: list[float]) -> bool:
    """Whether a luminaire is in a room, or in the void above its ceiling. Coordinates are the scene's."""
    x, y, z = position
    if not -0.1 <= y - room["floor"] <= room["height"] + most_above_ceiling:
        return False
    shapely = importlib.import_module("shapely")
    return bool(shapely.contains_xy(shapely.Polygon([(corner[0], corner[2]) for corner in room["plan"]]), x, z))


def _found(room: dict[str, Any], results: dict[str, Any], observers: list[dict[str, Any]]) -> _Found | None:
    """The results of a room, or None where it was not measured.

    observers   of photile glare
    """
    grid = next((grid for grid in results["grids"] if grid["name"] == room["name"]), None)
    if grid is None:
        return None
    mean, least, uniformity = (float(grid["statistics"][name]["value"]) for name in ("Em", "Emin", "Uo"))
    watts_of = {kind_of(file, "name"): file["watts"] / file["pieces"] for file in results["photometry"]}
    lamps = [lamp for lamp in results["luminaires"] if lamp["position"] and _holds(room, lamp["position"])]
    watts = [watts_of.get(kind_of(lamp), 0.0) for lamp in lamps]
    factor = float(results["maintenance_factor"])
    factors = {float(lamp.get("maintenance_factor", factor)) for lamp in lamps} or {factor}
    ugr = max((one["ugr"]["value"] for one in observers
               if one["ugr"] and one["name"].rpartition(" ")[0] == room["observers"]), default=None)
    required = room["required_illuminance"]
    targets = [target for target in targets_of(results)
               if any(one["grid"] == room["name"] for one in target["judgements"])]
    verdicts = [one["met"] for target in targets for one in target["judgements"] if one["grid"] == room["name"]]
    if required is not None:
        verdicts.append(mean >= required)
    verdicts += [ugr <= target["ugr_limit"] for target in targets if ugr is not None and target["ugr_limit"]]
    return _Found(mean, least, uniformity, factors.pop() if len(factors) == 1 else None,
                  sum(watts) if watts and all(watts) else None, ugr, required, all(verdicts) if verdicts else None)


class _Properties:
    """Writes property sets into a model."""

    def __init__(self, model: Any, title: str) -> None:
        self._model, self._title = model, title
        self._lux, self._watt = self._unit("ILLUMINANCEUNIT", "LUX"), self._unit("POWERUNIT", "WATT")

    def _unit(self, kind: str, name: str) -> Any:
        known = (unit for unit in self._model.by_type("IfcSIUnit") if unit.Name == name and not unit.Prefix)
        return next(known, None) or self._model.create_entity("IfcSIUnit", UnitType=kind, Name=name)

    def _property(self, name: str, measure: str, value: Any, unit: Any = None) -> Any:
        value = self._model.create_entity(measure, float(f"{value:.4g}") if measure != "IfcBoolean" else value)
        return self._model.create_entity("IfcPropertySingleValue", Name=name, NominalValue=value, Unit=unit)

    def _of(self, found: _Found) -> list[Any]:
        properties = [self._property("AverageIlluminance", "IfcIlluminanceMeasure", found.mean, self._lux),
                      self._property("MinimumIlluminance", "IfcIlluminanceMeasure", found.least, self._lux),
                      self._property("Uniformity", "IfcNormalisedRatioMeasure", found.uniformity)]
        if found.maintenance is not None:
            properties.append(self._property("MaintenanceFactor", "IfcNormalisedRatioMeasure", found.maintenance))
        if found.watts is not None:
            properties.append(self._property("InstalledPower", "IfcPowerMeasure", found.watts, self._watt))
        if found.ugr is not None:
            properties.append(self._property("UnifiedGlareRating", "IfcReal", found.ugr))
        if found.met is not None:
            properties.append(self._property("RequirementsMet", "IfcBoolean", found.met))
        return properties

    def write(self, space: Any, found: _Found) -> None:
        """Give a space its set, or what it has of it new values."""
        sets = [rel.RelatingPropertyDefinition for rel in space.IsDefinedBy
                if rel.is_a("IfcRelDefinesByProperties")]
        known = next((one for one in sets if one.is_a("IfcPropertySet") and one.Name == _set), None)
        old = known.HasProperties if known else ()
        if known is None:
            known = self._entity("IfcPropertySet", space, Name=_set)
            self._entity("IfcRelDefinesByProperties", space, RelatedObjects=[space],
                         RelatingPropertyDefinition=known)
        known.HasProperties, known.Description = self._of(found), self._title
        for one in old:
            if not self._model.get_inverse(one):
                self._model.remove(one)

    def _entity(self, kind: str, space: Any, **members: Any) -> Any:
        """With an identifier that is the same each time."""
        number = uuid.uuid5(uuid.NAMESPACE_URL, f"{kind}/{_set}/{space.GlobalId}")
        return self._model.create_entity(kind, GlobalId=ifc_module(".guid").compress(number.hex),
                                         OwnerHistory=space.OwnerHistory, **members)


def write(ifc: Path, rooms: Path, results: Path, output: Path,
          glare: Path | None = None) -> tuple[list[str], list[str]]:
    """Write an IFC file whose rooms have what was measured in them.

    Parameters
    ----------
    ifc : path
        The file of which ``photile import`` read the rooms.
    rooms : path
        ``.rooms.json``, which ``photile import`` wrote.
    results : path
        ``.json`` of ``photile measure`` on the grids of ``photile import``.
    output : path
        ``.ifc`` to write; not one of the inputs.
    glare : path, optional
        ``.json`` of ``photile glare`` with the observers of ``photile import``; by default those of the results.

    Returns
    -------
    tuple of list of str
        A line for each room, and warnings.

    Errors: InputError, UsageError, OutputError, ImportError.
    """
    if output.suffix.lower() != ".ifc":
        raise UsageError(f"{output}: name an .ifc file to write")
    if output.resolve() in {file.resolve() for file in (ifc, rooms, results, *filter(None, [glare]))}:
        raise UsageError(f"{output}: this file is read; name another one to write")
    listed, record = _read(rooms), _read(results)
    try:
        observers = _read(glare)["observers"] if glare else record.get("glare", {}).get("observers", [])
        found = {room["global_id"]: (room["name"], one) for room in listed
                 if (one := _found(room, record, observers)) is not None}
        title = f"photile {record['photile']}, {record['date']}"
        if (record["unit"], record["response"]) != ("lux", "planar"):
            raise InputError(f"{results}: these are not lux on a plane; measure without --daylight-factor "
                             "and --cylindrical")
    except (KeyError, TypeError, ValueError, AttributeError, ZeroDivisionError):
        files = ", ".join(str(file) for file in (rooms, results, glare) if file)
        raise InputError(f"{files}: these are not rooms of photile import and results of photile measure "
                         "and glare; name the .rooms.json and the .json of -o") from None
    if not found:
        raise InputError(f"{results}: no grid has the name of a room; measure with --grid of photile import")
    model = open_ifc(ifc)
    spaces = {space.GlobalId: space for space in model.by_type("IfcSpace") if space.GlobalId in found}
    if not spaces:
        raise InputError(f"{ifc}: none of these rooms is in this file; name the file of photile import")
    properties = _Properties(model, title)
    lines, warnings = [], []
    for number, (name, one) in found.items():
        if number in spaces:
            properties.write(spaces[number], one)
            lines.append(one.line(one_line(name)))
    if len(spaces) < len(found):
        warnings.append(f"{len(found) - len(spaces)} rooms are not in {ifc}")
    if any(one.maintenance == 1 and one.required is not None for _, one in found.values()):
        warnings.append("requirements are compared with a new installation; measure with --maintenance")
    write_files({output: model.to_string().encode()})
    return lines, warnings


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python3 -m photile.to_ifc",
        description=f"Write what photile measure found in rooms into an IFC file, as the property set {_set} "
                    "of each IfcSpace, and print it beside the illuminance that the file requires.")
    parser.add_argument("ifc", type=Path, help="IFC file of which photile import read the rooms")
    parser.add_argument("--rooms", type=Path, required=True, metavar="FILE.rooms.json",
                        help="rooms that photile import wrote")
    parser.add_argument("--results", type=Path, required=True, metavar="FILE.json",
                        help="what photile measure -o FILE.json wrote with the grids of photile import")
    parser.add_argument("--glare", type=Path, metavar="FILE.json",
                        help="what photile glare -o FILE.json wrote with the observers of photile import, if the "
                             "results have none")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.ifc",
                        help="file to write")
    options = parser.parse_args()

    def work() -> None:
        lines, warnings = write(options.ifc, options.rooms, options.results, options.output, options.glare)
        for line in warnings:
            print(f"warning: {line}", file=sys.stderr)
        print("\n".join(lines))

    return in_ifc_child([options.ifc], lambda: exit_code(work))


if __name__ == "__main__":
    sys.exit(main())
