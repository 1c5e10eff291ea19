#!/usr/bin/python3
"""Processes that share a rendering give the bits of one, and end together. (tests/equal_bits has 1 and 3 of them for each
kind of picture.)

    mpi_test.py PHOTILE MPIEXEC CASE

Each case is a function below.
"""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np
import OpenImageIO as oiio

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BOX = SOURCE / "scenes/cornell-box/cornell-box.gltf"
ROOM = SOURCE / "scenes/living-room/living-room.gltf"
SKIPPED = 77

# More ranks than cores, as root in a container, without a network: for OpenMPI. Others do not look.
SETTINGS = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
            "OMPI_MCA_btl": "self,vader", "OMPI_MCA_plm": "isolated"}

photile, mpiexec = sys.argv[1], sys.argv[2]


def check(condition, text):
    if not condition:
        sys.exit(f"mpi_test.py: error: {text}")


def command(ranks, arguments):
    """Of so many ranks; 0: photile on its own."""
    start = [] if ranks == 0 else [mpiexec, "-n", str(ranks)]
    return start + [photile] + [str(argument) for argument in arguments]


def launch(words, **more):
    return subprocess.run([str(word) for word in words], env=os.environ | SETTINGS, text=True, capture_output=True,
                          check=False, **more)


def run(ranks, arguments):
    return launch(command(ranks, arguments))


def run_whole(ranks, arguments):
    done = run(ranks, arguments)
    check(done.returncode == 0, f"{ranks} ranks of {arguments} ended with {done.returncode}: {done.stderr}")
    return done


def channels(file):
    picture = oiio.ImageBuf(str(file))
    check(not picture.has_error, f"{file}: {picture.geterror()}")
    return picture.spec().channelnames, picture.get_pixels(oiio.FLOAT)


def picture_of(folder, ranks, arguments, scene=BOX):
    file = folder / f"{ranks}.exr"
    done = run_whole(ranks, ["render", scene, "-o", file, *arguments])
    check(done.stderr.count("device: ") == 1, f"several ranks tell of their progress: {done.stderr}")
    return channels(file)


def same_pictures(ranks, arguments, scene=BOX, by=0):
    """All the same as those of `by` ranks."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        names, expected = picture_of(folder, by, arguments, scene)
        check(expected.max() > 0, "the picture is black")
        for count in ranks:
            found_names, found = picture_of(folder, count, arguments, scene)
            check(found_names == names, f"{count} ranks: other channels {found_names}")
            differing = np.argwhere(found != expected)
            check(differing.size == 0,
                  f"{count} ranks: {len(differing)} values differ, the first at {differing[:1]}: "
                  f"{found[found != expected][:1]} is not {expected[found != expected][:1]}")


SMALL = ["--photons", "20k", "--size", "32x24", "--samples", "2", "--seed", "3"]


def readings(ranks, folder, arguments=()):
    file, points = folder / f"{ranks}.json", folder / "points.pts"
    points.write_text("".join(f"{0.1 + 0.05 * i} 0.4 {0.1 + 0.03 * i} 0 1 0\n" for i in range(7)))
    done = run_whole(ranks, ["measure", BOX, "--points", points, "--photons", "10k", "--rays", "16", "--repeats", "2",
                             "-o", file, *arguments])
    return done.stdout, json.loads(file.read_text())


def measure():
    """Lux at points, by estimates where rays end."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        expected = readings(1, folder)
        check(expected[0].strip() != "", "nothing was measured")
        for count in (2, 3):
            check(readings(count, folder) == expected, f"{count} ranks read other values")


def error_lines(told):
    return [line for line in told.splitlines() if line.startswith("photile: error: ")]


def check_kept(picture, what):
    """The picture, which held "old", is as it was, and alone in its folder."""
    check(picture.read_text() == "old", f"{what}: the picture is not what it was")
    check(os.listdir(picture.parent) == [picture.name], f"{what}: left {os.listdir(picture.parent)}")


