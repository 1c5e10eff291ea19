"""Pictures: layers, mixes, files."""

import os
import subprocess

import numpy as np
import pytest

import photile

QUICK = {"quality": "draft", "photons_emitted": 20_000, "samples_per_pixel": 1}
COMMAND = os.environ["PHOTILE_COMMAND"]


@pytest.fixture
def picture(lamps):
    return photile.render(lamps, size=(40, 30), **QUICK)


def test_a_furnace_shines_evenly(furnace):
    # Radiance 600 lm / (pi x 6 m2), and half of it reflected again and again.
    expected = 600 / (np.pi * 6) / (1 - 0.5)
    by_paths = photile.render(
        furnace, size=(16, 12), quality="draft", integrator="path", samples_per_pixel=64
    )
    assert by_paths.mix().mean() == pytest.approx(expected, rel=0.01)
    by_maps = photile.render(furnace, size=(16, 12), quality="draft", photons_emitted=200_000)
    assert by_maps.mix().mean() == pytest.approx(expected, rel=0.02)
    # Each square metre of wall gets pi times that.
    assert by_maps.illuminance().mean() == pytest.approx(np.pi * expected, rel=0.02)


def test_layers_add_up_and_follow_their_powers(picture):
    assert list(picture) == ["warm", "cold"] and len(picture) == 2
    layers = {name: picture[name].astype(float) for name in picture}
    assert picture["warm"].shape == (30, 40, 3) and picture["warm"].dtype == np.float32
    assert np.allclose(picture.mix(), layers["warm"] + layers["cold"], rtol=1e-5)
    assert np.allclose(picture.unit_layer("warm") * 800, layers["warm"], rtol=1e-5)
    mixed = picture.mix({"warm": 2, "cold": 0.25})
    assert np.allclose(mixed, 2 * layers["warm"] + layers["cold"] / 4, rtol=1e-5)
    assert np.allclose(picture.mix({"warm": "off"}), layers["cold"], rtol=1e-6)
    assert np.allclose(picture.mix({"cold": "1000lm"}), layers["warm"] + 2 * layers["cold"],
                       rtol=1e-5)


def test_a_layer_is_a_view_and_the_mix_is_not(picture):
    assert np.shares_memory(picture.unit_layer("warm"), picture.unit_layer("warm"))
    assert not picture.unit_layer("warm").flags.writeable
    before = picture.mix()
    before[:] = 0
    assert picture.mix().max() > 0


def test_lights_keep_their_changes(picture):
    evening = picture.relit({"warm": "x0.5", "cold": "off"})
    assert evening.lights["warm"].power == 400 and evening.lights["cold"].power == 0
    assert picture.lights["warm"].power == 800
    assert np.allclose(evening.mix(), picture["warm"] / 2, rtol=1e-5)
    assert np.allclose(evening["warm"], picture["warm"] / 2, rtol=1e-6)
    assert evening["cold"].max() == 0
    red = picture.relit({"cold": "#ff0000"})["cold"]
    assert red[..., 0].max() > 0 and red[..., 1:].max() == 0


def test_a_file_is_what_was_rendered(picture, tmp_path):
    picture.save(tmp_path / "a.exr", {"cold": 2})
    again = photile.relight(tmp_path / "a.exr")
    assert again.lights["cold"].power == pytest.approx(1000)
    assert np.allclose(again.mix(), picture.mix({"cold": 2}), rtol=1e-5)
    assert np.allclose(again.illuminance("warm"), picture.illuminance("warm"), rtol=1e-5)
    assert np.allclose(again.mix({"warm": "off", "cold": 0.5}), picture["cold"], rtol=1e-5)
    # The command reads the same, and writes the same.
    subprocess.run([COMMAND, "relight", tmp_path / "a.exr", "--light", "warm=x3", "-o",
                    tmp_path / "b.exr"], check=True)
    other = photile.relight(tmp_path / "b.exr")
    assert np.allclose(other.mix(), again.mix({"warm": 3}), rtol=1e-5)


