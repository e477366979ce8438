#!/usr/bin/env python3
"""gpu_check_test.py BUILD FOLDER: gpu_check.py over the emulated GPU of BUILD/emulated, half a
minute. Every check has to be made that needs no tool of NVIDIA's, what was found to be written when
it is cut off and to stay when it is run again, and what a budget leaves no time for to be
skipped."""
import glob
import json
import os
import subprocess
import sys

build, folder = sys.argv[1:]
check = [sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "gpu_check.py"),
         os.path.join(build, "emulated"), "--out", folder]


def rows():
    """Of the last run."""
    file = max(glob.glob(f"{folder}/*-gpu*.jsonl"), key=os.path.getmtime)
    return [json.loads(line) for line in open(file)][1:]


def expect(right, what):
    if not right:
        sys.exit(f"gpu_check_test.py: {what}")


os.makedirs(folder, exist_ok=True)
for old in glob.glob(f"{folder}/*-gpu*"):
    os.remove(old)
code = subprocess.run(check).returncode
found = rows()
expect(code == 0, f"exit code {code}")
missing = ("compute-sanitizer", "ncu")
expect(all(row["outcome"] == "passed" or any(tool in row["detail"] for tool in missing) for row
           in found),
       "a check was skipped that the emulated GPU can do")
(text,) = glob.glob(f"{folder}/*-gpu.md")
expect(all(f"{row['outcome']}: {row['check']}" in open(text).read() for row in found),
       "the text lacks a check")

expect(subprocess.run([*check, "--budget", "0"]).returncode == 0, "a spent budget is no failure")
expect([row["check"] for row in rows()] == [row["check"] for row in found], "checks are missing")
expect(all(row["detail"] == "no time left" for row in rows()), "something ran without time")

with subprocess.Popen(check, stdout=subprocess.PIPE, text=True) as cut:
    cut.stdout.readline()   # the first check is done
    cut.kill()
expect(len(glob.glob(f"{folder}/*-gpu*.md")) == 3, "a run has taken away what another had found")
expect(rows() and rows()[0] | {"seconds": 0} == found[0] | {"seconds": 0},
       "what was found before the end is lost")
