#!/usr/bin/env python3
"""The page of `photile view` in Chromium, beside `photile render` and `photile measure`.

Usage: live_page_test.py page PHOTILE SOURCE_FOLDER
"""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "publish"))
import page_test  # noqa: E402
from page_test import BASE64, PHOTILE, SET_POWER, SIZE, SOURCE, channels_of, near, np, photile  # noqa: E402
from served import Served, room_of_gallery  # noqa: E402

MADE = ["--quality", "draft", "--photons", "50k", "-q"]
EYE, FORWARD = [3, 1.6, 4.5], [0, 0, -1]
# Of a power, as a light shines, a half float is off by half a unit of its eleventh bit at most.
HALF = 2 ** -11

# The exact picture as it is mixed: linear RGB radiance, rows from below.
RESTING = BASE64 + """
const {gl, rest, unit} = page.renderer;
const {target, width, height} = rest.light;
const texels = new Float32Array(4 * width * height);
gl.bindFramebuffer(gl.FRAMEBUFFER, target);
gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, texels);
gl.bindFramebuffer(gl.FRAMEBUFFER, null);
return base64(texels.map((value) => value * unit));
"""


class Browser(page_test.Browser):
    def __init__(self):
        super().__init__()
        self.run_command("Network.emulateNetworkConditions",
                         {"offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": -1})

    def leave(self):
        """The page, before its server ends."""
        self.driver.get("about:blank")

    def stand(self, eye=EYE, forward=FORWARD):
        self.run(page_test.STAND, eye, forward)
        self.until("return page.renderer.rest === null")

    def exact(self):
        self.until("const {rest} = page.renderer; return document.getElementById('work').hidden && "
                   "rest?.shown === 1 && rest.number === page.live.picture")
        return page_test.pixels_of(self.run(RESTING), np.float32)

    def rendered(self, file, scene, *options):
        """What `photile render` writes of its view from where `stand` is."""
        photile("render", scene, "-o", file, "--size", "%dx%d" % SIZE, "--field-of-view",
                math.degrees(self.run("return page.walker.angle")), "--eye", ",".join(map(str, EYE)),
                "--look-at", ",".join(str(e + f) for e, f in zip(EYE, FORWARD)), *options, *MADE)
        return file


def check_first_light(browser):
    """Something is to be seen at once, never a black picture, and light comes to it."""
    grey = browser.run(page_test.SHOWN + "return shown.reduce((sum, value) => sum + value) / shown.length;")
    print(f"mean grey: {grey}")
    assert grey > 100, grey
    browser.until("return page.renderer.isLit && page.live.fading <= 0")


def check_picture(browser, folder, scene):
    """The picture at rest is that of `photile render`, as half floats, and sliders mix it."""
    browser.stand()
    found = browser.exact()
    rendered, relit = browser.rendered(folder / "hall.exr", scene), folder / "relit.exr"

    def compare(what, picture):
        expected = channels_of(picture)
        error = np.abs(found - expected) / np.maximum(expected, 1e-3 * expected.max())
        print(f"{what}: off by {error.max():.2g}", flush=True)
        assert error.max() < 4 * HALF, what  # of two layers, and of their sum

    compare("exact picture", rendered)
    browser.run(SET_POWER, "left", 0.3)
    found = browser.exact()
    photile("relight", rendered, "--light", "left=x0.3", "-o", relit)
    compare("a slider moved", relit)
    # What is drawn from light maps beside it.
    browser.run("page.renderer.dropRest()")
    drawn = browser.radiance().astype(float)
    page_test.compare_pixels("light maps", drawn, channels_of(relit), np.ones(drawn.shape[:2], bool))
    browser.run(SET_POWER, "left", 1)


