"""The command line and the output of the rivals that quality.py runs once per picture."""

import argparse
import json
import pathlib
import time

import numpy as np


def parser(description):
    """SCENE --size WxH --samples N [--denoise] [--next] --begin SECONDS -o FILE.npy"""
    made = argparse.ArgumentParser(description=description)
    made.add_argument("scene", type=pathlib.Path)
    made.add_argument("--size", required=True, metavar="WxH",
                      type=lambda text: tuple(int(side) for side in text.split("x")))
    made.add_argument("--samples", type=int, required=True)
    made.add_argument("--denoise", action="store_true")
    made.add_argument("--next", action="store_true", help="time a second picture, too")
    made.add_argument("--begin", type=float, required=True,
                      help="when the process was started, of time.monotonic()")
    made.add_argument("-o", "--output", type=pathlib.Path, required=True)
    return made


def write(options, render):
    """Writes the first picture, shape (height, width, 3), and prints JSON: its costs from the start of
    the process, and with --next those of a second one.

    render: gives the picture of a seed. Costs are wall-clock seconds and processor seconds of all threads.
    """
    np.save(options.output, render(0))
    first = {"seconds": time.monotonic() - options.begin, "processor": time.process_time()}
    costs = {"first": first}
    if options.next:
        render(1)
        costs["frame"] = {"seconds": time.monotonic() - options.begin - first["seconds"],
                          "processor": time.process_time() - first["processor"]}
    print(json.dumps(costs), flush=True)