def errors():
    """One line for all, a code that tells, and files as they were."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        picture = folder / "old.exr"
        picture.write_text("old")
        render = ["render", BOX, "-o", picture, *SMALL]
        for arguments, code, words in [
                ([*render, "--light", "nobody=off"], 2, "nobody"),
                ([*render, "--integrator", "path"], 2, "--integrator path"),
                ([*render, "--save-maps", folder / "maps"], 2, "--save-maps"),
                ([*render, "--target-error", "5"], 2, "--target-error"),
                (["bake", BOX, "-o", folder / "baked"], 2, "photile bake"),
                (["trace", BOX, "-o", folder / "photons"], 2, "photile trace"),
                (["render", folder / "none.gltf", "-o", picture], 3, "none.gltf")]:
            done = run(3, arguments)
            lines = error_lines(done.stderr)
            check(done.returncode == code, f"{arguments} ended with {done.returncode}: {done.stderr}")
            check(len(lines) == 1 and words in lines[0], f"{arguments}: {lines}")
            check_kept(picture, arguments)
        # Where one rank alone fails, the others do not wait for it.
        alone = "test $OMPI_COMM_WORLD_RANK = 1 && set -- \"$@\" --device nobody; exec \"$0\" \"$@\""
        done = launch([mpiexec, "-n", 3, "sh", "-c", alone, photile, *render], timeout=600)
        lines = error_lines(done.stderr)
        check(done.returncode == 4 and len(lines) == 1 and "nobody" in lines[0],
              f"a rank without a device: {done.returncode}, {done.stderr}")
        check_kept(picture, "a rank without a device")


def ranks():
    """Any number of ranks and threads."""
    for arguments in ([*SMALL, "--quality", "draft"], SMALL):
        same_pictures([1, 4, 7], arguments)
        same_pictures([3], [*arguments, "--threads", "1"])
    same_pictures([4, 7], [*SMALL, "--quality", "draft", "--set", "light_maps=off"], by=1)
    same_pictures([3], [*SMALL, "--quality", "draft", "--set", "maps=triangle"])
    same_pictures([3], [*SMALL, "--quality", "draft", "--set", "maps=naive", "--set", "light_maps=on"])


def walk():
    """Frames, quick ones too; finished ones are kept."""
    path = json.dumps([{"time": 0, "position": [0.28, 0.27, -0.8], "look_at": [0.28, 0.27, 0]},
                       {"time": 1, "position": [0.3, 0.27, -0.5], "look_at": [0.28, 0.27, 0]}])
    for more in ([], ["--quick"], ["--quality", "draft", "--png", "f.#.png"]):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "path.json").write_text(path)
            frames = {}
            for count in (0, 3):
                (folder / str(count)).mkdir()
                own = [folder / str(count) / word if "#" in word else word for word in more]
                arguments = ["walk", BOX, "-o", folder / str(count) / "f.#.exr", "--camera-path",
                             folder / "path.json", "--fps", "2", *SMALL[:4], "--samples", "1", *own]
                run_whole(count, arguments)
                frames[count] = [channels(folder / str(count) / f"f.{i}.exr")[1] for i in (1, 2, 3)]
                if count > 0:
                    (folder / "3/f.2.exr").unlink()
                    check("2 of 3 frames are already finished" in run_whole(count, arguments).stderr,
                          "finished frames were made again")
            check(all(np.array_equal(a, b) for a, b in zip(frames[0], frames[3])), f"walk {more} differs")
            for png in (folder / "0").glob("*.png"):
                check(png.read_bytes() == (folder / "3" / png.name).read_bytes(), f"{png.name} differs")


ROOM_SMALL = ["--photons", "50k", "--size", "48x36", "--samples", "4"]


def furnished():
    """Cavities, lobes and several lights."""
    same_pictures([3], [*ROOM_SMALL, "--quality", "draft"], ROOM)


def glossy():
    same_pictures([2], [*ROOM_SMALL, "--set", "light_map_rays=8"], ROOM)
    same_pictures([2, 3], [*ROOM_SMALL, "--quality", "draft", "--set", "light_maps=off"], ROOM, by=1)


def different():
    """Ranks of other work than the first's end with a line, and write nothing."""
    room = ["--quality", "draft", "--photons", "5k", "--size", "16x12", "--samples", "1"]
    files = ([BOX, *room], [ROOM, *room], [BOX, *room, "--seed", "2"], [BOX, *room[:4], "--size", "16x13"],
             [BOX, *room, "--projection", "fisheye"], [BOX, *room, "--set", "up=z"])
    runs = [(["render", *files[0], "-o", "mixed.exr"], ["render", *other, "-o", "mixed.exr"]) for other in files[1:]]
    measure = ["measure", BOX, "--points", "points.pts", "--photons", "5k", "-o", "mixed.json"]
    runs += [([*measure, *first], [*measure, *other]) for first, other in (
        (["--rays", "16"], ["--rays", "32"]), (["--repeats", "2"], ["--repeats", "3"]), ([], ["--cylindrical"]))]
    walk = ["walk", BOX, "--camera-path", "path.json", "-o", "f.#.exr", *room[2:]]
    runs += [([*walk, "--frames", "1-2"], [*walk, "--frames", "1-3"])]
    runs += [(runs[0][0], [*runs[0][0], *more]) for more in (["--errors", "e.exr"], ["--glare", "g.png"])]
    for first, other in runs:
        with tempfile.TemporaryDirectory() as name:
            both = [mpiexec, "-n", 1, photile, *first, ":", "-n", 1, photile, *other]
            done = launch(both, cwd=name, timeout=600)
            check(done.returncode == 2, f"{other}: ended with {done.returncode}: {done.stderr}")
            check("ranks 1 and 0" in done.stderr and len(error_lines(done.stderr)) == 1, f"{other}: {done.stderr}")
            check(os.listdir(name) == [], f"{other}: left {os.listdir(name)}")
    with tempfile.TemporaryDirectory() as name:  # files of one name that differ
        for folder, scene in (("0", BOX), ("1", ROOM)):
            shutil.copytree(scene.parent, f"{name}/{folder}")
            os.rename(f"{name}/{folder}/{scene.name}", f"{name}/{folder}/a.gltf")
        own = "cd $OMPI_COMM_WORLD_RANK && exec \"$0\" \"$@\""
        render = ["render", "a.gltf", "-o", "mixed.exr", *room]
        done = launch([mpiexec, "-n", 2, "sh", "-c", own, photile, *render], cwd=name)
        check(done.returncode == 2 and "differ in their scene" in done.stderr, f"{done.returncode}: {done.stderr}")


