#!/usr/bin/python3
"""A film of what the window shows from its start on, and how far that is from the finished picture.

    bench/pictures/window_film.py [SCENES] [--only NAME] [--seconds N] [--size WxH] [--film FOLDER] [--slide]

Opens `photile view` on a screen in memory for each scene, looks at this screen twenty times a second, and
compares what stands beside the panels with the picture of `photile render`. Keeps each picture that the
window showed as FOLDER/NAME/SECONDS.png. With --slide it then pulls the slider of the second lamp to and fro,
and prints how long the picture takes to follow. Needs the built command, Debian's xvfb and xdotool, and the
packages numpy and OpenImageIO.
"""

import os
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools import packages, scene_arguments

packages.require("numpy", "OpenImageIO")

import numpy as np

from tools import picture_error

PANEL = 300  # columns at the left of the picture, and
READING = 60  # rows at the top and at the foot that others than the picture take
KNOBS = slice(14, 194)  # columns of the sliders of lamps
LOOKS_PER_SECOND = 20
SCREEN_PATIENCE, REST_PATIENCE = 10, 300  # seconds
CASES = (  # name, scene, options
    ("living room", "scenes/living-room/living-room.gltf", ()),
    ("office by day", "scenes/office/office.gltf",
     ("--sky", "perez=700,120", "--site", "52.5,13.4,1", "--time", "2026-03-21T10:00",
      "--set", "ground=0")),
    ("kitchen", "kitchen/kitchen.gltf", ()),
    ("classroom", "classroom/classroom.gltf", ()),
)


def arguments():
    parser = scene_arguments.parser(__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="NAME", help="this scene alone")
    parser.add_argument("--seconds", type=float, default=10, help="default: %(default)s")
    parser.add_argument("--size", default="1280x800", help="of the screen; default: %(default)s")
    parser.add_argument("--film", type=pathlib.Path, metavar="FOLDER",
                        help="where pictures are kept; default: nowhere")
    parser.add_argument("--references", type=pathlib.Path, metavar="FOLDER",
                        help="where pictures of `photile render` are kept, and read again; default: nowhere")
    parser.add_argument("--rest", action="store_true", help="wait until the window is at rest, too")
    parser.add_argument("--slide", action="store_true", help="print how quickly a slider shows, too")
    parser.add_argument("--options", type=shlex.split, default=[], metavar="'OPTION ...'",
                        help="of the window beside the scene's own")
    return parser.parse_args()


