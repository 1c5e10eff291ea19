"""The input of the templates: a record's figures as texts, tables and drawings."""

from __future__ import annotations

import base64
import importlib
import os
import pathlib
import re
from typing import Any

import jinja2
import jinja2.sandbox
import markupsafe
import numpy as np

from . import glossary, texts
from .included import Included, Map, factor_table, outdoors_of
from .luminaires import Luminaires, kind_of
from .melanopic import melanopic_table
from .plans import Curve, Plan, sheets
from .rooms import Building, Room, RoomResults
from .scale import fitted
from .tables import Table, table, targets_of

most_light_plans = 6  # more do not fit on a page
most_without_contents = 3  # parts of a report that begin a page, after the first page
row_height = 4.5  # millimetres of a row of texts above a plan
Pairs = list[tuple[str, str]]
_heading = re.compile('<h2 id="([^"]*)">(.*?)</h2>', re.DOTALL)
_own = pathlib.Path(__file__).resolve().parent / "templates"


class BadInput(Exception):
    """An error: one line that names the file, what is wrong with it, and the remedy."""


class UnknownLanguage(Exception):
    """An error: one line that names the available languages."""


def _css(text: str) -> str:
    """Text escaped for a string in a style sheet in a page."""
    return "".join(c if c >= " " and c not in "\"\\<>&" else f"\\{ord(c):x} " for c in text)


def _of_one_room(record: dict[str, Any]) -> bool:
    """Whether planes that face the same way lie in one room, as far as their plans have it: only then
    are the room of the record and all lamps' power over its area those of the report."""
    rooms: dict[tuple[float, ...], Any] = {}
    for grid in record.get("grids", []):
        plane, room = grid.get("plane"), (grid.get("plan") or {}).get("room")
        if not plane or not room:
            continue
        u, v = (np.array(plane[side], float) / np.linalg.norm(plane[side]) for side in "uv")
        normal = np.cross(u, v)
        corners = np.sort([np.array(plane["origin"]) + a * u + b * v for a, b in room], axis=0)
        way = corners - rooms.setdefault(tuple((np.round(normal, 3) + 0.0).tolist()), corners)
        up = way @ normal
        # Metres: planes of one room lie above each other, and those of storeys further apart.
        if np.abs(up).max() > 2 or np.abs(way - up[:, None] * normal).max() > 0.5:
            return False
    return True


