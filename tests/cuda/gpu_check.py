#!/usr/bin/env python3
"""Everything that only a machine with an NVIDIA GPU can show: correctness against the CPU, interop, the sanitizers, errors,
then the benchmark. Writes one dated result, JSON and Markdown, to docs/results/.

    gpu_check.py BUILD [--out FOLDER] [--most N] [--only PARTS]

BUILD is a build folder, or what bundle.sh made of one; nothing else is needed but this checkout. Without a GPU each check
says "skipped: no CUDA device", and nothing is written unless --out names a folder. Exit code 1 when a check fails."""
import argparse
import datetime
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NO_DEVICE, NO_MEMORY = 6, 7   # exit codes of the program
SANITIZED = "Devices*:CudaVertices*:Recordings*"
METRICS = {
    "gpu__time_duration.sum": "time",
    "sm__throughput.avg.pct_of_peak_sustained_elapsed": "SM % of peak",
    "smsp__inst_executed_pipe_fma.avg.pct_of_peak_sustained_active": "FMA pipe % of peak",
    "l1tex__throughput.avg.pct_of_peak_sustained_active": "L1 % of peak",
    "lts__throughput.avg.pct_of_peak_sustained_elapsed": "L2 % of peak",
    "dram__throughput.avg.pct_of_peak_sustained_elapsed": "memory % of peak",
    "sm__warps_active.avg.pct_of_peak_sustained_active": "warps % of peak",
    "launch__registers_per_thread": "registers",
    "smsp__thread_inst_executed_per_inst_executed.ratio": "threads per instruction",
}