def check_lux(browser, folder, scene):
    browser.stand([3, 1.6, 3.5], [0, -0.6, -0.8])
    hit = browser.run(page_test.CLICK, 160, 100)
    # Of the first repeats alone: a quick machine has more of them at once.
    read = ("const [first] = page.points.all, {repeats} = first; if (!(repeats.length >= 30)) return null;"
            "first.repeats = repeats.slice(0, arguments[0]); const {lux, error} = page.points.read(first);"
            "first.repeats = repeats; return {lux: lux[0], error: error[0]};")
    for x in (160, 60):
        browser.click(x, 100)
    browser.until("return page.points.all[0].repeats.length >= 30")
    early, late = browser.run(read, 8), browser.run(read, 30)
    assert late["error"] < early["error"], (early, late)
    browser.until("return page.points.all[1].repeats.length >= 30")
    points = folder / "click.pts"
    points.write_text(" ".join(f"{number:.7g}" for number in hit["place"] + hit["normal"]) + "\n")
    photile("measure", scene, "--points", points, "-o", folder / "click.json", "-q", "--photons", "1M")
    sensor = json.loads((folder / "click.json").read_text())["grids"][0]["sensors"][0]
    print(f"lux {late['lux']:.1f} +- {late['error']:.1f}, measured {sensor['lux']:.1f} +- {sensor['standard_error']:.1f}")
    near(late["lux"], sensor["lux"], 0.01 * sensor["lux"] + 4 * np.hypot(late["error"], sensor["standard_error"]))
    text = browser.run("return document.getElementById('reading').textContent")
    assert "±" in text and "left" in text and "right" in text, text
    browser.press("Escape")
    assert browser.run("return document.getElementById('reading').hidden && page.points.all.length === 2")
    browser.run("document.getElementById('no-points').click()")


def check_walk(browser):
    browser.stand()
    browser.exact()
    browser.hold("w", 0.4)
    assert browser.viewer()["eye"][2] < EYE[2] - 0.1
    browser.exact()


def check_moods(browser, scene):
    moods = scene.with_suffix(".moods.json")
    browser.run("page.lights.setKelvin(1, 3000)")
    browser.run(SET_POWER, "left", 0.25)
    browser.run("page.lights.setColour(0, '#4080ff')")
    tint = browser.run("return page.lights.states[0].tint")
    browser.run("""
const form = document.getElementById('keep');
form.elements.mood.value = 'evening';
form.querySelector('button').click();""")
    browser.until("return room.presets.some((preset) => preset.name === 'evening')")
    kept = json.loads(moods.read_text())["moods"]["evening"]
    assert kept["right"]["kelvin"] == 3000 and kept["left"]["on"], kept
    full = browser.run("return room.lights[0].power")
    near(kept["left"]["power"] / full, 0.25, 1e-3)
    browser.choose_preset()
    near(browser.run("return page.lights.states[0].power") / full, 1, 1e-6)
    button = "[...document.querySelectorAll('#presets button')].find((one) => one.title.startsWith(arguments[0])).click()"
    browser.run(button, "Write")
    copy = scene.with_name(f"{scene.stem}.evening.obj")
    for _ in range(200):
        if copy.exists():
            break
        time.sleep(0.05)
    left, written = (next(light["lumens"] for light in json.loads(photile("info", file, "--json"))["lights"]
                          if light["name"] == "left") for file in (scene, copy))
    near(written / left, 0.25, 1e-3)
    browser.choose_preset("evening")
    near(browser.run("return page.lights.states[0].power") / full, 0.25, 1e-3)
    assert browser.run("return page.lights.states[1].kelvin") == 3000
    near(browser.run("return page.lights.states[0].tint"), tint, 1e-5)
    browser.run(button, "Remove evening")
    browser.until("return !room.presets.some((preset) => preset.name === 'evening')")
    assert "evening" not in json.loads(moods.read_text())["moods"]
    browser.choose_preset()


