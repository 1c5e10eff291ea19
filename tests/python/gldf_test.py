"""GLDF files as luminaires: a zip that is made here, of a lamp with two lights."""

import json
import resource
import zipfile
from functools import partial

from conftest import run_photile

IES = """IESNA:LM-63-2002
TILT=NONE
1 1000 1 3 1 1 2 0.1 0.1 0 1 1 10
0 45 90
0
400 300 0
"""
PRODUCT = """<Root><GeneralDefinitions>
<Files><File id="f1" contentType="ldc/ies" type="localFileName">down.ies</File>
<File id="f2" contentType="ldc/ies" type="localFileName">missing.ies</File></Files>
<Photometries><Photometry id="p1"><PhotometryFileReference fileId="f1"/></Photometry>
<Photometry id="p2"><PhotometryFileReference fileId="f2"/></Photometry></Photometries>
<Emitters><Emitter id="direct"><FixedLightEmitter><PhotometryReference photometryId="p1"/>
<RatedLuminousFlux>1500</RatedLuminousFlux></FixedLightEmitter></Emitter>
<Emitter id="indirect"><ChangeableLightEmitter><PhotometryReference photometryId="p1"/>
</ChangeableLightEmitter></Emitter>
<Emitter id="absent"><FixedLightEmitter><PhotometryReference photometryId="p2"/></FixedLightEmitter>
</Emitter></Emitters></GeneralDefinitions>
<ProductDefinitions><Variants><Variant id="v 1"><Geometry><ModelGeometryReference geometryId="g">
<EmitterReference emitterId="direct"/><EmitterReference emitterId="indirect"/>
<EmitterReference emitterId="absent"/></ModelGeometryReference></Geometry></Variant></Variants>
</ProductDefinitions></Root>"""


converted = partial(run_photile, "import")


def archive(path, product=PRODUCT, ies=IES, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(path, "w", method) as file:
        file.writestr("product.xml", product)
        file.writestr("ldc/down.ies", ies)
    return path


def with_variants(variants):
    begin, end = PRODUCT.index("<Variants>") + len("<Variants>"), PRODUCT.index("</Variants>")
    return PRODUCT[:begin] + variants + PRODUCT[end:]


def test_each_light_of_a_variant_is_a_luminaire(tmp_path):
    run = converted(archive(tmp_path / "lamp.gldf"), "-o", tmp_path / "lamp")
    assert run.returncode == 0 and run.stderr == "v_1_direct: v_1_direct.ies, 1500 lm\nv_1_indirect: v_1_indirect.ies\n"
    assert run.stdout == f"--luminaires {tmp_path}/lamp/luminaires.json\n"
    entries = json.loads((tmp_path / "lamp/luminaires.json").read_text())
    assert entries == [
        {"name": "v_1_direct", "file": "v_1_direct.ies", "position": "ceiling", "lumens": 1500},
        {"name": "v_1_indirect", "file": "v_1_indirect.ies", "position": "ceiling"}]
    for entry in entries:
        assert (tmp_path / "lamp" / entry["file"]).read_text() == IES


def test_lights_whose_ids_become_one_word_keep_their_own_files(tmp_path):
    lamps = with_variants('<Variant id="a b"><E emitterId="direct"/></Variant>'
                          '<Variant id="a-b"><E emitterId="indirect"/></Variant>')
    run = converted(archive(tmp_path / "lamp.gldf", lamps), "-o", tmp_path / "lamp")
    entries = json.loads((tmp_path / "lamp/luminaires.json").read_text())
    assert run.returncode == 0 and len({entry["file"] for entry in entries}) == 2
    assert {entry["file"] for entry in entries} | {"luminaires.json"} == {
        file.name for file in (tmp_path / "lamp").iterdir()}
    twins = with_variants('<Variant id="a"><E emitterId="direct"/></Variant>' * 2)
    assert converted(archive(tmp_path / "twins.gldf", twins), "-o", tmp_path / "twins").returncode == 0
    assert len(list((tmp_path / "twins").iterdir())) == 3


def test_what_a_file_unpacks_to_is_bounded(tmp_path):
    many = '<Variant id="v"><E emitterId="direct"/></Variant>'
    for name, product, ies in (("lights", with_variants(many * 20_000), IES),
                               ("product", PRODUCT + " " * (1 << 26), IES),
                               ("files", with_variants(many * 300), IES + " " * (1 << 20))):
        bomb = archive(tmp_path / f"{name}.gldf", product, ies)
        limited = partial(resource.setrlimit, resource.RLIMIT_AS, (700 << 20,) * 2)
        run = converted(bomb, "-o", tmp_path / "out", preexec_fn=limited, timeout=600)
        assert run.returncode == 3 and run.stderr.count("\n") == 1, run.stderr
        assert "more than" in run.stderr or "at most" in run.stderr, run.stderr
        assert not (tmp_path / "out").exists()


def test_bad_files_are_told_in_one_line(tmp_path):
    (tmp_path / "text.gldf").write_text("no zip")
    empty = PRODUCT.replace('fileId="f1"', 'fileId="f3"')
    damaged = archive(tmp_path / "product.gldf")
    data = damaged.read_bytes()
    damaged.write_bytes(data[:60] + bytes([data[60] ^ 255]) + data[61:])  # packed bytes of product.xml
    fluxes = [archive(tmp_path / f"flux{i}.gldf", PRODUCT.replace("1500", flux))
              for i, flux in enumerate(("NaN", "1e999", "-1", "bright"))]
    for file, told in ((tmp_path / "text.gldf", "not a GLDF file"),
                       (archive(tmp_path / "none.gldf", empty), "no variant has a photometric file"),
                       (archive(tmp_path / "bad.gldf", "<Root>"), "not a GLDF file"),
                       (damaged, "not a GLDF file"),
                       (archive(tmp_path / "bz2.gldf", method=zipfile.ZIP_BZIP2), "nor deflated"),
                       (archive(tmp_path / "code.gldf", '<?xml version="1.0" encoding="x"?><Root/>'),
                        "not a GLDF file"),
                       *((file, "has a flux of") for file in fluxes[:-1]),
                       (fluxes[-1], "bright"),
                       (tmp_path / "absent.gldf", "absent.gldf")):
        run = converted(file, "-o", tmp_path / "out")
        assert run.returncode == 3 and run.stdout == ""
        assert told in run.stderr and run.stderr.count("\n") == 1
        assert not (tmp_path / "out").exists()
    full = tmp_path / "full"
    full.mkdir()
    (full / "mine").write_text("kept")
    run = converted(archive(tmp_path / "lamp.gldf"), "-o", full)
    assert run.returncode == 2 and "is not empty" in run.stderr
    assert [file.name for file in full.iterdir()] == ["mine"]