class Checks:
    def __init__(self, arguments):
        self.build = os.path.abspath(arguments.build)
        self.arguments = arguments
        self.rows = []          # {"name", "outcome": passed | failed | skipped, "detail"}
        self.environment = dict(os.environ, SPINDRIFT_CONFIGS=f"{ROOT}/configs", SPINDRIFT_SHADERS=f"{ROOT}/shaders",
                                OMP_WAIT_POLICY="passive")
        code, text = self.run(["cuda_sort_bench", "1000"], limit=120)
        if code not in (0, NO_DEVICE):
            sys.exit(f"gpu_check.py: the programs of {self.build} don't run here: {text.strip()}")
        self.gpu = code == 0

    def run(self, command, limit=600, wrapper=()):
        """Exit code and all output of a program of the build; code None when it took too long or isn't there."""
        line = [*wrapper, os.path.join(self.build, command[0]), *command[1:]]
        try:
            process = subprocess.Popen(line, env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                       cwd=ROOT, start_new_session=True)
        except OSError as error:
            return None, str(error)
        try:
            return (process.communicate(timeout=limit)[0], process.returncode)[::-1]
        except subprocess.TimeoutExpired:   # what a wrapper started must not go on beside the next check
            os.killpg(process.pid, signal.SIGKILL)
            return None, f"took more than {limit} s"

    def note(self, name, passed, detail=""):
        outcome = {True: "passed", False: "failed", None: "skipped"}[passed]
        self.rows.append({"name": name, "outcome": outcome, "detail": detail})
        print(f"{outcome:8}{name}{': ' + detail if detail else ''}", flush=True)

    def skip(self, name):
        self.note(name, None, "" if self.gpu else "no CUDA device")

    def tests(self, name, program, pattern):
        code, text = self.run([program, f"--gtest_filter={pattern}"])
        counts = {word: int(n) for word, n in re.findall(r"\[\s*(PASSED|SKIPPED|FAILED)\s*\] (\d+) tests?", text)}
        failed = re.findall(r"\[  FAILED  \] ([\w/.]+) \(", text)
        detail = f"{counts.get('PASSED', 0)} passed, {counts.get('SKIPPED', 0)} skipped" + (
            ", failed: " + " ".join(failed) if failed else "")
        if not self.gpu:
            return self.skip(name)
        self.note(name, code == 0 and counts.get("PASSED", 0) > 0, detail if code is not None else text)

    def sanitizer(self, tool, program, *rest):
        name = f"compute-sanitizer {tool}, {program} {rest[0] if rest else ''}".strip()
        if not self.gpu:
            return self.skip(name)
        if not shutil.which("compute-sanitizer"):
            return self.note(name, None, "no compute-sanitizer on this machine")
        code, text = self.run([program, *rest], wrapper=["compute-sanitizer", "--tool", tool, "--error-exitcode", "9",
                                                         # recordings that no longer fit are an error of an API call
                                                         *(["--report-api-errors", "no"] if tool == "memcheck" else [])])
        lines = [l for l in text.splitlines() if "=========" in l]
        self.note(name, code == 0, lines[-1].strip("= ") if lines else text[-200:])

    def expect_exit(self, name, command, wanted):
        if not self.gpu:
            return self.skip(name)
        code, text = self.run(command)
        self.note(name, code == wanted, text.strip().splitlines()[-1] if text.strip() else f"exit code {code}")

    def pictures(self):
        """A snapshot of the GPU's run through EGL beside the CPU's: the same but for rounding."""
        name = "snapshot of the GPU's run equals the CPU's"
        if not self.gpu:
            return self.skip(name)
        with tempfile.TemporaryDirectory() as folder:
            for backend in ("cpu", "cuda"):
                code, text = self.run(["spindrift", "test/dam_break_small", "--headless", "--backend", backend, "--steps",
                                       "100", "--screenshot", f"{folder}/{backend}.png", "--set", "view.range=fixed"])
                if code != 0:
                    return self.note(name, False, text[-200:])
            way = "copied" if "copied through the host" in text else "written in place"
            code, text = self.run(["spindrift", "compare", f"{folder}/cpu.png", f"{folder}/cuda.png", "--min-ssim", "0.98"])
            self.note(name, code == 0, f"vertices {way}; {' '.join(text.split())}")

    def bench(self):
        if not self.gpu or self.arguments.most < 50_000:
            self.skip("benchmark")
            return [], []
        with tempfile.TemporaryDirectory() as folder:
            file = f"{folder}/bench.json"
            code, text = self.run(["spindrift", "bench", "--gpu", "--json", file, "--most", str(self.arguments.most)])
            print(text)
            rows = json.load(open(file)) if code == 0 else []
        self.note("benchmark", code == 0, "" if code == 0 else text[-300:])
        code, text = self.run(["cuda_sort_bench"])
        sorts = [json.loads(line) for line in text.splitlines() if line.startswith("{")]
        self.note("counting sort equals radix sort", code == 0, f"{len(sorts)} sizes")
        return rows, sorts

    def profile(self):
        """What bounds the two hot kernels, by ncu, at a million particles."""
        name = "ncu"
        if not self.gpu:
            self.skip(name)
            return []
        if not shutil.which("ncu"):
            self.note(name, None, "no ncu on this machine")
            return []
        wrapper = ["ncu", "--clock-control", "none", "--cache-control", "none", "--csv", "--page", "raw", "-k", "regex:runPass", "--launch-skip", "60",
                   "--launch-count", "40", "--metrics", ",".join(METRICS)]
        code, text = self.run(["spindrift", "explain", "dam_break", "--backend", "cuda", "--steps", "8", "--set",
                               "simulation.spacing=0.00545"], wrapper=wrapper)
        rows = {}
        lines = [l for l in text.splitlines() if l.startswith('"')]
        if len(lines) < 3:
            self.note(name, False, text[-300:])
            return []
        import csv
        header, units, *data = list(csv.reader(lines))
        for line in data:
            kernel = re.search(r"(Compute\w+|Extrapolate\w+|Integrate|Reorder|FindCell|\w*InCell|CountCells)",
                               line[header.index("Kernel Name")])
            if kernel:
                rows[kernel.group(1)] = {label: line[header.index(metric)] + " " + units[header.index(metric)]
                                         for metric, label in METRICS.items() if metric in header}
        self.note(name, bool(rows), f"{len(rows)} kernels")
        return [{"kernel": k, **v} for k, v in rows.items()]


def first_line(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, cwd=ROOT).stdout.strip().splitlines()[0]
    except (OSError, IndexError):
        return "unknown"


def commit_of(build):
    """Of the sources that a bundle was built from, else of this checkout."""
    known = os.path.join(build, "commit")
    return first_line(["cat", known] if os.path.exists(known) else ["git", "describe", "--always", "--dirty"])


