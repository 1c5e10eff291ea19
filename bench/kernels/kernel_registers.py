#!/usr/bin/python3
"""Writes the table of registers, local memory and occupancy in docs/measured/registers.md: what compilers for GPUs
make of the kernels, without a GPU.

    bench/kernels/kernel_registers.py --libclc /usr/lib/clc --ptxas PTXAS [--write]

Clang compiles OpenCL C to PTX and to the code of AMD's processors, with libclc's built-in functions
(Debian: libclc-14); NVIDIA's ptxas (PyPI: nvidia-cuda-nvcc-cu12) makes code of the PTX and says what it
takes. The drivers' own compilers may take more or less: they are others, of other versions.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from tools.report_section import replace_section

PAGE = ROOT / "docs/measured/registers.md"

# The work-items of a group, of kernels that ask for no number of their own (maps/map_store.hpp).
GROUP = 64


def capacity(k, lanes):
    """What host/renderer/estimate/specialisation.cpp keeps of distances."""
    if lanes:
        return min(max(-(-8 * k // lanes) * lanes, 256), 4096)
    return min(max(-(-8 * k // 16) * 16, 256), 800)


def estimate(k, lanes=0, **more):
    symbols = {"VECTOR_WIDTH": lanes or 1, "CAPACITY": capacity(k, lanes),
               "NEAR_CAPACITY": k if lanes else 128, "HITS_PER_ITEM": 4 if lanes else 1, **more}
    return {"LANES": 1, **symbols} if lanes else symbols


GLOSSY = {"GLOSSY": 1, "CLIPPED": 1}
MANY = {"LIGHT_BYTES": 1, "LIGHT_SLOTS": 20, "LIGHT_TABLE": 32, "CLIPPED": 1}

# (name, file, kernel, symbols, work-items of a group)
VARIANTS = [
    *((kernel, "grid/build.cl", kernel, {"IN_GROUPS": 1}, GROUP)
      for kernel in ("find_insertions", "count_cells", "scatter", "sort_cells", "copy_records")),
    ("sort_crowded", "grid/build.cl", "sort_crowded", {"IN_GROUPS": 1}, 256),
    ("one work-item a hit, k = 50, disc", "estimate/estimate.cl", "estimate_by_selection", estimate(50), GROUP),
    ("the same, clipped", "estimate/estimate.cl", "estimate_by_selection", estimate(50, CLIPPED=1), GROUP),
    *((f"{lanes} lanes, k = {k}, {'clipped' if clipped else 'disc'}", "estimate/estimate.cl",
       "estimate_by_selection", estimate(k, lanes, **({"CLIPPED": 1} if clipped else {})), lanes)
      for lanes in (32, 64) for k, clipped in ((50, False), (50, True), (1000, True))),
    *((f"{lanes} lanes, k = 50, clipped, glossy", "estimate/estimate.cl", "estimate_by_selection",
       estimate(50, lanes, **GLOSSY), lanes) for lanes in (32, 64)),
    *((f"{lanes} lanes, k = 50, clipped, 20 lights", "estimate/estimate.cl", "estimate_by_selection",
       estimate(50, lanes, **MANY), lanes) for lanes in (32, 64)),
    *((f"heap, k = 50, {name}", f"structures/{file}.cl", "estimate_by_list", {"LIST_CAPACITY": 64}, GROUP)
      for name, file in (("kd-tree", "kdtree"), ("wide BVH", "wide_bvh"))),
]


def run(command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit(f"kernel_registers.py: error: {command[0]} failed: {result.stderr[:2000]}")
    return result.stdout + result.stderr


class Compiler:
    def __init__(self, clang, libclc):
        self.clang, self.libclc = clang, pathlib.Path(libclc)

    def compile(self, text, symbols, target, processor, library, out):
        # All is inlined, as drivers do, but for what the kernels keep apart.
        run([self.clang, "-x", "cl", "-cl-std=CL1.2", "-target", target, "-nogpulib", "-O3", "-w",
             "-I", str(ROOT / "kernels"), "-I", str(ROOT / "include"),
             "-mllvm", "-inline-threshold=100000", "-Xclang", "-finclude-default-header",
             "-Xclang", "-target-cpu", "-Xclang", processor,
             "-Xclang", "-mlink-builtin-bitcode", "-Xclang", str(self.libclc / library),
             *(f"-D{name}={value}" for name, value in symbols.items()), "-S", text, "-o", out])


class Nvidia:
    """Registers a thread, bytes of stack and of local memory, and the share of a multiprocessor's
    threads that run at a time."""

    # Limits of a multiprocessor (CUDA C++ Programming Guide, table of technical specifications).
    LIMITS = {"sm_90": (64, 32, 233472), "sm_89": (48, 24, 102400)}

    def __init__(self, compiler, ptxas, architecture):
        self.compiler, self.ptxas, self.architecture = compiler, ptxas, architecture

    def measure(self, source, kernel, symbols, group, folder):
        ptx = f"{folder}/kernel.ptx"
        self.compiler.compile(source, symbols, "nvptx64-nvidia-nvcl", "sm_80",
                              "nvptx64--nvidiacl.bc", ptx)
        log = run([self.ptxas, "-v", f"-arch={self.architecture}", ptx, "-o", f"{folder}/code"])
        own = log[log.index(f"Compiling entry function '{kernel}'"):]
        number = lambda pattern: int((re.search(pattern, own) or [0, 0])[1])  # noqa: E731
        registers = number(r"Used (\d+) registers")
        stack = number(r"(\d+) bytes stack frame")
        spilled = number(r"(\d+) bytes spill stores")
        line = next(line for line in own.splitlines() if "Used" in line)
        local = int((re.search(r"(\d+) bytes smem", line) or [0, 0])[1])
        most_warps, most_groups, memory = self.LIMITS[self.architecture]
        warps = -(-group // 32)
        per_warp = -(-registers * 32 // 256) * 256
        groups = min(most_groups, most_warps // warps, 65536 // per_warp // warps,
                     memory // (local + 1024))
        return registers, stack, spilled, local, groups * warps / most_warps


class Amd:
    """The same, of a SIMD, as LLVM counts it."""

    MOST_WAVES = {"gfx1103": 16, "gfx90a": 8}

    def __init__(self, compiler, processor):
        self.compiler, self.processor = compiler, processor

    def measure(self, source, kernel, symbols, group, folder):
        assembly = pathlib.Path(folder, "kernel.s")
        self.compiler.compile(source, symbols, "amdgcn-mesa-mesa3d", self.processor,
                              "gfx906-amdgcn-mesa-mesa3d.bc", str(assembly))
        text = assembly.read_text()
        own = text[text.index(f"\n{kernel}:"):]
        end = own.index("; Kernel info")
        spilled = sum(map(int, re.findall(r"; (\d+)-byte Folded Spill", own[:end])))
        own = own[end:]
        number = lambda pattern: int(re.search(pattern, own)[1])  # noqa: E731
        return (number(r"; NumVgprs: (\d+)"), number(r"; ScratchSize: (\d+)"), spilled,
                number(r"; LDSByteSize: (\d+)"),
                number(r"; Occupancy: (\d+)") / self.MOST_WAVES[self.processor])


def rows(processors):
    with tempfile.TemporaryDirectory() as folder:
        for name, file, kernel, symbols, group in VARIANTS:
            yield name, [processor.measure(str(ROOT / "kernels" / file), kernel, symbols, group, folder)
                         for processor in processors]


def cell(measured):
    registers, stack, spilled, _, occupancy = measured
    more = f" + {stack} B" if stack else ""
    return f"{registers}{more}{f', {spilled} B spilled' if spilled else ''}; {occupancy:.0%}"


def table(titles, measured):
    lines = ["| kernel | local bytes | " + " | ".join(titles) + " |",
             "|---|--:|" + "--:|" * len(titles)]
    for name, cells in measured:
        lines.append(f"| {name} | {cells[0][3]:,} | " + " | ".join(map(cell, cells)) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--clang", default="clang-15")
    parser.add_argument("--libclc", default="/usr/lib/clc", help="folder of its .bc files")
    parser.add_argument("--ptxas", default="ptxas")
    parser.add_argument("--write", action="store_true", help="into docs/measured/registers.md")
    arguments = parser.parse_args()
    compiler = Compiler(arguments.clang, arguments.libclc)
    processors = {"H200 (sm_90)": Nvidia(compiler, arguments.ptxas, "sm_90"),
                  "RTX 4090 (sm_89)": Nvidia(compiler, arguments.ptxas, "sm_89"),
                  "Radeon 780M (gfx1103)": Amd(compiler, "gfx1103"),
                  "MI200 (gfx90a)": Amd(compiler, "gfx90a")}
    text = table(processors, rows(processors.values()))
    if arguments.write:
        replace_section(PAGE, "kernels/kernel_registers.py", text)
    else:
        print(text)


if __name__ == "__main__":
    main()