def check_two(browser, url):
    """A second page has the lamps of the first, and its own eye; one that a link opened gives everybody its lamps."""
    browser.run(SET_POWER, "left", 0.5)
    browser.run("document.querySelectorAll('.solo')[1].click()")
    time.sleep(0.3)
    first = browser.driver.current_window_handle
    browser.driver.switch_to.new_window("tab")
    browser.open(url)
    dimmed = "return Math.abs(page.lights.states[0].power / room.lights[0].power - arguments[0]) < 0.01"
    browser.until(dimmed, 0.5)
    assert browser.run("return page.lights.states.map((state) => state.solo)") == [False, True]
    state = {"eye": [2, 1.5, 3], "look": [0.3, 0, 1], "ev": 0.5, "lights": {"left": [browser.run(
        "return 0.75 * room.lights[0].power"), 1, 2700]}, "day": None}
    browser.open(url, urllib.parse.quote(json.dumps(state)))
    browser.until(dimmed, 0.75)
    near(browser.viewer()["eye"], [2, 1.5, 3], 1e-3)
    assert browser.run("return page.stops") == 0.5
    browser.until("return page.renderer.rest")
    browser.driver.close()
    browser.driver.switch_to.window(first)
    browser.until(dimmed, 0.75)
    assert browser.run("return page.lights.states[0].kelvin") == 2700
    assert browser.viewer()["eye"] != [2, 1.5, 3]


def check_exr(browser, folder, scene):
    """The saved picture is the file of `photile render`, also with a lamp moved."""
    browser.stand()
    browser.exact()
    rendered = browser.rendered(folder / "rendered.exr", scene, "--light", "left=x0.5")
    browser.run(SET_POWER, "left", 0.5)
    saved = browser.saved(folder, f"{scene.stem}.exr", lambda: browser.press("s", 2))
    found, expected = (page_test.oiio.ImageInput.open(str(file)) for file in (saved, rendered))
    assert list(found.spec().channelnames) == list(expected.spec().channelnames)
    assert found.spec().getattribute("photile.white") == expected.spec().getattribute("photile.white")
    difference = np.abs(np.asarray(found.read_image("float")) - np.asarray(expected.read_image("float")))
    print(f"EXR: {len(found.spec().channelnames)} channels, off by {difference.max():.2g}")
    assert difference.max() <= 1e-5 * np.asarray(expected.read_image("float")).max()  # a slider is not exact
    browser.run(SET_POWER, "left", 1)


def check_photons(browser):
    """A click tints the triangle and shows its photons; without the mode it measures."""
    browser.stand([3, 1.6, 3.5], [0, -0.6, -0.8])
    browser.exact()
    around = np.s_[80:120, 140:180]
    plain = browser.shown()[around]
    toggle = "[...document.querySelectorAll('#display button')].find((one) => one.textContent.includes('Photons'))"
    browser.run(f"{toggle}.click()")
    browser.click(160, 100)
    browser.until("return page.live.photons.parts")
    assert browser.run("return page.points.all.length === 0"), "a click measures, too"
    shown = browser.shown()[around]
    tinted = np.abs(shown - (0.6 * plain + 0.4 * np.array([230, 60, 40]))).max(axis=2) < 3
    yellow = np.abs(shown - [255, 230, 0]).max(axis=2) < 3
    print(f"photons: tinted {tinted.mean():.0%}, photons {yellow.mean():.0%}")
    assert tinted.mean() > 0.1 and yellow.mean() > 0.1 and tinted.mean() + yellow.mean() > 0.9
    assert "photons on it" in browser.run("return document.querySelector('#display .legend').textContent")
    browser.run(f"{toggle}.click()")
    browser.exact()
    again = browser.shown()[around]
    assert np.array_equal(again, plain), np.abs(again - plain).max()


def check_settings(browser):
    """Fewer photons: the picture at rest is that of the new maps."""
    browser.stand()
    before = browser.exact()
    number = browser.run("return page.live.picture")
    browser.run("""
const input = document.getElementById('setting-photons_emitted');
input.value = 20000;
input.dispatchEvent(new Event('change'));""")
    browser.until(f"return page.live.picture > {number} && page.renderer.rest?.number === page.live.picture")
    after = browser.exact()
    difference = np.abs(after - before).mean() / before.mean()
    print(f"fewer photons: the picture differs by {difference:.2g}")
    assert 1e-4 < difference < 0.2
    browser.until("return document.getElementById('setting-photons_emitted').value === '20000'")