def test_a_mood_comes_before_changes(lamps, picture, tmp_path):
    picture.save(tmp_path / "a.exr")
    moods = tmp_path / "a.moods.json"  # beside the picture
    moods.write_text('{"photile_moods": 1, "moods": {"dusk": {"warm": {"power": 400}, "cold": {"on": false}}}}')
    rendered = photile.render(lamps, size=(8, 6), mood="dusk", moods=moods, light={"warm": 2}, **QUICK)
    for dusk in (photile.relight(tmp_path / "a.exr", {"warm": 2}, mood="dusk"), rendered):
        assert dusk.lights["warm"].power == pytest.approx(800) and dusk["cold"].max() == 0
        assert np.allclose(dusk.mix(), dusk["warm"], rtol=1e-5) and dusk.mix().max() > 0


def test_another_program_reads_the_layers(picture, tmp_path):
    oiio = pytest.importorskip("OpenImageIO")
    picture.save(tmp_path / "a.exr")
    image = oiio.ImageInput.open(str(tmp_path / "a.exr"))
    names = list(image.spec().channelnames)
    pixels = image.read_image("float")
    layer = pixels[..., [names.index(f"Combined_warm.{c}") for c in "RGB"]]
    assert np.allclose(layer, picture["warm"], rtol=1e-5)
    assert image.spec().getattribute("worldtocamera") is not None


def test_what_is_off_in_a_file_stays_off(picture, tmp_path):
    picture.save(tmp_path / "a.exr", {"cold": "off"})
    again = photile.relight(tmp_path / "a.exr")
    assert again["cold"].max() == 0
    with pytest.raises(photile.UsageError, match="off in the picture"):
        again.mix({"cold": "100lm"})


def test_the_picture_is_that_of_the_command(tmp_path):
    scene = os.path.join(os.path.dirname(__file__), "../../scenes/cornell-box/cornell-box.obj")
    subprocess.run([COMMAND, "render", scene, "-o", tmp_path / "a.exr", "--size", "32x24",
                    "--quality", "draft", "--photons", "20000", "--quiet"], check=True)
    by_command = photile.relight(tmp_path / "a.exr").mix()
    own = photile.render(photile.load(scene), size=(32, 24), quality="draft",
                         photons_emitted=20_000)
    assert np.allclose(own.mix(), by_command, rtol=1e-5, atol=1e-9)


def test_what_a_screen_shows(picture, tmp_path, monkeypatch):
    shown = picture.display()
    assert shown.shape == (30, 40, 3) and shown.dtype == np.uint8 and 20 < shown.mean() < 235
    assert picture.display(exposure=-3).mean() < shown.mean()
    picture.save(tmp_path / "a.png")
    oiio = pytest.importorskip("OpenImageIO")
    written = oiio.ImageBuf(str(tmp_path / "a.png")).get_pixels("uint8")
    assert np.abs(written.astype(int) - shown).max() <= 1
    (tmp_path / "b.png").write_bytes(picture._repr_png_())
    assert np.array_equal(oiio.ImageBuf(str(tmp_path / "b.png")).get_pixels("uint8"), shown)
    monkeypatch.setattr("photile.pictures._LONGEST_SHOWN", 20)
    assert picture._repr_png_()[16:24] == b"\0\0\0\x14\0\0\0\x0f"  # means of 2 x 2 pixels: 20 x 15


def test_costs_are_told(picture):
    stages = {stage["stage"]: stage for stage in picture.statistics}
    assert "trace photons" in stages and all(s["seconds"] >= 0 for s in stages.values())


def test_cameras_are_chosen(lamps):
    size = (8, 6)
    first = photile.render(lamps, size=size, **QUICK).mix()
    same = photile.render(lamps, "camera", size=size, **QUICK).mix()
    up = photile.Camera((2, 1.5, 0.5), (2, 1.5, 2), (0, 1, 0), 90)
    other = photile.render(lamps, up, size=size, **QUICK).mix()
    assert np.array_equal(first, same) and not np.allclose(first, other)


def test_changes_that_cannot_be_done(picture):
    for wrong in ({"sun": 2}, {"warm": "bright"}, {"warm": -1}, {"warm": float("nan")}):
        with pytest.raises(photile.UsageError):
            picture.mix(wrong)
    with pytest.raises(KeyError):
        picture["sun"]
    with pytest.raises(photile.UsageError):
        picture.save("a.jpeg")
