"""A building of IFC as a scene: a room of 5 x 4 x 3 m between two slabs, with a pane and two fixtures."""

import csv
import importlib
import json
import math
import re
import sys
from functools import partial

import numpy as np
import pytest
from conftest import run_photile

import photile.converters

ifcopenshell = pytest.importorskip("ifcopenshell", reason="no ifcopenshell; cmake/fetch.sh test-packages brings it")

SLAB, PANE = 2 * (5 * 4 + 5 * 0.2 + 4 * 0.2), 2 * (2 * 1.5 + 2 * 0.02 + 1.5 * 0.02)  # m2
LUMENS = 1200
LAMP = "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0 1 1 10\n0 45 90\n0\n400 300 0\n"


class Model:
    """Boxes by their lowest corner and sides, mm."""

    guid = staticmethod(ifcopenshell.guid.new)

    def __init__(self):
        self.file = ifcopenshell.file(schema="IFC4")
        units = self.make("IfcUnitAssignment", [self.make("IfcSIUnit", None, "LENGTHUNIT", "MILLI", "METRE")])
        self.origin = self.axes(0, 0, 0)
        self.context = self.make("IfcGeometricRepresentationContext", None, "Model", 3, 1e-5, self.origin,
                                 self.make("IfcDirection", [0.5, math.sqrt(0.75)]))
        self.make("IfcProject", self.guid(), RepresentationContexts=[self.context], UnitsInContext=units)

    def make(self, kind, *values, **named):
        return self.file.create_entity(kind, *values, **named)

    def axes(self, *point):
        return self.make("IfcAxis2Placement3D", self.make("IfcCartesianPoint", [float(x) for x in point]))

    def box(self, kind, name, low, sides, style=None, properties=None, light=None, **named):
        across, along, up = map(float, sides)
        middle = self.make("IfcCartesianPoint", [across / 2, along / 2])
        profile = self.make("IfcRectangleProfileDef", "AREA", None, self.make("IfcAxis2Placement2D", middle),
                            across, along)
        upwards = self.make("IfcDirection", [0.0, 0.0, 1.0])
        body = self.make("IfcExtrudedAreaSolid", profile, self.origin, upwards, up)
        if style:
            self.make("IfcStyledItem", body, [style])
        items = [("Body", "SweptSolid", body)] + ([("LightSource", "LightSource", light)] if light else [])
        shape = self.make("IfcProductDefinitionShape", None, None, [
            self.make("IfcShapeRepresentation", self.context, *words, [item]) for *words, item in items])
        element = self.make(kind, self.guid(), Name=name, Representation=shape, **named,
                            ObjectPlacement=self.make("IfcLocalPlacement", None, self.axes(*low)))
        if properties:
            values = [self.make("IfcPropertySingleValue", key, None, self.make("IfcReal", float(value)))
                      for key, value in properties.items()]
            known = self.make("IfcPropertySet", self.guid(), None, "Pset", None, values)
            self.make("IfcRelDefinesByProperties", self.guid(), None, None, None, [element], known)

    def style(self, name, grey, transparency):
        shading = self.make("IfcSurfaceStyleShading", self.make("IfcColourRgb", None, *[grey] * 3), transparency)
        return self.make("IfcSurfaceStyle", name, "BOTH", [shading])

    def source(self):
        """Even below the horizontal: 1 / 2 pi candela per lumen. Angles are radians."""
        plane = self.make("IfcLightDistributionData", 0.0, [0.0, math.pi / 2], [0.5 / math.pi] * 2)
        data = self.make("IfcLightIntensityDistribution", "TYPE_C", [plane])
        white = self.make("IfcColourRgb", None, 1.0, 1.0, 1.0)
        return self.make("IfcLightSourceGoniometric", None, white, None, None, self.axes(300, 300, -10), white,
                         4000.0, float(LUMENS), "LIGHTEMITTINGDIODE", data)


