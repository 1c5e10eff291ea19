"""What processes take."""

import resource
import subprocess
import time


def processor_seconds():
    """Of all processes that ended so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def timed(command):
    """Wall-clock and processor seconds of a process, and what it wrote to stderr."""
    before, begin = processor_seconds(), time.monotonic()
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return time.monotonic() - begin, processor_seconds() - before, done.stderr
