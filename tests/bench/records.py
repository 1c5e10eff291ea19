"""Rows as benches write them, and scripts of bench/ on files of such rows."""

import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))


def timing(*samples):
    return {"median": sorted(samples)[len(samples) // 2], "min": min(samples), "max": max(samples),
            "samples": list(samples)}


def knn_row(structure, *samples, photons=1_000_000, queries=100, k=50, **more):
    """A row of the plane, whose rounds took so many seconds."""
    return {"workload": "plane", "structure": structure, "photons": photons, "k": k, "queries": queries,
            "seconds": timing(*samples), **more}


def run_on(script, *contents):
    """A script on files of these contents, in their order: text, or what becomes JSON."""
    with tempfile.TemporaryDirectory() as folder:
        files = []
        for content in contents:
            files.append(pathlib.Path(folder, f"{len(files)}.json"))
            files[-1].write_text(content if isinstance(content, str) else json.dumps(content))
        return subprocess.run([sys.executable, ROOT / "bench" / script, *files], capture_output=True, text=True)


def check_refusal(test, script, *contents):
    """It is one line, and the exit code tells, too."""
    result = run_on(script, *contents)
    test.assertNotEqual(result.returncode, 0)
    test.assertRegex(result.stderr, rf"\A{script.rpartition('/')[2]}: error: .*\n\Z")
