#!/usr/bin/python3
"""How soon `photile view` shows a room and its light; writes docs/measured/live.md.

    bench/pictures/live_times.py [SCENES] [--only NAME] [--size WxH] [--write]

First without a browser: when the server has sent the page, and when it has the first light for the opening view. Then in
Chromium, which draws by software on the same processor: when the room is seen and when it is lit, milliseconds from the move
of a slider until the frame that shows it is drawn, JavaScript's share of that, draw calls, and the texels of light maps that
it reads. Seconds begin with the command; the browser is open before. Last, in another run, how far the canvas is from that
at rest after some seconds of the server's processor time. Needs the built command and what tools/live_page.py does.
"""

import http.client
import json
import pathlib
import shlex
import sys
import time
import urllib.parse

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import live_page, scene_arguments
from tools.report_section import replace_section

CASES = (  # name, scene, options
    ("living room", "scenes/living-room/living-room.gltf", ()),
    ("office by day", "scenes/office/office.gltf",
     ("--sky", "perez=700,120", "--site", "52.5,13.4,1", "--time", "2026-03-21T10:00",
      "--set", "ground=0")),
    ("kitchen", "kitchen/kitchen.gltf", ()),
    ("classroom", "classroom/classroom.gltf", ()),
)
# From the event of a slider to the end of the frame that has it: the page's own work, then all that was drawn.
SLIDE = """
const i = room.lights.findIndex((light) => light.patch === undefined && light.power > 0);
if (i < 0) return null;
const slider = document.getElementById('light' + i), taken = [], scripts = [];
for (let jump = 0; jump < 4; ++jump) {
  const began = performance.now();
  slider.value = jump % 2 ? 0.7 : 0.35;
  slider.dispatchEvent(new Event('input'));
  page.frame(performance.now());
  scripts.push(page.frameTime);
  page.renderer.gl.readPixels(0, 0, 1, 1, page.renderer.gl.RGBA, page.renderer.gl.UNSIGNED_BYTE, new Uint8Array(4));
  taken.push(performance.now() - began);
}
const middle = (list) => list.sort((a, b) => a - b)[list.length / 2];
return [middle(taken), middle(scripts), page.renderer.drawCalls, page.renderer.texelsRead / 1e6];"""
UNFINISHED = (10, 25)  # seconds of the server's processor time
LONGEST = 1800         # seconds until rest
NOTE = """
The last two columns are the mean difference of the canvas from the one at rest, in luminance of sRGB values, relative to the
mean of that one, after so many seconds of the server's processor time. They are 0 where the page rests before."""


def sent(photile, scene, options):
    """Seconds until the page, and until the first light, without a browser."""
    begin = time.monotonic()
    with live_page.Served(photile, scene, *options) as served:
        address = urllib.parse.urlsplit(served.url)
        page, news = (http.client.HTTPConnection(address.hostname, address.port, timeout=live_page.PATIENCE) for _ in range(2))
        page.request("GET", address.path)
        text = page.getresponse().read().decode()
        of_page = time.monotonic() - begin
        edition = json.loads(text.split('id="room">')[1].split("</script>")[0])["live"]
        news.request("GET", f"{address.path}events?viewer=bench&since={edition}")
        for line in news.getresponse():
            if line.startswith(b"data: ") and json.loads(line[6:]).get("light", 0) > 0:
                return of_page, time.monotonic() - begin
    raise OSError(f"{scene}: no light comes")


def seen(driver, photile, scene, options):
    """Seconds until the room is seen, and until it is lit, in a browser; and what SLIDE returns."""
    begin, when = time.monotonic(), []
    with live_page.Served(photile, scene, *options) as served:
        driver.get(served.url)
        while len(when) < 2:
            is_seen, is_lit, _ = live_page.state(driver)
            when += [time.monotonic() - begin] * (is_seen + is_lit - len(when))
            if time.monotonic() > begin + live_page.PATIENCE:
                raise OSError(f"{scene}: no light is seen")
            time.sleep(0.05)
        return *when, driver.execute_script(SLIDE)


def unfinished(driver, photile, scene, options):
    """The canvas after each time of UNFINISHED beside that at rest."""
    began, shown = time.monotonic(), []
    luminances = lambda: live_page.canvas(driver) @ np.array([0.2126, 0.7152, 0.0722])
    with live_page.Served(photile, scene, *options) as served:
        driver.get(served.url)
        while True:
            is_seen, _, is_resting = live_page.state(driver)
            if is_resting:
                break
            if is_seen and len(shown) < len(UNFINISHED) and served.processor_seconds() >= UNFINISHED[len(shown)]:
                shown.append(luminances())
            if time.monotonic() > began + LONGEST:
                raise OSError(f"{scene}: the page does not come to rest")
            time.sleep(0.05)
        last = luminances()
    shown += [last] * (len(UNFINISHED) - len(shown))
    return [np.abs(one - last).mean() / last.mean() for one in shown]


def main():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="NAME", help="this scene alone")
    parser.add_argument("--size", default="1280x800", help="of the page; default: %(default)s")
    parser.add_argument("--finish", nargs="*", metavar="NAME", default=[name for name, _, _ in CASES],
                        help="scenes whose picture at rest is awaited, minutes each, for the last two columns; default: all")
    parser.add_argument("--write", action="store_true", help="write docs/measured/live.md")
    parser.add_argument("--options", type=shlex.split, default=[], metavar="'OPTION ...'",
                        help="of the command beside the scene's own")
    asked = parser.parse_args()
    lines = ["| scene | page sent, s | first light sent, s | in Chromium: seen, s | lit, s | a slider shows, ms "
             "| JavaScript of it, ms | draw calls | texels, millions | " +
             " | ".join(f"half as large: unfinished after {seconds} s" for seconds in UNFINISHED) + " |",
             "|---|" + "--:|" * (8 + len(UNFINISHED))]
    width, height = map(int, asked.size.split("x"))
    driver = live_page.open_browser(width, height)
    try:
        for name, file, options in CASES:
            scene = ROOT / file if file.startswith("scenes/") else asked.scenes / file
            if (asked.only and name != asked.only) or not scene.exists():
                continue
            live_page.set_size(driver, width, height)
            times = *sent(asked.photile, scene, options), *seen(driver, asked.photile, scene, options)
            slid = ([f"{number:.{digits}f}" for number, digits in zip(times[4], (0, 1, 0, 2), strict=True)] if times[4]
                    else ["-"] * 4)
            # A large exact picture takes minutes beside a browser without a graphics chip.
            live_page.set_size(driver, width // 2, height // 2)
            left = ([f"{part:.1%}" for part in unfinished(driver, asked.photile, scene, options)] if name in asked.finish
                    else ["-"] * len(UNFINISHED))
            lines.append("| " + " | ".join([name, *(f"{part:.1f}" for part in times[:4]), *slid, *left]) + " |")
            print(lines[-1], flush=True)
    finally:
        driver.quit()
    if asked.write:
        replace_section(ROOT / "docs/measured/live.md", "pictures/live_times.py", "\n".join([*lines, NOTE]))


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(f"live_times.py: error: {error}")
