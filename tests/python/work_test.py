"""Long work: progress, Ctrl-C, the interpreter's lock."""

import logging
import random
import signal
import subprocess
import sys
import threading
import time

import pytest

import photile

LONG = 50_000_000  # paths: minutes, if nobody stops them


def test_progress_is_told_in_the_calling_thread(lamps):
    told, threads = [], set()

    def progress(*what):
        told.append(what)
        threads.add(threading.get_ident())

    photile.trace(lamps, 400_000, progress=progress)
    stage, done, total, unit = told[-1]
    assert (stage, done, total, unit) == ("trace photons", 400_000, 400_000, "paths")
    assert threads == {threading.get_ident()}
    assert all(0 <= done <= total for _, done, total, _ in told)


def test_progress_is_a_line_of_each_stage(lamps, capsys):
    photile.trace(lamps, 1_000, progress=True)
    assert capsys.readouterr().err.startswith("trace photons: 100% of 1,000 paths, ")
    photile.trace(lamps, 1_000, progress=False)
    assert capsys.readouterr().err == ""


def test_progress_in_a_notebook_grows_on_one_line_that_ends(lamps, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "ipykernel", sys)
    photile.trace(lamps, 400_000, progress=True)
    shown = capsys.readouterr().err
    *grown, last = shown.rstrip("\n").split("\r")[1:]
    assert shown.endswith("\n") and shown.count("\n") == 1 and last.startswith("trace photons: 100% of 400,000 paths, ")
    assert all(one.startswith("trace photons: ") and len(one) <= len(last) for one in grown)


def test_an_exception_of_the_callback_stops_the_work(lamps):
    class Enough(Exception):
        pass

    def progress(*_):
        raise Enough

    start = time.monotonic()
    with pytest.raises(Enough):
        photile.trace(lamps, LONG, progress=progress)
    assert time.monotonic() - start < 30


def test_other_threads_run_meanwhile(lamps):
    turns, finished = 0, threading.Event()

    def count():
        nonlocal turns
        while not finished.is_set():
            turns += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.monotonic()
    photile.trace(lamps, 1_000_000)
    seconds = time.monotonic() - start
    finished.set()
    thread.join()
    assert turns > 20 * seconds  # with the lock held there would be none


def interrupted(program, seconds):
    """What a program prints that gets Ctrl-C this long after it has said that it is ready, and its exit code."""
    process = subprocess.Popen([sys.executable, "-c", f"import photile\n{program}"], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "ready\n"
        time.sleep(seconds)
        process.send_signal(signal.SIGINT)
        return *process.communicate(timeout=600), process.returncode
    finally:
        process.kill()


@pytest.mark.parametrize("work", ["trace(scene, %d)" % LONG,
                                  "render(scene, photons_emitted=%d, passes=50)" % LONG])
def test_ctrl_c_is_heard(work):
    printed, _, code = interrupted(f"""
scene = photile.Scene([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], lights=[photile.Light("lamp", 1, position=(0.2, 0.2, 1))])
print("ready", flush=True)
try:
    photile.{work}
except KeyboardInterrupt:
    print("heard", flush=True)
""", 0.3)
    assert printed == "heard\n" and code == 0


def test_ctrl_c_is_heard_while_a_scene_is_loaded(tmp_path):
    # Minutes of work: 40 polygons whose corners are the same random points, in another order each.
    draw, corners = random.Random(1), 60_000
    names = list(range(1, corners + 1))
    with open(tmp_path / "crossing.obj", "w") as file:
        for _ in names:
            file.write(f"v {draw.randrange(100_000)} {draw.randrange(100_000)} 0\n")
        for _ in range(40):
            draw.shuffle(names)
            print("f", *names, file=file)
    program = f"print('ready', flush=True)\nphotile.load({str(tmp_path / 'crossing.obj')!r})"
    assert interrupted(program, 3)[1].endswith("KeyboardInterrupt\n")


SETUP = """
import multiprocessing, os, threading, time
import photile
corners = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
scene = photile.Scene(corners, lights=[photile.Light("lamp", 1, position=(0.2, 0.2, 1))])
def small():
    photile.render(scene, size=(4, 4), quality="draft", photons_emitted=1000)
"""


def run(program, setup=SETUP):
    return subprocess.run([sys.executable, "-c", setup + program], capture_output=True, text=True,
                          timeout=600)


@pytest.mark.parametrize("work", ["small()", "photile.trace(scene, 1000)", "photile.devices()"])
def test_a_forked_child_of_a_process_that_worked_is_refused_in_words(work):
    done = run(f"""
small()
child = os.fork()
if child == 0:
    try:
        {work}
    except photile.UsageError as error:
        print(error, flush=True)
        os._exit(0)
    os._exit(1)
print(os.waitpid(child, 0)[1])
""")
    assert "forked" in done.stdout and "spawn" in done.stdout, done
    assert done.stdout.endswith("\n0\n")


def test_a_forked_child_works_where_its_parent_has_not():
    # Where a scene is made, threads check it.
    done = run("""
import os
for _ in range(2):
    child = os.fork()
    if child == 0:
        exec(setup)
        small()
        os._exit(0)
    print(os.waitpid(child, 0)[1])
exec(setup)
small()
""", f"setup = {SETUP!r}")
    assert done.stdout == "0\n0\n" and done.returncode == 0, done


@pytest.mark.parametrize("work", ["trace(scene, %d)" % LONG,
                                  "render(scene, photons_emitted=%d, passes=50)" % LONG])
def test_an_interpreter_ends_while_a_daemon_thread_works(work):
    done = run(f"""
threading.Thread(target=lambda: photile.{work}, daemon=True).start()
time.sleep(1)
""")
    assert done.returncode == 0, done


MAPS = """
import os, numpy, photile
maps = photile.PhotonMaps(numpy.zeros((9, 3), numpy.float32), radius=0.1)
"""


def test_photon_maps_may_live_until_the_interpreter_ends():
    done = run("", MAPS)
    assert done.returncode == 0, done


def test_a_forked_child_may_drop_the_photon_maps_of_its_parent():
    done = run("""
child = os.fork()
if child == 0:
    del maps
    os._exit(0)
print(os.waitpid(child, 0)[1])
""", MAPS)
    assert done.stdout == "0\n" and done.returncode == 0, done


def test_notes_go_to_the_logger(caplog):
    # A scene of mirrors alone stores no photons, and a line says so.
    scene = photile.Scene([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]],
                          materials=[photile.Material("mirror", interaction="mirror", specular=(1, 1, 1))],
                          lights=[photile.Light("lamp", 1, position=(0.2, 0.2, 1))])
    with caplog.at_level(logging.INFO, "photile"):
        photile.render(scene, size=(4, 4), quality="draft", photons_emitted=100)
    assert any(record.name == "photile" and record.message for record in caplog.records)