class Screen:
    """Xvfb, and what is on its screen."""

    def __init__(self, size, folder):
        reading, writing = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{size}x24", "-fbdir", folder, "-noreset"],
            pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            self.display = ":" + pipe.readline().strip()
        self.raw = np.memmap(pathlib.Path(folder) / "Xvfb_screen0", dtype=np.uint8, mode="r")
        head = self.raw[:100].view(">u4")  # XWDFileHeader of X11/XWDFile.h
        self.begin = int(head[0] + 12 * head[19])
        self.width, self.height, self.stride = int(head[4]), int(head[5]), int(head[12])

    def trace(self):
        """Some of its bytes, which tell whether it is another picture."""
        return self.raw[self.begin:self.begin + self.stride * self.height].reshape(
            self.height, self.stride)[READING:-READING:7, 4 * PANEL:].tobytes()

    def shown(self):
        """RGB, once nobody is writing it."""
        last = None
        while True:
            now = np.array(self.raw[self.begin:self.begin + self.stride * self.height])
            if last is not None and np.array_equal(last, now):
                rows = now.reshape(self.height, self.stride // 4, 4)
                return rows[:, :self.width, 2::-1]
            last = now

    def mouse(self, *words):
        subprocess.run(["xdotool", *map(str, words)], check=True, env={**os.environ, "DISPLAY": self.display})

    def close(self):
        self.process.terminate()
        self.process.wait()


def processor_seconds(process):
    """Of a process that runs."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def title_of(screen):
    """Of the window."""
    found = subprocess.run(["xdotool", "search", "--name", "photile", "getwindowname"], text=True,
                           capture_output=True, check=False, env={**os.environ, "DISPLAY": screen.display})
    return found.stdout.strip()


def picture_size(asked):
    """Beside the panel, on a screen of this size."""
    width, height = map(int, asked.size.split("x"))
    return f"{width - PANEL}x{height}"


def clear(picture):
    return picture[READING:-READING]


def sliders(screen):
    """(x, y) of the knobs of the lamps' sliders, from the top."""
    panel = screen.shown()[:, :PANEL - 20].astype(int)
    blue = (panel[..., 2] > 180) & (panel[..., 0] < 100) & (panel[..., 1] > 80) & (panel[..., 1] < 160)
    found = []
    for y in np.flatnonzero(blue[:, KNOBS].sum(axis=1) > 3):
        if not found or y > found[-1][1] + 12:
            found.append((KNOBS.start + int(np.flatnonzero(blue[y, KNOBS]).mean()), int(y) + 4))
    return found


def brightness(screen):
    """Of the picture, from some of its bytes."""
    return np.frombuffer(screen.trace(), dtype=np.uint8).mean()


def seconds_to_follow(screen):
    """From a jump of the second lamp's slider until the picture shows it: a list, one for each jump."""
    knobs = sliders(screen)
    if len(knobs) < 2:
        raise OSError("no sliders are seen in the window")
    x, y = knobs[1]
    screen.mouse("mousemove", x, y, "mousedown", 1)
    taken = []
    for jump in range(8):
        time.sleep(0.5)
        before = brightness(screen)
        begin = time.monotonic()
        screen.mouse("mousemove", KNOBS.start if jump % 2 == 0 else x, y)
        begin = (begin + time.monotonic()) / 2  # xdotool takes some milliseconds itself
        while abs(brightness(screen) - before) < 1:
            if time.monotonic() > begin + SCREEN_PATIENCE:
                raise OSError("the picture does not follow the slider")
            time.sleep(0.002)
        taken.append(time.monotonic() - begin)
    screen.mouse("mouseup", 1)
    return taken


def film(command, scene, options, asked, seconds):
    """What the window shows: (seconds, processor seconds, RGB) of each new picture, the last when it is
    at rest if that is waited for."""
    with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
        screen = Screen(asked.size, folder)
        begin = time.monotonic()
        process = subprocess.Popen(
            [command, "view", scene, "--size", picture_size(asked), "--set", "view=standard", "--quiet", "--outputs",
             folder, *options], env={**os.environ, "DISPLAY": screen.display})
        pictures = []
        trace = screen.trace()
        try:
            while True:
                now = time.monotonic() - begin
                if (newest := screen.trace()) != trace:
                    trace = newest
                    pictures.append((now, processor_seconds(process), screen.shown().copy()))
                if now > seconds and asked.slide:
                    taken = sorted(1000 * one for one in seconds_to_follow(screen))
                    print(f"a slider shows after {taken[len(taken) // 2]:.0f} ms ({taken[0]:.0f} to "
                          f"{taken[-1]:.0f})", flush=True)
                    asked.slide = False
                if now > seconds and not asked.rest:
                    return pictures
                if now > seconds and at_rest(title_of(screen)):
                    pictures.append((now, processor_seconds(process), screen.shown().copy()))
                    return pictures
                if now > REST_PATIENCE or process.poll() is not None:
                    raise OSError(f"{scene}: the window comes to no rest")
                time.sleep(1 / LOOKS_PER_SECOND if now < seconds else 0.5)
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait()
            screen.close()


def at_rest(title):
    """"NAME - photile: 16 of 16 samples, 0.5M paths"."""
    words = title.split(": ", 1)[-1].split()
    return len(words) > 2 and words[0] == words[2]


def linear(shown):
    """Of sRGB bytes."""
    share = shown / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def mottle_of(shown, reference):
    """As picture_error.mottle, at the exposure that fits best, where the screen tells brightness."""
    shown = shown[:, PANEL:]
    own, true = clear(linear(shown)), clear(reference)
    brightest = clear(shown).max(axis=2)
    told = (brightest >= 40) & (brightest <= 250)
    if told.mean() < 0.05:
        return None
    luminance = picture_error.LUMINANCE
    factor = np.median((own @ luminance)[told] / (true @ luminance)[told])
    return picture_error.mottle(np.where(told[..., None], own / factor, true), true)


def rendered(asked, name, scene, options):
    """The picture of `photile render`, made once where pictures are kept."""
    with tempfile.TemporaryDirectory() as folder:
        file = (asked.references or pathlib.Path(folder)) / f"{name.replace(' ', '-')}-{picture_size(asked)}.exr"
        if not file.exists():
            subprocess.run([asked.photile, "render", scene, "--size", picture_size(asked), "--quality", "good",
                            "--samples", "16", "--quiet", "-o", file, *options], check=True)
        return picture_error.read_picture(file)


def main():
    asked = arguments()
    print("| scene | s | processor s | mottle |")
    print("|---|--:|--:|--:|")
    for name, file, options in CASES:
        if asked.only and name != asked.only:
            continue
        scene = ROOT / file if file.startswith("scenes/") else asked.scenes / file
        reference = rendered(asked, name, scene, options)
        for seconds, processor, shown in film(asked.photile, scene, [*options, *asked.options], asked,
                                              asked.seconds):
            figure = mottle_of(shown, reference)
            print(f"| {name} | {seconds:.2f} | {processor:.2f} | "
                  f"{'-' if figure is None else f'{100 * figure:.1f}%'} |", flush=True)
            if asked.film:
                kept = asked.film / name.replace(" ", "-")
                kept.mkdir(parents=True, exist_ok=True)
                picture_error.write_png(kept / f"{seconds:06.2f}.png", shown / 255)


if __name__ == "__main__":
    try:
        main()
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"window_film.py: error: {error}")
