"""When, where and of which commit something was measured: what docs/figures.json and docs/blocks.json keep of it."""

import datetime
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]


def git(*arguments):
    done = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "a processor without a name"


def now():
    return {"machine": processor(), "commit": git("rev-parse", "--short", "HEAD"),
            "date": datetime.date.today().isoformat()}


def of_file(file):
    """Of what a bench has written: its own, or those of the change that brought it."""
    record = json.loads((ROOT / file).read_text(encoding="utf-8"))
    record = record if isinstance(record, dict) else {}
    machine = record.get("machine", {}).get("processor") or record.get("processor")
    if git("status", "--porcelain", "--", file):
        brought = now()
    else:
        commit, date = git("log", "-1", "--follow", "--diff-filter=AM", "--format=%h %cs", "--", file).split()
        brought = {"machine": "unknown", "commit": commit, "date": date}
    return {"machine": machine or brought["machine"],
            "commit": record.get("commit", brought["commit"]).removesuffix("-dirty"),
            "date": record.get("date", brought["date"])}