@pytest.fixture
def room(tmp_path):
    model = Model()
    plaster = model.style("Plaster", 0.5, 0.0)
    for low in (-200, 3000):
        model.box("IfcSlab", "slab", (10000, 2000, low), (5000, 4000, 200), plaster)
    model.box("IfcWindow", "pane", (12000, 2000, 1000), (2000, 20, 1500), model.style("Clear", 0.2, 0.9),
              {"VisibleLightTransmittance": 0.6})
    model.make("IfcSite", model.guid(), RefLatitude=[52, 30, 0], RefLongitude=[-13, -24, 0, -360000])
    model.box("IfcSpace", "101", (10000, 2000, 0), (5000, 4000, 3000), None, {"Illuminance": 500},
              LongName="Büro")
    model.box("IfcLightFixture", "A", (12000, 3000, 2900), (600, 300, 100), None,
              {"LuminousFlux": 900, "TotalWattage": 9}, ObjectType="Lamp/1", Tag="7")
    model.box("IfcLightFixture", "B", (11000, 3000, 2900), (600, 600, 100), None, None, model.source(),
              ObjectType="Lamp 1", Tag="8")
    model.file.write(str(tmp_path / "room.ifc"))
    (tmp_path / "lamp.ies").write_text(LAMP)
    return tmp_path


converted = partial(run_photile, "import")
returned = partial(run_photile, start=(sys.executable, "-m", "photile.to_ifc"))


def test_elements_rooms_and_fixtures_are_where_the_model_has_them(room):
    out = room / "out"
    made = converted(room / "room.ifc", "-o", out / "a.glb", "--ies", f"Lamp/1={room / 'lamp.ies'}", "--observers")
    assert made.returncode == 0 and "warning" not in made.stderr and "--include " in made.stdout, made.stderr
    assert " --set north=30 " in made.stdout and " 52.5 degrees north, -13.4001 east;" in made.stderr
    scene = photile.load(out / "a.glb", sky=("uniform", 1000))
    named = {material.name: (material, scene.triangle_areas[scene.triangle_material == i].sum())
             for i, material in enumerate(scene.materials)}
    plaster, area = named["Plaster"]
    assert area == pytest.approx(2 * SLAB) and plaster.diffuse == pytest.approx([((0.5 + 0.055) / 1.055) ** 2.4] * 3)
    pane, area = named["Clear"]
    assert area == pytest.approx(PANE, rel=1e-5) and pane.interaction == "glass" and pane.thin
    face = ((pane.index_of_refraction - 1) / (pane.index_of_refraction + 1)) ** 2
    reflects, passes = 2 * face / (1 + face), (1 - face) / (1 + face) * pane.transmission[0]
    assert passes**2 / (1 - reflects**2) == pytest.approx(0.6, rel=1e-5)  # both faces, and light between them
    (office,) = json.loads((out / "a.rooms.json").read_text())
    assert [office[key] for key in ("name", "number", "long_name")] == ["101 Büro", "101", "Büro"]
    assert [office[key] for key in ("area", "height", "floor")] == pytest.approx([20, 3, 0])
    assert office["required_illuminance"] == 500
    assert office["inside"] == pytest.approx([12.5, 1.5, -4])
    (grid,) = json.loads((out / "a.grids.json").read_text())
    assert grid == {"name": "101 Büro", "origin": [10.5, 0.75, -2.5], "u": [4, 0, 0], "v": [0, 0, -3]}
    assert (out / "a.observers" / "101 Büro.pts").read_text() == (
        "10.5 1.2 -4 1 0 0\n14.5 1.2 -4 -1 0 0\n12.5 1.2 -2.5 0 0 -1\n12.5 1.2 -5.5 0 0 1\n")
    assert f"--observers={out / 'a.observers'}/101 Büro.pts" in made.stdout and "photile glare" not in made.stdout
    assert [camera.name for camera in scene.cameras] == ["101 Büro"]
    with open(out / "a.luminaires.csv", newline="") as file:
        first, second = csv.DictReader(file)
    assert list(first.values())[:3] + list(first.values())[6:8] == ["Lamp/1", "7", "101 Büro", "900", "9"]
    assert [float(first[axis]) for axis in "xyz"] == pytest.approx([12.3, 2.9 - 0.005, -3.15])
    assert [float(second[axis]) for axis in "xyz"] == pytest.approx([11.3, 2.89, -3.3])
    assert first["file"] == "a.lamp.ies" and (out / first["file"]).read_text() == LAMP
    entries = json.loads((out / "a.luminaires.json").read_text())
    assert len({entry["name"] for entry in entries}) == 2
    assert entries[0]["size"] == [0.6, 0.3] and entries[0]["aim"] == [0, -1, 0] and entries[0]["rotation"] == 0
    info = json.loads(run_photile("info", "--json", out / "a.glb", "--luminaires", out / "a.luminaires.json").stdout)
    lights = {light["name"]: light["lumens"] for light in info["lights"]}
    assert info["rooms"] == [office]
    assert lights[entries[1]["name"]] == pytest.approx(LUMENS, rel=1e-4)
    targets = [f"--target={one}" for one in ("*Büro=office-desk", "101=Em=300", "102*=corridor")]
    assert "--target 102*: no room" in converted(room / "room.ifc", "-o", out / "b.glb", *targets).stderr
    assert converted(room / "room.ifc", "-o", out / "b.glb", *targets[:2]).returncode == 0
    assert json.loads((out / "b.grids.json").read_text()) == [{**grid, "target": "Em=300"}]
    assert (out / "a.glb").read_bytes() == (out / "b.glb").read_bytes()