class Report:
    """A record of ``photile measure`` or ``photile daylight``, and the templates that draw it.

    A folder's templates replace those of the same name, and extend them under the names
    ``photile/report.html`` and so on. They cannot do more than draw: they run in jinja2's sandbox.
    """

    def __init__(self, record: dict[str, Any], template: str | None = None) -> None:
        self._record = record if _of_one_room(record) else {**record, "room": None}
        self._about: dict[str, Any] = {"subject": "Illuminance", "language": "en", "pictures": [],
                                       "included": [], **record.get("report", {})}
        folders = [pathlib.Path(template)] if template else []
        for folder in folders:
            if not folder.is_dir():
                raise BadInput(f"{folder}: this is not a folder of templates; name one")
        self._folders = [*folders, _own]
        try:
            self._words = texts.Words(self._about["language"], folders)
        except KeyError as known:
            language = self._about["language"]
            raise UnknownLanguage(f"--language {language}: there are {known.args[0]}; or write "
                                  f"words/{language}.json into the folder of --template") from None
        self._environment = jinja2.sandbox.ImmutableSandboxedEnvironment(
            autoescape=True, trim_blocks=True, lstrip_blocks=True,
            loader=jinja2.ChoiceLoader([*(jinja2.FileSystemLoader(one) for one in self._folders),
                                        jinja2.PrefixLoader({"photile": jinja2.FileSystemLoader(_own)})]))
        self._environment.filters |= {
            "css": _css, "figure": self._words.figure,
            "number": lambda value, digits: self._words.figure(texts.number(value, digits))}
        self._environment.globals |= {"_": self._words, "embedded": self._embedded}
        self._luminaires = Luminaires(record)
        outdoors = self._about.get("outdoor_lux") or outdoors_of(each["content"] for each in self._about["included"])
        self._included = Included(outdoors)
        glare = [{"file": "glare", "content": record["glare"]}] if "glare" in record else []
        for each in [*glare, *self._about["included"]]:
            try:
                self._included.add(each["content"])
            except (KeyError, IndexError, TypeError, ValueError, AttributeError):
                raise BadInput(f"{each['file']}: this is neither a result nor rooms of a building; give what "
                               "photile glare, daylight or measure --daylight-factor has written by -o FILE.json, or "
                               "NAME.rooms.json of photile import") from None
        self._factors = factor_table(record["grids"], outdoors) if record.get("unit") == "DF %" else None
        if self._factors:
            self._about["subject"] = "Daylight factors"
        self._building = Building(self._included.rooms, record, self._luminaires)

    def check(self) -> None:
        """Reads the templates; raises BadInput where that fails."""
        for name in ("report.html", "style.css", "plan.svg", "curve.svg"):
            self._template(name)

    def _template(self, name: str) -> jinja2.Template:
        try:
            return self._environment.get_template(name)
        except jinja2.TemplateError as error:
            raise BadInput(f"template {name}: {error}") from None

    def _rendered(self, name: str, **values: Any) -> str:
        template = self._template(name)
        try:
            return template.render(values)
        except jinja2.TemplateError as error:
            raise BadInput(f"template {name}: {error}") from None

    def _embedded(self, name: str) -> str:
        """A picture in the folder of templates, as a data URI for a page."""
        for folder in self._folders:
            file = (folder / name).resolve()
            if file.is_relative_to(folder.resolve()) and file.is_file():
                kind = {".svg": "svg+xml", ".jpg": "jpeg"}.get(file.suffix.lower(), file.suffix[1:])
                return f"data:image/{kind};base64,{base64.b64encode(file.read_bytes()).decode()}"
        raise BadInput(f"{name}: the folder of templates has no such file")

    def _drawn(self, plan: Plan) -> Any:
        return markupsafe.Markup(self._rendered("plan.svg", plan=plan))

    def _plan_of_grid(self, grid: dict[str, Any], light: str = "", room: Room | None = None,
                      rows_above: int = 0, page: str = "") -> Plan:
        """A plan of all lights on the scale that all grids share, or of one light on its own: a weak lamp
        would show nothing on the scale of all.

        room         to show as a whole
        rows_above   of texts on the page, above the figures of the grid
        page         upright or lying; "" = as it suits
        """
        colours = self._about["colours"]
        if light:
            values = [sensor["lights"][light]["lux"] for sensor in grid["sensors"]]
            return Plan(grid, values, light, {**colours, "scale": 0}, self._words, small=True)
        shared = fitted(colours, [np.array([sensor["lux"] for sensor in each["sensors"]], float)
                                  for each in self._record["grids"] if "plane" in each])
        return Plan(grid, [sensor["lux"] for sensor in grid["sensors"]], self._words(grid["name"]), shared,
                    self._words, self._luminaires, outline=room.on(grid["plane"]) if room else (),
                    taken=row_height * rows_above, pages=(page,) if page else tuple(sheets))

    def _plan_of_luminaires(self) -> Any:
        """The plan that shows most of them, without values; "" where none does."""
        def count(grid: dict[str, Any]) -> int:
            return len((grid.get("plan") or {}).get("lamps", []))

        grid: dict[str, Any] = max(self._record.get("grids", []), key=count, default={})
        if not count(grid):
            return ""
        bare = {"plane": {**grid["plane"], "cells": []}, "plan": grid["plan"]}
        return self._drawn(Plan(bare, [], self._words("Luminaires"), self._about["colours"], self._words,
                                self._luminaires, pages=("portrait",)))

    def _plan_of_map(self, one: Map, small: bool) -> Plan:
        palette = self._about["colours"]["palette"]
        figure = self._words(one.figure)
        title = figure if small else f"{self._words(one.grid)}: {figure}"
        return Plan(one.values, one.numbers, title, {**one.colours, "palette": palette}, self._words,
                    self._luminaires, small)

    def _plans(self) -> list[Plan]:
        """Of each plane, or for a year of each figure on it."""
        grids = self._record.get("grids", [])
        if grids:
            return [self._plan_of_grid(grid) for grid in grids if "plane" in grid]
        return [self._plan_of_map(one, False) for one in self._included.maps if one.alone]

    def plans(self) -> list[str]:
        """SVG of each plane, or for a year of each figure on it."""
        return [str(self._drawn(plan)) for plan in self._plans()]

    def drawings(self) -> list[bytes]:
        """DXF of each plane."""
        dxf = importlib.import_module(".dxf", __package__)  # needs ezdxf, which pages do without
        return [dxf.Drawing(grid, [sensor["lux"] for sensor in grid["sensors"]], self._luminaires,
                            self._words).written()
                for grid in self._record.get("grids", []) if "plane" in grid]

    def page(self) -> str:
        """An HTML page that needs no other file and prints on numbered pages of A4. Well-formed XML.

        A long one has contents and a glossary, of what it contains without them.
        """
        record, about = self._record, self._about
        values = {
            "record": record, "about": about, "language": about["language"], "unit": "%" if self._factors else "lux",
            "symbol": "D" if self._factors else "E", "factors": self._factors,
            "energy": self._energy(), "facts": self._facts(), "targets": self._targets(),
            "building": [(name, self._words.figure(value)) for name, value in self._building.facts()],
            "table_of_rooms": self._building.table() if self._building.rooms else None,
            "rooms": [self._room(one) for one in self._building.rooms if one.grids],
            "grids": [self._grid(grid) for grid in self._building.others], "maps": self._maps(),
            "results": self._results(), "lists": self._lists(), "sheets": self._sheets()}
        page = self._rendered("report.html", contents=[], terms=[], **values)
        if page.count('<section class="page') <= most_without_contents:
            return page
        terms = glossary.used(page, self._words)
        page = self._rendered("report.html", contents=[], terms=terms, **values)
        contents = [(anchor, markupsafe.Markup(heading)) for anchor, heading in _heading.findall(page)]
        return self._rendered("report.html", contents=contents, terms=terms, **values)

    def _room(self, one: RoomResults) -> dict[str, Any]:
        """A room's own page."""
        facts = [(name, self._words.figure(value)) for name, value in one.facts() if value]
        facts += [("target", self._of_target(target)) for target in one.targets]
        judgements = self._shown(one.judgements)
        named = any(each["grid"] != one.room.name for each in judgements)
        parts = one.parts(self._luminaires)
        above = 2 + max(len(facts), len(judgements) + len(parts["rows"]) + 4)
        grids: list[dict[str, Any]] = []
        page = ""
        for grid in one.grids:  # all on pages that lie as the first plan needs
            grids.append(self._grid(grid, one.room, 0 if grids else above, page))
            page = grids[-1]["page"]
        return {"name": self._words(one.room.name), "facts": facts, "judgements": judgements, "named": named,
                "parts": parts, "grids": grids, "page": page}

    def _grid(self, grid: dict[str, Any], room: Room | None = None, rows_above: int = 0,
              page: str = "") -> dict[str, Any]:
        minimum, lights = grid["statistics"]["Emin"], grid.get("lights", {})
        plane = grid.get("plane")
        drawn = list(lights) if plane and 0 < len(lights) <= most_light_plans else []
        plan = self._plan_of_grid(grid, room=room, rows_above=rows_above, page=page) if plane else None
        heading = (self._words("{} points", grid["points"]) if room and grid["name"] == room.name
                   else self._words("{}: {} points", self._words(grid["name"]), grid["points"]))
        if plane:
            wide, high = (float(np.linalg.norm(plane[side])) for side in ("u", "v"))
            heading += self._words(", {:.2f} x {:.2f} m, {:.2f} m apart", wide, high,
                                   wide / plane["columns"])
        remarks = []
        for text, reasons in (
                ("\u00d7 {} points are left out: {}.",
                 [point["reason"] for point in grid.get("blank", [])]),
                ("\u00d7 {} points are measured, but doubtful: {}.",
                 [sensor["mark"] for sensor in grid["sensors"] if "mark" in sensor])):
            remarks += [self._words(text, reasons.count(reason), self._words(reason))
                        for reason in dict.fromkeys(reasons)]
        least = minimum["value"], minimum["at_most"]
        noisy = (None not in least and least[1] - least[0] > (minimum["standard_error"] or 0)
                 and not self._factors)
        if room:  # of all lights of a building, those that reach it
            lights = {name: one for name, one in lights.items() if one["Em"]["value"]}
        return {"heading": heading, "remarks": remarks, "noisy": noisy,
                "rows": [("", grid["statistics"]), *lights.items()],
                "statistics": grid["statistics"], "name": grid["name"],
                "plan": self._drawn(plan) if plan else "", "page": plan.page if plan else page,
                "plans": [self._drawn(self._plan_of_grid(grid, light)) for light in drawn]}

    def _maps(self) -> list[tuple[str, list[Any]]]:
        """Drawings side by side, under the name of their grid."""
        grids: dict[str, list[Any]] = {}
        for one in self._included.maps:
            grids.setdefault(one.grid, []).append(self._drawn(self._plan_of_map(one, True)))
        return list(grids.items())

    def _shown(self, judgements: list[dict[str, Any]]) -> list[dict[str, Any]]:
        """Judgements with texts in place of figures that have no error."""
        return [{**each, "text": self._words.figure(texts.glare(each["value"]))} if each["figure"] == "UGR" else each
                for each in judgements]

    def _of_target(self, target: dict[str, Any]) -> str:
        return (f"{self._words(target['reference'])}: {self._words(target['what'])}" if target["reference"]
                else str(target["name"]))

    def _targets(self) -> list[dict[str, Any]]:
        """Of each target its name, and required and measured values side by side."""
        return [{"name": self._of_target(target), "rows": self._judgements(target)}
                for target in targets_of(self._record)]

    def _judgements(self, target: dict[str, Any]) -> list[dict[str, Any]]:
        """Those of a target, but for those of rooms."""
        of_rooms = [each for one in self._building.rooms for each in one.judgements]
        rows = self._shown([each for each in target["judgements"] if each not in of_rooms])
        if target["ugr_limit"] > 0 and not any(each["figure"] == "UGR" for each in target["judgements"]):
            rows.append({"grid": "", "figure": "UGR", "at_most": True, "required": target["ugr_limit"],
                         "text": self._words("see photile glare"), "met": None})
        if target["ra"] > 0:
            least = min((part["ra"] for part in self._record["photometry"]), default=0)
            text = self._words("by the luminaires' data sheets" if least > 0
                               else "see the luminaires' data sheets")
            rows.append({"grid": "", "figure": "Ra", "at_most": False, "required": target["ra"],
                         "text": self._words.figure(f"{least:g}") + f", {text}" if least > 0 else text,
                         "met": least >= target["ra"] if least > 0 else None})
        return rows

    def _energy(self) -> Pairs:
        """The power of luminaires if all of their files state it, and LENI of an included year."""
        record, rows = self._record, []
        watts = [part["watts"] for part in record.get("photometry", [])]
        area = self._building.area or (record.get("room") or {}).get("area", 0)
        if watts and min(watts) > 0:
            power = sum(watts)
            rows.append(("installed power", f"{texts.grouped(power, 4)} W"))
            if area > 0:
                mean = 0 if self._building.rooms else record["grids"][0]["statistics"]["Em"]["value"] or 0
                more = f", {100 * power / area / mean:.2f} W/m\u00b2 / 100 lx" if mean > 0 else ""
                rows.append(("power density", f"{power / area:.2f} W/m\u00b2{more}"))
        energy = self._included.kilowatt_hours
        if energy > 0 and area > 0 and not self._building.rooms:
            rows.append(("LENI (EN 15193)",
                         f"{energy / area:.1f} kWh/(m\u00b2 a), {energy:.0f} kWh / a"))
        return [(name, self._words.figure(value)) for name, value in rows]

    def _facts(self) -> Pairs:
        record = self._record
        year = "weather" in record
        if year:
            facts = [("weather", record["weather"]), ("sky", self._words("{} patches", record["patches"])),
                     ("ground", self._words("reflectance {:g} below the horizon",
                                            record["ground_reflectance"]))]
        else:
            facts = [("illuminance", record["response"])]
        maintenance = record.get("maintenance", "")
        facts += [("maintenance factor", self._words.figure(
            f"{record['maintenance_factor']:.3g}" + (f" = {maintenance}" if maintenance else ""))),
                  ("measured", self._words("{} times with {} rays a point", record["repeats"],
                                          record["rays"]))]
        if not year:
            by_paths = record["integrator"] == "path"
            facts += [("light by", "path tracing" if by_paths else self._words(
                "photon maps, {:,} photons, k = {}", record["photons"], record["neighbours"])),
                      ("errors", "standard errors of the mean of the repeats")]
        facts.append(("seed", str(record["seed"])))
        if "mood" in record:
            facts.append(("mood", record["mood"]))
        facts += record.get("sky", {}).items()
        return [*facts, ("program", f"photile {record['photile']}"), ("date", record["date"])]

    def _results(self) -> list[Table]:
        """What is included, and melanopic light."""
        melanopic = melanopic_table(self._record)
        return [*self._included.tables, *([melanopic] if melanopic else [])]

    def _lists(self) -> list[Table]:
        """Luminaires, parts with totals, reflectances."""
        record = self._record
        parts, all_lamps = self._luminaires.parts, self._luminaires.rows
        if self._factors:  # of the sky's light, without lamps
            parts, all_lamps = [], []
        rows = [self._row(part.tag, part.pieces, part.lines(), part.lumens, part.watts, part.pieces)
                for part in parts]
        if len(parts) > 1:
            all_known = all(part.watts > 0 for part in parts)
            rows.append(self._row("", sum(part.pieces for part in parts), [self._words("together")],
                                  sum(part.lumens for part in parts),
                                  sum(part.watts for part in parts) if all_known else 0))
        own = any(part.maintenance for part in parts)
        for row, factor in zip(rows, [*(part.maintenance for part in parts), 0] if own else ()):
            row.insert(3, f"{factor:g}" if factor else "")
        rooms = self._building.rooms
        room_of = {int(lamp["number"]): self._words(one.room.name) for one in rooms for lamp in one.lamps}
        lamps = [[self._luminaires.tag(int(lamp["number"])), lamp["name"], lamp["kind"],
                  *([room_of.get(int(lamp["number"]), "")] if rooms else []), texts.place(lamp["position"]),
                  f"{texts.grouped(lamp['lumens'], 4)} lm"] for lamp in all_lamps]
        surfaces = [[each["material"], f"{100 * each['reflectance']:.0f}%"]
                    for each in record.get("reflectances", [])]
        return [
            table("Luminaires", ["number", "name", "kind", *(["room"] if rooms else []), "position (x, y, z), m",
                                 "luminous flux"], lamps, words=(2,), names=(0, 1, 3) if rooms else (0, 1),
                  plan="" if rooms else self._plan_of_luminaires()),
            table("List of parts", ["type", "pieces", "luminaire", *(["maintenance factor"] if own else []),
                                    "lumens each", "watts each", "luminous flux", "power", "luminous efficacy"],
                  rows, names=(0, 2), kind="parts"),
            table("Reflectances", ["material", "reflectance"], surfaces, names=(0,))]

    @staticmethod
    def _row(tag: str, pieces: int, lines: list[str], lumens: float, watts: float,
             each_of: int = 0) -> list[str | list[str]]:
        """A row of the list of parts; `each_of` pieces share the sums, 0 = not stated for each."""
        def amount(value: float, unit: str) -> str:
            return f"{texts.grouped(value, 4)} {unit}" if value > 0 else ""

        each = (lumens / each_of, watts / each_of) if each_of else (0, 0)
        return [tag, str(pieces), lines, amount(each[0], "lm"), amount(each[1], "W"),
                amount(lumens, "lm"), amount(watts, "W"),
                f"{lumens / watts:.0f} lm/W" if watts > 0 else ""]

    def _sheets(self) -> list[dict[str, Any]]:
        sheets = []
        own = ("power", "colour temperature", "colour rendering", "maintenance factor")  # others: the maker's texts
        for part in [] if self._factors else self._record.get("photometry", []):
            bright = any(value and value > 0 for plane in part["intensities"].values() for value in plane)
            drawing = self._rendered("curve.svg", curve=Curve(part["intensities"])) if bright else ""
            rows = [("luminous flux", self._words.figure(f"{texts.grouped(part['flux'], 4)} lm"))]
            rows += [(name, self._words.figure(self._words(value)) if name in own else value)
                     for name, value in part["data"]]
            tag = self._luminaires.of_kind[kind_of(part, "name")].tag
            sheets.append({"heading": f"{tag}: {part['name']}",
                           "drawing": markupsafe.Markup(drawing), "rows": rows})
        return sheets


def printed(page: str) -> bytes:
    """The page as PDF. It contains all that it shows: nothing is fetched."""
    # Letters that it packs bear a time otherwise, and the same page would be another file.
    os.environ.setdefault("SOURCE_DATE_EPOCH", "0")
    weasyprint: Any = importlib.import_module("weasyprint")

    def fetch(url: str, *arguments: Any, **options: Any) -> Any:
        if not url.startswith("data:"):
            raise ValueError(f"{url[:80]}: pages have to contain their pictures; use embedded(NAME)")
        return weasyprint.default_url_fetcher(url, *arguments, **options)

    document: bytes = weasyprint.HTML(string=page, url_fetcher=fetch).write_pdf()
    return document