def check_glare(browser, folder):
    """Reflections are marked as `photile render --glare` marks them."""
    for end in ("gltf", "bin"):
        shutil.copy(SOURCE / f"scenes/gallery/glossy-floor.{end}", folder)
    scene = folder / "glossy-floor.gltf"
    limit = 0.2  # of the mean
    result = subprocess.run([PHOTILE, "render", scene, "-o", folder / "floor.exr", "--glare", folder / "glare.png",
                             "--set", f"glare_limit={limit}", "--size", "%dx%d" % SIZE, *MADE[:-1]],
                            capture_output=True, text=True, check=True)
    expected = [float(part) for part in re.search(
        r"glare: \S+: (\S+)% of the picture above (\S+) .*, up to (\S+)", result.stdout + result.stderr).groups()]
    with Served(PHOTILE, scene, *MADE) as served:
        browser.open(served.url)
        browser.run("document.querySelector('[name=shown][value=glare]').click()")
        browser.run("const limit = document.getElementById('glare-limit'); limit.value = arguments[0]; "
                    "limit.dispatchEvent(new Event('change'))", limit)
        browser.exact()
        browser.until("return page.live.glare.marks?.rest === page.renderer.rest")
        text = browser.run("return page.live.glare.section.textContent")
        marked = np.abs(browser.shown() - browser.run("return page.live.glare.marks.colours[0]")).max(axis=2) < 2
        print(f"glare: {expected}; {text}; marked {marked.mean():.2%}")
        assert abs(100 * marked.mean() - expected[0]) < 0.02 * expected[0], (marked.mean(), expected)
        browser.leave()


def check_many_lights(browser, folder):
    """With many lights a frame has the draw calls of one with two, and a slider moves its lamp alone."""
    draws = []
    # A CPU that poses as a GPU takes minutes for 256, since each wait of a work-group costs it dearly.
    for count in (2, 16 if os.environ.get("PHOTILE_DEVICE") == "gpu" else 256):
        scene = page_test.room_of_lights(folder, count)
        with Served(PHOTILE, scene, "--quality", "draft", "--photons", "5k", "--samples", "1", "-q") as served:
            browser.open(served.url)
            browser.until("return document.getElementById('work').hidden && page.renderer.rest?.shown === 1")
            times = browser.run(page_test.FRAME_TIMES, 10, True)
            draws.append(browser.run("return page.renderer.drawCalls"))
            print(f"{count} lights: {draws[-1]} draw calls, {np.median(times):.2f} ms of JavaScript a frame")
            whole = browser.radiance().mean()
            browser.run(SET_POWER, "lamp1", 0)
            # All lights but one, their mix as it becomes the light of the room, and that light.
            read = browser.run("return page.renderer.texelsRead / (room.atlas.width * room.atlas.height)")
            assert read == count + 1, read
            without = browser.radiance().mean()
            browser.run(SET_POWER, "lamp1", 1)
            browser.run("document.querySelectorAll('.solo')[1].click(); page.frame(performance.now())")
            alone = browser.radiance().mean()
            print(f"a slider takes {whole - without:.4g} of {whole:.4g}; the lamp alone: {alone:.4g}")
            near(whole - without, alone, 0.05 * alone)
            browser.leave()
    assert draws[0] == draws[1] > 1, draws


def check_plan(browser, entries, loaded):
    """On the plan the second lamp comes into line with the first, with Shift anywhere, with an arrow a step on."""
    middles = "return page.live.luminaires.state.entries.map(({middles}) => middles[0])"
    browser.run("const [, [x, , z]] = arguments[0]; page.plan.open({middle: [x, z], metres: 4})", browser.run(middles))
    for modifiers, beside in ((0, 0), (8, 0.3)):
        browser.until("return document.querySelectorAll('#outlines circle').length === 2")  # as the plan has them
        first, second = browser.run(middles)
        goal = [first[0] + (beside or 0.05), second[1], second[2] + 0.4]
        start, end = (browser.run("return page.placeOf(arguments[0])", place) for place in (second, goal))
        browser.drag(start, (start[0], start[1] + 5), end, modifiers=modifiers)
        browser.until("const {drags, state: {entries: [one, other]}} = page.live.luminaires; return drags === null && "
                      "Math.abs(other.middles[0][0] - one.middles[0][0] - arguments[0]) < 0.002", beside)
        loaded("page.plan.on")
    before = entries()[1]["position"]
    browser.press("ArrowRight")
    loaded("page.plan.on && page.live.luminaires.state.unsaved")
    near(entries()[1]["position"], np.array(before) + [0.1, 0, 0], 0.0015)
    browser.press("t")