def test_floors_end_below_low_ceilings_and_at_voids():
    floor_plans = importlib.import_module("photile.floor_plans")  # needs shapely
    # A gable roof of 45 degrees over 10 m x 8 m: 0.5 m high at the eaves, 1.2 m at 0.7 m from them.
    gable = np.array([(0, 0), (8, 0), (8, 0.5), (4, 4.5), (0, 0.5)])
    vertices = np.array([[x, *corner] for x in (0, 10) for corner in gable], float)
    ends = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4)])
    sides = [((i, i + 5, (i + 1) % 5 + 5), (i, (i + 1) % 5 + 5, (i + 1) % 5)) for i in range(5)]
    triangles = np.concatenate([ends, ends + 5, np.reshape(sides, (-1, 3))])
    assert floor_plans.floor_height(vertices, triangles) == 0
    assert floor_plans.shadow_of(vertices, triangles).area == pytest.approx(80)
    floor = floor_plans.section(vertices, triangles, 1.2)
    assert floor.area == pytest.approx(10 * (8 - 2 * 0.7), abs=0.02)

    def slab(left, low, right, high):
        a, b, c, d = ((x, y, -0.1) for x, y in ((left, low), (right, low), (right, high), (left, high)))
        return [(a, b, c), (a, c, d)]

    beside = np.array(slab(0, 0, 6, 8) + slab(6, 3, 10, 8))  # a void of 4 m x 3 m
    assert floor_plans.without_voids(floor, beside).area == pytest.approx(66 - 4 * (3 - 0.7), abs=0.03)
    for whole in (slab(0, 0, 6, 8) + slab(6.4, 0, 10, 8), slab(0, 0, 3, 8)):  # a gap; floors not modelled
        assert floor_plans.without_voids(floor, np.array(whole)) is floor


