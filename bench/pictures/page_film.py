#!/usr/bin/env python3
"""A film of a page of `photile publish`: lamps dimmed one by one and lit again, as animated WebP.

Usage: page_film.py PAGE.html FILM.webp [STILL.png]
"""

import pathlib
import sys
import time

from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from tools import live_page

FILM = (640, 400)
SHOWN = (1280, 800)  # CSS pixels: the film is half as large
STEPS, MILLISECONDS, QUALITY = 5, 160, 82

SET = """
const [i, part] = arguments;
page.lights.states[i].power = part * room.lights[i].power;
page.lights.states[i].on = part > 0;
page.panel.show();
page.changed('light');
page.frame(performance.now());
"""


def main():
    driver = live_page.open_browser(*SHOWN)
    frames = []

    def shoot():
        time.sleep(0.1)
        return Image.fromarray(live_page.screenshot(driver))

    try:
        driver.get(pathlib.Path(sys.argv[1]).resolve().as_uri())
        while driver.execute_script("return document.getElementById('loading')"):
            time.sleep(0.2)
        still = shoot()
        frames += [still] * 3
        lamps = [i for i, power in enumerate(driver.execute_script(
            "return room.lights.map((light) => light.patch === undefined ? light.power : 0)")) if power > 0]
        for lamp in lamps[:-1]:  # one stays on
            for step in range(STEPS - 1, -1, -1):
                driver.execute_script(SET, lamp, (step / STEPS) ** 2)
                frames.append(shoot())
        for lamp in lamps[:-1]:
            driver.execute_script(SET, lamp, 1)
            frames.append(shoot())
    finally:
        driver.quit()
    frames = [frame.resize(FILM, Image.LANCZOS) for frame in frames]
    frames[0].save(sys.argv[2], save_all=True, append_images=frames[1:], duration=MILLISECONDS, loop=0,
                   quality=QUALITY, method=4)
    if len(sys.argv) > 3:
        still.save(sys.argv[3], optimize=True)


main()