def check_luminaires(browser, folder):
    """Lamps are placed by a click, dragged and copied; the page goes on where it was with each new scene."""
    scene, lamps = room_of_gallery(SOURCE, folder), folder / "lamps.json"
    lamp = "page.live?.luminaires?.state.entries"

    def middle_of(outline):
        return browser.run("const {x, y, width, height} = document.querySelector(arguments[0]).getBoundingClientRect(); "
                           "return [x + width / 2, y + height / 2]", f"#outlines {outline}")

    def loaded(condition):
        browser.until(f"return typeof page === 'object' && document.getElementById('loading') === null && "
                      f"page.live?.luminaires?.state && !page.live.luminaires.state.loading && ({condition})")

    def entries():
        browser.run("return page.live.luminaires.save()")
        browser.until("return !page.live.luminaires.state.unsaved")
        return json.loads(lamps.read_text())

    with Served(PHOTILE, scene, "--luminaires", lamps, *MADE) as served:
        browser.open(served.url)
        loaded("page.renderer.isLit")
        browser.run("page.setExposure(1); page.setPace(1); document.getElementById('follow').checked = false")
        browser.click(40, 120)
        browser.until("return page.points.all.length === 1")
        point = browser.run("return page.points.all[0].place")
        before = browser.pose()
        place = browser.run("return page.meet(140, 100).place")
        browser.press("b")
        browser.click(140, 100)
        loaded("room.lights.length === 1 && room.lights[0].name === 'downlight'")
        near(browser.pose(), before, 1e-3)
        assert browser.run("return [page.stops, page.walker.pace, document.getElementById('follow').checked]") == [1, 2.8, False]
        near(browser.run("return page.points.all[0].place"), point, 1e-3)
        assert not lamps.exists()
        assert browser.run("const event = new Event('beforeunload', {cancelable: true}); window.dispatchEvent(event); "
                           "return event.defaultPrevented"), "unsaved changes are not asked about"
        placed, = entries()
        near(browser.run(f"return {lamp}[0].middles[0]"), place, 0.01)
        x, y = middle_of(".selected")
        browser.drag((x, y), (x - 20, y + 10), (x - 30, y + 15))
        browser.until(f"return Math.hypot(...subtract({lamp}[0].middles[0], arguments[0])) > 0.1", place)
        near(browser.pose(), before, 1e-3)  # what moves is the lamp
        loaded("page.live.luminaires.state.unsaved")
        moved, = entries()
        kept = [here == there for here, there in zip(moved["position"], placed["position"])]
        assert sum(kept) == 1, (placed, moved)
        browser.press("d", 2)
        loaded("room.lights.length === 2")
        browser.press("r")
        browser.until(f"return Math.abs({lamp}[1].rotation - 15) < 1e-6")
        browser.press("Delete")
        loaded("room.lights.length === 1")
        browser.press("z", 2)
        loaded("room.lights.length === 2")
        # A click on a lamp selects it; elsewhere it measures.
        browser.press("Escape")
        browser.until("return document.querySelector('#outlines .selected') === null")
        browser.click(*middle_of("polygon"))
        browser.until("return page.live.luminaires.state.selected === 0")
        assert browser.run("return page.points.all.length") == 1
        browser.click(60, 120)
        browser.until("return page.points.all.length === 2")
        assert len(entries()) == 2
        check_plan(browser, entries, loaded)
        browser.leave()


def test_page(browser, folder):
    scene = page_test.obj_room(folder)
    with Served(PHOTILE, scene, *MADE) as served:
        browser.open(served.url)
        check_first_light(browser)
        check_picture(browser, folder, scene)
        check_lux(browser, folder, scene)
        check_walk(browser)
        check_exr(browser, folder, scene)
        check_photons(browser)
        check_moods(browser, scene)
        check_two(browser, served.url)
        check_settings(browser)
        browser.leave()
    check_glare(browser, folder)
    check_luminaires(browser, folder)
    check_many_lights(browser, folder)


if __name__ == "__main__":
    page_test.main(globals(), Browser)