def test_the_grid_of_an_l_has_its_outline_and_the_spacing_of_its_largest_rectangle():
    shapely, plans, building = (importlib.import_module(name) for name in (
        "shapely", "photile.floor_plans", "photile.ifc_building"))
    floor = shapely.Polygon([(0, 0), (6, 0), (6, 2), (2, 2), (2, 8), (0, 8)],
                            [[(0.8, 0.8), (1.2, 0.8), (1.2, 1.2), (0.8, 1.2)]])
    task = plans.largest_rectangle(floor)
    assert task.area == pytest.approx(2 * (8 - 1.2))
    grid = building.Room("a", "", "", "", "", None, floor, floor, 3, 3, measured=floor, task=task).grid()
    assert grid["spacing"] == pytest.approx(0.2 * 5 ** math.log10(2), abs=1e-4)  # EN 12464-1: d is 2 m
    assert (grid["origin"], grid["u"], grid["v"]) == ([0, 3.75, 0], [6, 0, 0], [0, 0, -8])
    a, points = np.array(grid["outline"]), np.random.default_rng(1).random((500, 2)) * (6, 8)
    (ax, ay), (bx, by), (x, y) = a.T, np.roll(a, -1, axis=0).T, points.T[:, :, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        met = ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    assert (met.sum(axis=1) % 2 == shapely.contains_xy(floor, points)).all()


def test_rooms_get_what_was_measured_in_them(room):
    element = importlib.import_module("ifcopenshell.util.element")
    converted(room / "room.ifc", "-o", room / "a.glb")
    lamps = [{"file": "b.ies", "position": place} for place in ([12, 2.9, -3], [11, 3.2, -3], [16, 2.9, -3])]
    results = {"photile": "1", "date": "2026-11-30", "unit": "lux", "response": "planar", "maintenance_factor": 0.8,
               "photometry": [{"name": "b.ies", "pieces": 3, "watts": 60}], "luminaires": lamps,
               "grids": [{"name": "101 Büro", "statistics": {"Em": {"value": 512.3}, "Emin": {"value": 400},
                                                             "Uo": {"value": 0.78}}}]}
    arguments = "--rooms", room / "a.rooms.json", "--results", room / "a.json", "-o"
    seen = [{"name": f"101 Büro {i}", "ugr": ugr and {"value": ugr}} for i, ugr in enumerate((17.2, 18.4, None))]
    (room / "glare.json").write_text(json.dumps({"observers": [*seen, {"name": "101 1", "ugr": {"value": 25}}]}))
    arguments = "--glare", room / "glare.json", *arguments
    for source, written, mean, said in (
            ("room.ifc", "b.ifc", 512.3, "101 Büro: Em 512.3 lx, Uo 0.780, 40 W, UGR 18.4, required 500 lx: met"),
            ("b.ifc", "c.ifc", 499, ": NOT MET")):
        results["grids"][0]["statistics"]["Em"]["value"] = mean
        (room / "a.json").write_text(json.dumps(results))
        made = returned(room / source, *arguments, room / written)
        assert made.returncode == 0 and made.stderr == "" and f"{said}\n" in made.stdout
        model = ifcopenshell.open(room / written)
        found = element.get_psets(model.by_type("IfcSpace")[0])["Photile_SpaceLighting"]
        del found["id"]
        assert found == {"AverageIlluminance": mean, "MinimumIlluminance": 400, "Uniformity": 0.78,
                         "MaintenanceFactor": 0.8, "InstalledPower": 40, "UnifiedGlareRating": 18.4,
                         "RequirementsMet": mean > 500}
    lines = [len((room / file).read_text().splitlines()) for file in ("b.ifc", "c.ifc")]
    assert lines[0] == lines[1]  # values are replaced
    for said, *words in (("no grid has", room / "room.ifc", "--results", room / "none.json"),
                         ("this file is read", room / "room.ifc", "-o", room / "room.ifc"),
                         ("not rooms of", room / "room.ifc", "--rooms", room / "a.json")):
        (room / "none.json").write_text(json.dumps({**results, "grids": []}))
        made = returned(*words[:1], *arguments, room / "d.ifc", *words[1:])
        assert made.returncode in (2, 3) and made.stderr.count("\n") == 1 and said in made.stderr, made.stderr
    assert not (room / "d.ifc").exists()


def test_what_cannot_be_converted_is_refused_in_a_line(room):
    (room / "text.ifc").write_text("PK not STEP")
    text = (room / "room.ifc").read_text().replace("IFCLIGHTFIXTURE", "IFCBUILDINGELEMENTPROXY")
    # Placements in themselves, on which ifcopenshell 0.9 crashes.
    (room / "damaged.ifc").write_text(re.sub(r"#(\d+)=IFCLOCALPLACEMENT\(\$", r"#\1=IFCLOCALPLACEMENT(#\1", text))
    for code, said, *arguments in (
            (3, "not an IFC file", room / "text.ifc"), (3, "damaged.ifc", room / "damaged.ifc"),
            (3, "no such file", room / "absent.ifc"),
            (2, "101 Büro", room / "room.ifc", "--rooms", "102*"),
            (2, "Lamp 1, Lamp/1", room / "room.ifc", "--ies", "Spot=x.ies"),
            (3, "x.ies", room / "room.ifc", "--ies", "Lamp*=x.ies")):
        made = converted(*arguments, "-o", room / "out" / "a.glb")
        assert made.returncode == code and made.stdout == "" and made.stderr.count("\n") == 1, made.stderr
        assert said in made.stderr and not (room / "out").exists()
    assert converted(room / "room.ifc", "-o", room / "lamp.ies").returncode == 2
    assert (room / "lamp.ies").read_text() == LAMP


def test_work_without_end_is_ended(capfd):
    assert photile.converters.in_child(lambda: sum(iter(int, 1)), "it took too long", seconds=1) == 3
    assert capfd.readouterr().err == "it took too long\n"