def table(rows):
    if not rows:
        return "none\n"
    columns = list(dict.fromkeys(key for row in rows for key in row))
    cell = lambda value: f"{value:.4g}" if isinstance(value, float) else str(value)
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    lines += ["| " + " | ".join(cell(row.get(c, "")) for c in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--out", help="folder of the result; docs/results when there is a GPU")
    parser.add_argument("--most", type=int, default=100_000_000, help="largest number of particles to time")
    parser.add_argument("--only", default="tests,errors,sanitizers,bench,profile",
                        help="parts, where the time is short: tests, errors, sanitizers, bench, profile")
    arguments = parser.parse_args()
    if not glob.glob(os.path.join(arguments.build, "cuda_tests")):
        sys.exit(f"gpu_check.py: {arguments.build}: no cuda_tests there; build with CUDA, or name a build folder")
    checks = Checks(arguments)

    parts = arguments.only.split(",")
    bench, sorts, kernels = [], [], []
    if "tests" in parts:
        run_tests(checks)
    if "errors" in parts:
        run_errors(checks)
    if "sanitizers" in parts:
        for tool in ("memcheck", "racecheck", "initcheck"):
            checks.sanitizer(tool, "cuda_tests", f"--gtest_filter={SANITIZED}")
            checks.sanitizer(tool, "spindrift", "test/ball_drop_small", "--headless", "--backend", "cuda", "--steps", "20")
    write(checks, arguments, bench, sorts, kernels)   # what is known so far, should the rest take too long
    if "bench" in parts:
        bench, sorts = checks.bench()
        write(checks, arguments, bench, sorts, kernels)
    if "profile" in parts:
        kernels = checks.profile()
    name = write(checks, arguments, bench, sorts, kernels)
    if name:
        print(f"{name}.md")
    failed = [row for row in checks.rows if row["outcome"] == "failed"]
    print(f"{len(checks.rows) - len(failed)} passed or skipped, {len(failed)} failed")
    sys.exit(1 if failed else 0)


def run_tests(checks):
    checks.tests("passes against the sum over all pairs", "unit_tests", "*Neighbours*:NeighbourLists*:Conservation*")
    checks.tests("loops, sums, bins, sort on the device", "cuda_tests", "Devices*:CudaVertices*")
    checks.tests("GPU against CPU, two runs, switching, recordings", "cuda_tests", "*Backends*:Switching*:Recordings*")
    checks.tests("memory", "cuda_tests", "Gpu.*")
    checks.tests("interop: pictures pixel for pixel", "cuda_tests", "Interop*")
    checks.pictures()


def run_errors(checks):
    checks.expect_exit("out of memory is one line and its exit code",
                       ["spindrift", "--headless", "--backend", "cuda", "--set", "domain.max=[30,30,30]", "--set",
                        "simulation.spacing=0.0299", "--set", "walls.kind=reflect", "--set", "fluid.bodies[0].max=[30,30,30]"],
                       NO_MEMORY)
    checks.expect_exit("a device that isn't there is one line and its exit code",
                       ["spindrift", "--headless", "--backend", "cuda", "--device", "63"], NO_DEVICE)


def write(checks, arguments, bench, sorts, kernels):
    result = {
        "date": datetime.date.today().isoformat(),
        "commit": commit_of(checks.build),
        "gpu": first_line(["nvidia-smi", "--query-gpu=name,memory.total", "--format=csv,noheader"]),
        "driver": first_line(["nvidia-smi", "--query-gpu=driver_version", "--format=csv,noheader"]),
        "checks": checks.rows, "bench": bench, "sort": sorts, "kernels": kernels,
    }
    folder = arguments.out or (f"{ROOT}/docs/results" if checks.gpu else None)
    if folder:
        os.makedirs(folder, exist_ok=True)
        name = os.path.join(folder, f"{result['date']}-gpu")
        with open(name + ".json", "w") as file:
            json.dump(result, file, indent=1)
        flat = [{**row, "ms_per_pass": " ".join(f"{k} {v:.3f}" for k, v in row.get("ms_per_pass", {}).items())}
                for row in bench]
        with open(name + ".md", "w") as file:
            file.write(f"# GPU check, {result['date']}\n\n{result['gpu']}, driver {result['driver']}, commit {result['commit']}."
                       f" Made by `make gpu-check`.\n\n## Checks\n\n{table(checks.rows)}\n## Steps\n\n{table(flat)}\n"
                       f"## Sort\n\n{table(sorts)}\n## Kernels (ncu, a million particles)\n\n{table(kernels)}")
        return name
    return None


main()
