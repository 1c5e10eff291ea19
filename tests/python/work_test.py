"""Long work: progress, Ctrl-C, the interpreter's lock."""

import logging
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


@pytest.mark.parametrize("work", ["trace(scene, %d)" % LONG,
                                  "render(scene, photons_emitted=%d, passes=50)" % LONG])
def test_ctrl_c_is_heard(work):
    program = f"""
import photile
corners = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]
scene = photile.Scene(corners, lights=[photile.Light("lamp", 1, position=(0.2, 0.2, 1))])
print("ready", flush=True)
try:
    photile.{work}
except KeyboardInterrupt:
    print("heard", flush=True)
"""
    run = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert run.stdout.readline() == "ready\n"
    time.sleep(0.3)
    run.send_signal(signal.SIGINT)
    assert run.communicate(timeout=60)[0] == "heard\n" and run.returncode == 0


def test_notes_go_to_the_logger(caplog):
    # A scene of mirrors alone stores no photons, and a line says so.
    scene = photile.Scene(
        [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]],
        materials=[photile.Material("mirror", interaction="mirror", specular=(1, 1, 1))],
        lights=[photile.Light("lamp", 1, position=(0.2, 0.2, 1))],
    )
    with caplog.at_level(logging.INFO, "photile"):
        photile.render(scene, size=(4, 4), quality="draft", photons_emitted=100)
    assert any(record.name == "photile" and record.message for record in caplog.records)
