#!/usr/bin/python3
"""A film of the live page from the start of `photile view` on, and how far it is from the picture at rest, which is that of
`photile render` (tests/serve).

    bench/pictures/live_film.py [SCENES] [--only NAME] [--size WxH] [--film FOLDER] [--write]

Opens the page of each scene in Chromium, which draws on the processor, and looks at it several times a second. The time
begins with the command; the browser is open before. Prints when the room is seen and when it is lit, what each picture
lacks, milliseconds from the move of a slider to the frame that shows it, JavaScript's share of a frame, and its draw calls.
Processor seconds are those of `photile` alone. --film keeps each picture as FOLDER/NAME/SECONDS.png, --write puts the
table into docs/measured/live.md. Needs the built command, what tools/live_page.py does, and the packages numpy and
OpenImageIO.
"""

import pathlib
import shlex
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages, scene_arguments

packages.require("numpy", "OpenImageIO")

import numpy as np

from tools import live_page, picture_error
from tools.report_section import replace_section

DIFFERENCES_AFTER = (10, 25)  # processor seconds
LOOKS_PER_SECOND = 4  # a screenshot takes a tenth of a second of two cores
FILMED = 10  # seconds, of which each look is taken
CASES = (  # name, scene, options
    ("living room", "scenes/living-room/living-room.gltf", ()),
    ("office by day", "scenes/office/office.gltf",
     ("--sky", "perez=700,120", "--site", "52.5,13.4,1", "--time", "2026-03-21T10:00",
      "--set", "ground=0")),
    ("kitchen", "kitchen/kitchen.gltf", ()),
    ("classroom", "classroom/classroom.gltf", ()),
)
BARE = "document.querySelectorAll('body > :not(canvas)').forEach((part) => { part.style.visibility = 'hidden'; });"
# From the event of a slider to the end of the frame that has it: the page's own work, then all that was drawn.
SLIDE = """
const i = room.lights.findIndex((light) => light.patch === undefined && light.power > 0);
if (i < 0) return null;
const slider = document.getElementById('light' + i), taken = [], frames = [];
for (let jump = 0; jump < 8; ++jump) {
  const began = performance.now();
  slider.value = jump % 2 ? 0.7 : 0.35;
  slider.dispatchEvent(new Event('input'));
  page.frame(performance.now());
  frames.push(page.frameTime);
  page.renderer.gl.finish();
  page.renderer.gl.readPixels(0, 0, 1, 1, page.renderer.gl.RGBA, page.renderer.gl.UNSIGNED_BYTE, new Uint8Array(4));
  taken.push(performance.now() - began);
}
const middle = (list) => list.sort((a, b) => a - b)[list.length / 2];
return [middle(taken), middle(frames), page.renderer.drawCalls];"""


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="NAME", help="this scene alone")
    parser.add_argument("--size", default="1280x800", help="of the page; default: %(default)s")
    parser.add_argument("--film", type=pathlib.Path, metavar="FOLDER",
                        help="where pictures are kept; default: nowhere")
    parser.add_argument("--write", action="store_true", help="write docs/measured/live.md")
    parser.add_argument("--options", type=shlex.split, default=[], metavar="'OPTION ...'",
                        help="of the command beside the scene's own")
    return parser.parse_args()


def film(driver, scene, options, asked):
    """When the room is seen and lit, what the page shows: (seconds, processor seconds, RGB) of each picture, and what
    SLIDE returns."""
    begin = time.monotonic()
    with live_page.Served(asked.photile, scene, "--set", "view=standard", *options) as served:
        driver.get(served.url)
        pictures, when = [], {}
        while True:
            seen, lit, rests = live_page.state(driver)
            now, used = time.monotonic() - begin, served.processor_seconds()
            if now > live_page.PATIENCE:
                raise OSError(f"{scene}: the page comes to no rest")
            if not seen:
                time.sleep(0.01)
                continue
            if not pictures:
                when["seen"] = now
                driver.execute_script(BARE)
            if lit:
                when.setdefault("lit", now)
            pictures.append((now, used, live_page.screenshot(driver)))
            if rests:
                when["rest"] = now
                return when, pictures, driver.execute_script(SLIDE)
            time.sleep(1 / LOOKS_PER_SECOND if now < FILMED else 2)


def linear(shown):
    """Of sRGB bytes."""
    share = shown / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def mottle_of(shown, last):
    """As picture_error.mottle, at the exposure that fits best, where both screens tell brightness."""
    told = np.all([(each.max(axis=2) >= 40) & (each.max(axis=2) <= 250) for each in (shown, last)], axis=0)
    if told.mean() < 0.05:
        return None
    own, reference = linear(shown), linear(last)
    luminance = picture_error.LUMINANCE
    factor = np.median((own @ luminance)[told] / (reference @ luminance)[told])
    return picture_error.mottle(np.where(told[..., None], own / factor, reference), reference)


def percent(figure):
    return "-" if figure is None else f"{100 * figure:.1f}%"


def table(rows):
    """Of all scenes, as Markdown."""
    lines = ["| scene | room seen, s | lit, s | " + " | ".join(
                 f"mottle after {seconds} processor s" for seconds in DIFFERENCES_AFTER) +
             " | at rest, s | a slider shows, ms | JavaScript of a frame, ms | draw calls |",
             "|---|" + "--:|" * (6 + len(DIFFERENCES_AFTER))]
    for name, when, looks, slid in rows:
        after = [next((figure for _, used, figure in looks if used >= seconds), None) for seconds in DIFFERENCES_AFTER]
        slider = [f"{slid[0]:.0f}", f"{slid[1]:.1f}", f"{slid[2]:.0f}"] if slid else ["-"] * 3
        lines.append(f"| {name} | {when['seen']:.1f} | {when['lit']:.1f} | " +
                     " | ".join([*map(percent, after), f"{when['rest']:.0f}", *slider]) + " |")
    return "\n".join(lines)


def main():
    asked = arguments()
    driver = live_page.open_browser(*map(int, asked.size.split("x")))
    rows = []
    try:
        for name, file, options in CASES:
            scene = ROOT / file if file.startswith("scenes/") else asked.scenes / file
            if (asked.only and name != asked.only) or not scene.exists():
                continue
            when, pictures, slid = film(driver, scene, [*options, *asked.options], asked)
            looks = [(seconds, used, mottle_of(shown, pictures[-1][2])) for seconds, used, shown in pictures[:-1]]
            rows.append((name, when, looks, slid))
            print(f"\n{name}\n\n| s | processor s | mottle |\n|--:|--:|--:|")
            for seconds, used, figure in looks:
                print(f"| {seconds:.2f} | {used:.2f} | {percent(figure)} |")
            if asked.film:
                kept = asked.film / name.replace(" ", "-")
                kept.mkdir(parents=True, exist_ok=True)
                for seconds, _, shown in pictures:
                    picture_error.write_png(kept / f"{seconds:06.2f}.png", shown / 255)
    finally:
        driver.quit()
    print(f"\n{table(rows)}")
    if asked.write:
        replace_section(ROOT / "docs/measured/live.md", "pictures/live_film.py", table(rows))


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        sys.exit(f"live_film.py: error: {error}")