def children_of(process):
    listed = subprocess.run(["pgrep", "-P", str(process), "photile"], text=True, capture_output=True, check=False)
    return [int(line) for line in listed.stdout.split()]


def disturbed(picture, arguments, disturb, **settings):
    """Three ranks write a picture over an old one, until `disturb` gets the job and the numbers of their processes. The
    exit code, the lines of errors and all that they said, once none of them is left."""
    picture.write_text("old")
    job = subprocess.Popen(command(3, ["render", BOX, "-o", picture, "--set", "passes=1", *arguments]), text=True,
                           env=os.environ | SETTINGS | settings, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while len(children_of(job.pid)) < 3:
        time.sleep(0.05)
    time.sleep(1)
    ranks_of_job = children_of(job.pid)
    disturb(job, ranks_of_job)
    _, told = job.communicate(timeout=600)
    patience = time.time() + 10
    while any(pathlib.Path(f"/proc/{rank}").exists() for rank in ranks_of_job):
        check(time.time() < patience, f"ranks are left: {told}")
        time.sleep(0.1)
    return job.returncode, error_lines(told), told


def signals():
    """SIGTERM ends all with one line; so does the death of a rank, and what was there stays whole."""
    for what, disturb in (("job", lambda job, _: job.terminate()),
                          ("rank", lambda _, ranks_of_job: os.kill(ranks_of_job[1], signal.SIGTERM)),
                          ("killed rank", lambda _, ranks_of_job: os.kill(ranks_of_job[1], signal.SIGKILL))):
        with tempfile.TemporaryDirectory() as name:
            picture = pathlib.Path(name) / "old.exr"
            code, lines, told = disturbed(picture, ["--photons", "100M"], disturb)
            check(code != 0, f"{what}: the job ended well")
            check(len(lines) <= 1 and all("interrupted" in line for line in lines), f"{what}: {lines}")
            check(what == "killed rank" or len(lines) == 1, f"{what}: no line tells: {told}")
            check_kept(picture, what)


def stopped():
    """A rank that is stopped ends all with a line that names it; where all are, for a while, none was silent."""
    def stop_one(_, ranks_of_job):
        os.kill(ranks_of_job[1], signal.SIGSTOP)

    def stop_all(_, ranks_of_job):
        for sent, seconds in ((signal.SIGSTOP, 8), (signal.SIGCONT, 0)):
            for rank in ranks_of_job:
                os.kill(rank, sent)
            time.sleep(seconds)

    with tempfile.TemporaryDirectory() as name:
        picture = pathlib.Path(name) / "old.exr"
        made = ["--quality", "draft", "-q", "--photons"]
        code, lines, told = disturbed(picture, [*made, "100M"], stop_one, PHOTILE_MPI_PATIENCE="3")
        number = [rank for rank in range(3) if f"rank {rank} of 3 has not answered" in told]
        check(code != 0 and len(lines) == 1 and len(number) == 1, f"{code}, {told}")
        check_kept(picture, "a rank was stopped")
        code, lines, told = disturbed(picture, [*made, "1M"], stop_all, PHOTILE_MPI_PATIENCE="3")
        check(code == 0 and lines == [], f"all were stopped: {code}, {told}")
        check(picture.stat().st_size > 100, "no picture was written")


def network():
    """Ranks in network namespaces of their own, with delay and loss between them (needs root)."""
    arguments = [*SMALL, "--quality", "draft"]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        _, expected = picture_of(folder, 0, arguments)
        file = folder / "network.exr"
        done = launch([sys.executable, SOURCE / "tests/cluster/lossy_network.py", "--delay", 2, "--loss", 1,
                       "--ranks", 3, "--", mpiexec, photile, "render", BOX, "-o", file, *arguments])
        print(done.stdout, done.stderr)
        if done.returncode == SKIPPED:
            sys.exit(SKIPPED)
        check(done.returncode == 0, f"ended with {done.returncode}")
        check(np.array_equal(channels(file)[1], expected), "the picture is another")


globals()[sys.argv[3]]()
