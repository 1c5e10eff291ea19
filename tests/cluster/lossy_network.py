#!/usr/bin/python3
"""Ranks on machines of their own: network namespaces that a slow network with losses joins.

    lossy_network.py --delay MILLISECONDS --loss PERCENT --ranks N -- MPIEXEC COMMAND ...

Starts N namespaces with names and addresses of their own, and runs the command by OpenMPI's mpirun with a rank in
each. A switch in this process takes their frames from TAP devices, loses some, and passes the others on after the
delay: what `tc qdisc ... netem` does in kernels that have it. Needs root, unshare, nsenter and ip. Prints the frames
and the bytes that passed, and exits with the code of mpirun; 77 where namespaces or TAP devices are not to be had.
"""

import argparse
import ctypes
import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
TUNSETIFF, IFF_TAP, IFF_NO_PI, CLONE_NEWNET = 0x400454CA, 0x0002, 0x1000, 0x40000000
LIBC = ctypes.CDLL(None, use_errno=True)


class Machine:
    """A namespace with a name and an address."""

    def __init__(self, number):
        self.name, self.address = f"node{number}", f"10.77.0.{number + 1}"
        self.holder = subprocess.Popen(["unshare", "--net", "--uts", "sleep", "infinity"])
        deadline = time.time() + 5
        while os.readlink(f"/proc/{self.holder.pid}/ns/net") == os.readlink("/proc/self/ns/net"):
            if self.holder.poll() is not None or time.time() > deadline:
                sys.exit(SKIPPED)
            time.sleep(0.01)
        self.tap = self.open_tap()
        for words in (["hostname", self.name], ["ip", "link", "set", "lo", "up"],
                      ["ip", "address", "add", f"{self.address}/24", "dev", "tap0"],
                      ["ip", "link", "set", "tap0", "up"]):
            subprocess.run(self.within() + words, check=True)

    def within(self):
        return ["nsenter", "--net", "--uts", "--target", str(self.holder.pid)]

    def open_tap(self):
        """Opened there, and read here."""
        own = os.open("/proc/self/ns/net", os.O_RDONLY)
        there = os.open(f"/proc/{self.holder.pid}/ns/net", os.O_RDONLY)
        try:
            if LIBC.setns(there, CLONE_NEWNET) != 0:
                sys.exit(SKIPPED)
            tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
            fcntl.ioctl(tap, TUNSETIFF, struct.pack("16sH22x", b"tap0", IFF_TAP | IFF_NO_PI))
            return tap
        except OSError:
            sys.exit(SKIPPED)
        finally:
            LIBC.setns(own, CLONE_NEWNET)
            os.close(own)
            os.close(there)


class Switch:
    """Passes frames on between TAP devices, late, and not all of them."""

    def __init__(self, taps, delay, loss):
        self.taps, self.delay, self.loss = taps, delay, loss
        self.tap_of, self.waiting, self.count = {}, [], 0
        self.frames = self.bytes = self.lost = 0
        self.random = random.Random(1)

    def take(self, tap):
        try:
            frame = os.read(tap, 65536)
        except BlockingIOError:
            return
        self.tap_of[frame[6:12]] = tap
        self.frames += 1
        self.bytes += len(frame)
        if self.random.random() < self.loss:
            self.lost += 1
            return
        self.count += 1
        heapq.heappush(self.waiting, (time.monotonic() + self.delay, self.count, tap, frame))

    def give(self):
        while self.waiting and self.waiting[0][0] <= time.monotonic():
            _, _, source, frame = heapq.heappop(self.waiting)
            known = self.tap_of.get(frame[0:6])
            for tap in [known] if known is not None else self.taps:
                if tap != source:
                    try:
                        os.write(tap, frame)
                    except OSError:
                        self.lost += 1

    def run(self, job):
        while job.poll() is None:
            due = self.waiting[0][0] - time.monotonic() if self.waiting else 0.05
            for tap in select.select(self.taps, [], [], min(0.05, max(0, due)))[0]:
                self.take(tap)
            self.give()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--delay", type=float, default=1)
    parser.add_argument("--loss", type=float, default=1)
    parser.add_argument("--ranks", type=int, default=3)
    parser.add_argument("command", nargs="+")
    options = parser.parse_args()
    if os.geteuid() != 0 or not os.path.exists("/dev/net/tun"):
        sys.exit(SKIPPED)
    machines = []
    try:
        for number in range(options.ranks):
            machines.append(Machine(number))
        with tempfile.TemporaryDirectory() as folder:
            # Stands in for ssh: enters the namespace of an address.
            agent = os.path.join(folder, "agent.sh")
            with open(agent, "w", encoding="ascii") as file:
                file.write('#!/bin/sh\nwhile [ "${1#-}" != "$1" ]; do shift; done\nhost=$1; shift\ncase $host in\n')
                for machine in machines:
                    file.write(f'{machine.address}) exec {" ".join(machine.within())} /bin/sh -c "$*" ;;\n')
                file.write("esac\n")
            os.chmod(agent, 0o755)
            hosts = ",".join(f"{machine.address}:1" for machine in machines)
            mpiexec, *command = options.command
            network = "10.77.0.0/24"
            words = [mpiexec, "--host", hosts, "-n", str(options.ranks), "--bind-to", "none",
                     "--mca", "plm", "rsh", "--mca", "plm_rsh_agent", agent, "--mca", "btl", "tcp,self",
                     "--mca", "btl_tcp_if_include", network, "--mca", "oob_tcp_if_include", network]
            environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
            for name in ("OMPI_MCA_btl", "OMPI_MCA_plm"):
                environment.pop(name, None)
            job = subprocess.Popen(machines[0].within() + words + command, env=environment)
            switch = Switch([machine.tap for machine in machines], options.delay / 1000, options.loss / 100)
            switch.run(job)
        print(f"{switch.frames} frames, {switch.bytes} bytes, {switch.lost} lost")
        sys.exit(job.returncode)
    finally:
        for machine in machines:
            machine.holder.terminate()
            machine.holder.wait()


main()
