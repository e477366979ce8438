#!/usr/bin/env python3
"""What only a machine with an NVIDIA GPU can show, the most telling first: what the card is, one
step against the CPU, the same bits twice, recordings, times, the sanitizers, what bounds the hot
kernels, pictures.

    gpu_check.py BUILD [--out FOLDER] [--budget SECONDS] [--most N] [--only PARTS]

BUILD is a build folder, or what bundle.sh made of one; nothing else is needed but this checkout.
Each result is appended to a dated file in docs/results/ (.md to read, .jsonl with all figures) as
soon as it is there, so that a run that is cut off has told what it found. When the budget is spent
the rest is skipped. Without a GPU all is skipped, and nothing is written unless --out names a
folder. BUILD/emulated, the emulated GPU, takes small scenes. Exit code 1 when a check fails."""
import argparse
import csv
import datetime
import itertools
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
NO_DEVICE = 6   # exit code of the program
NVIDIA_EGL = '{"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nvidia.so.0"}}'
STALLS = ("long_scoreboard", "short_scoreboard", "lg_throttle", "math_pipe_throttle", "wait",
          "not_selected")
METRICS = {
    "gpu__time_duration.sum": "time",
    "sm__throughput.avg.pct_of_peak_sustained_elapsed": "SM %",
    "smsp__inst_executed_pipe_fma.avg.pct_of_peak_sustained_active": "FMA %",
    "l1tex__throughput.avg.pct_of_peak_sustained_active": "L1 %",
    "l1tex__t_sector_hit_rate.pct": "L1 hits",
    "lts__throughput.avg.pct_of_peak_sustained_elapsed": "L2 %",
    "dram__throughput.avg.pct_of_peak_sustained_elapsed": "memory %",
    "sm__warps_active.avg.pct_of_peak_sustained_active": "warps %",
    "launch__registers_per_thread": "registers",
    **{f"smsp__average_warps_issue_stalled_{s}_per_issue_active.ratio": f"stalled: {s}" for s
       in STALLS},
}


class Skipped(Exception):
    pass


class Checks:
    """Each check returns what there is to say of it, and figures as rows of a table; an Error
    fails it."""

    class Error(Exception):
        pass

    def __init__(self, arguments):
        self.build, self.most = os.path.abspath(arguments.build), arguments.most
        self.end = time.monotonic() + arguments.budget
        self.environment = dict(os.environ, SPINDRIFT_CONFIGS=f"{ROOT}/configs",
                                SPINDRIFT_SHADERS=f"{ROOT}/shaders",
                                OMP_WAIT_POLICY="passive")
        code, text = self.start(["cuda_sort_bench", "1000"], 60)
        if code not in (0, NO_DEVICE):
            sys.exit(f"gpu_check.py: the programs of {self.build} don't run here: {text.strip()}")
        self.gpu = code == 0
        self.device = self.name_of_device() if self.gpu else ""
        self.emulated = self.device.startswith("emulated")

    def left(self):
        return self.end - time.monotonic()

    def start(self, command, limit, wrapper=(), **environment):
        """Exit code and all output of a program of the build; code None when it took too long or
        isn't there."""
        line = [*wrapper, os.path.join(self.build, command[0]), *command[1:]]
        try:
            process = subprocess.Popen(line, env=dict(self.environment, **environment),
                                       stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, text=True, cwd=ROOT,
                                       start_new_session=True)
        except OSError as error:
            return None, str(error)
        try:
            return (process.communicate(timeout=limit)[0], process.returncode)[::-1]
        except subprocess.TimeoutExpired:
            # What a wrapper started must not go on beside the next check.
            os.killpg(process.pid, signal.SIGKILL)
            return None, ""

    def within(self, limit, command, **how):
        """As start(). What the budget cuts off is skipped; what hangs or isn't there fails."""
        given = min(limit, max(self.left(), 1))
        code, text = self.start(command, given, **how)
        if code is None and not text and given < limit:
            raise Skipped(f"not done after {given:.0f} s")
        if code is None:
            raise Checks.Error(text or f"not done after {given:.0f} s")
        return code, text

    def run(self, command, limit=120, wanted=0, **how):
        code, text = self.within(limit, command, **how)
        if code != wanted:
            raise Checks.Error(f"exit code {code}: {text.strip()[-300:]}")
        return text

    def tests(self, pattern, emulated=None, program="cuda_tests", **environment):
        """Tests by their pattern, those that the emulated GPU has time for."""
        pattern = emulated if self.emulated and emulated else pattern
        code, text = self.within(180, [program, f"--gtest_filter={pattern}"], **environment)
        counts = {word: int(n) for word, n
                  in re.findall(r"\[\s*(PASSED|SKIPPED|FAILED)\s*\] (\d+) tests?", text)}
        failed = re.findall(r"\[  FAILED  \] ([\w/.]+) \(", text)
        if code != 0 or counts.get("PASSED", 0) == 0:
            raise Checks.Error("failed: " + " ".join(failed) if failed else text.strip()[-300:])
        gl = re.search(r"^OpenGL: (.*)$", text, re.MULTILINE)
        drawn_by = ", " + gl.group(1) if gl else ""
        return f"{counts['PASSED']} passed, {counts.get('SKIPPED', 0)} skipped{drawn_by}", []

    # --- what the card is ---

    def name_of_device(self):
        _, text = self.start(["spindrift", "test/ball_drop_small", "--headless", "--backend",
                              "cuda", "--steps", "20"], 60)
        said = re.search(r"^device +(.*)$", text, re.MULTILINE)
        return said.group(1) if said else text.strip()[-300:]

    def identity(self):
        if not self.device.endswith("CUDA, float"):
            raise Checks.Error(self.device)
        asked = ["nvidia-smi", "--query-gpu=name,memory.total,driver_version,clocks.max.sm",
                 "--format=csv,noheader"]
        return f"{self.device}; {first_line(asked)}", []

    def ceilings(self):
        lines = self.run(["cuda_sort_bench", "ceilings", *(["1000"] if self.emulated else [])])
        return "", rows_of(lines)

    # --- one step, times ---

    def large(self, particles):
        if particles > self.most:
            raise Skipped("--most")
        return self.tests("LargeScene.*", SPINDRIFT_PARTICLES=str(particles))

    def missing_device(self):
        text = self.run(["spindrift", "--headless", "--backend", "cuda", "--device", "63"],
                        wanted=NO_DEVICE)
        return text.strip().splitlines()[-1], []

    def bench(self, *choice):
        with tempfile.TemporaryDirectory() as folder:
            file = f"{folder}/bench.json"
            self.run(["spindrift", "bench", "--gpu", "--json", file, *choice], limit=240)
            rows = json.load(open(file))
        for row in rows:
            row["ms_per_pass"] = " ".join(f"{k} {v:.3f}" for k, v
                                          in row.get("ms_per_pass", {}).items())
        return "events and the clock", rows

    def sorts(self):
        rows = rows_of(self.run(["cuda_sort_bench", *(["1000"] if self.emulated else [])]))
        if not all(row["same"] for row in rows):
            raise Checks.Error("the counting sort's order is not the radix sort's")
        return "counting sort equals radix sort", rows

    # --- tools ---

    def sanitizer(self, tool):
        if not shutil.which("compute-sanitizer"):
            raise Skipped("no compute-sanitizer on this machine")
        wrapper = ["compute-sanitizer", "--tool", tool, "--error-exitcode", "9",
                   # recordings that no longer fit are an error of an API call
                   *(["--report-api-errors", "no"] if tool == "memcheck" else [])]
        text = self.run(["spindrift", "test/ball_drop_small", "--headless", "--backend", "cuda",
                         "--steps", "8"], limit=45,
                        wrapper=wrapper)
        return [l for l in text.splitlines() if "=========" in l][-1].strip("= "), []

    def profile(self):
        if not shutil.which("ncu"):
            raise Skipped("no ncu on this machine")
        wrapper = ["ncu", "--clock-control", "none", "--csv", "--page", "raw",
                   "--kernel-name-base", "demangled", "-k",
                   "regex:Compute(Density|Forces)", "--launch-skip", "8", "--launch-count", "2",
                   "--metrics", ",".join(METRICS)]
        text = self.run(["spindrift", "dam_break", "--headless", "--backend", "cuda", "--steps",
                         "8", "--set",
                         "simulation.formulation=wcsph", "--set", "simulation.spacing=0.00545"],
                        wrapper=wrapper)
        table = list(csv.reader(l for l in text.splitlines() if l.startswith('"')))
        if len(table) < 3:
            raise Checks.Error(text.strip()[-300:])
        header, units, *kernels = table
        rows = []
        for line in kernels:
            name = re.search(r"Compute\w+", line[header.index("Kernel Name")]).group(0)
            rows.append({"kernel": name,
                         **{label: f"{line[header.index(m)]} {units[header.index(m)]}".strip()
                                            for m, label in METRICS.items() if m in header}})
        return "", rows

    # --- pictures ---

    def find_egl(self):
        """Containers lack the file that tells OpenGL of NVIDIA's library; without it Mesa draws, on
        the CPU."""
        known = "/usr/share/glvnd/egl_vendor.d/10_nvidia.json"
        if self.emulated or "__EGL_VENDOR_LIBRARY_FILENAMES" in os.environ:
            return
        if not os.path.exists(known):
            known = os.path.join(tempfile.mkdtemp(), "10_nvidia.json")
            with open(known, "w") as file:
                file.write(NVIDIA_EGL)
        mesa = "/usr/share/glvnd/egl_vendor.d/50_mesa.json"
        self.environment["__EGL_VENDOR_LIBRARY_FILENAMES"] = f"{known}:{mesa}"

    def interop(self):
        self.find_egl()
        return self.tests("Interop*")

    def pictures(self):
        """The GPU's run drawn beside the CPU's: the same but for rounding."""
        with tempfile.TemporaryDirectory() as folder:
            for backend in ("cpu", "cuda"):
                text = self.run(["spindrift", "test/dam_break_small", "--headless", "--backend",
                                 backend, "--steps", "100",
                                 "--screenshot", f"{folder}/{backend}.png", "--set",
                                 "view.range=fixed"])
            way = "copied" if "copied through the host" in text else "written in place"
            same = self.run(["spindrift", "compare", f"{folder}/cpu.png", f"{folder}/cuda.png",
                             "--min-ssim", "0.98"])
        return f"vertices {way}; {' '.join(same.split())}", []


def few(test):
    """Of the emulated GPU's scenes: plain, solved pressures, carried densities, solids, elastic
    objects, sources."""
    return ":".join(f"Scenes/Backends.{test}*/{k}" for k in (0, 3, 12, 15, 20, 21))


def checks_of(c):
    """(part, what is shown, seconds that it should have, how), the most telling first."""
    return [
        ("identity", "the device", 1, c.identity),
        ("identity", "ceilings", 5, c.ceilings),
        ("identity", "loops, sums, bins, sort", 5,
         lambda: c.tests("Devices*:CudaVertices*:CudaRecordings*")),
        ("step", "one step against the CPU, all scenes", 10,
         lambda: c.tests("*Backends.OneStep*:Integrators*:SolvedPressures*", few("OneStep"))),
        ("step", "neighbours against the sum over all pairs", 10,
         lambda: c.tests("*Neighbours*:NeighbourLists*:Conservation*", "*Neighbours*",
                         "unit_tests")),
        *[("step", f"one step against the CPU, {name} particles", seconds,
           lambda count=count: c.large(count))
          for name, count, seconds in (("20 thousand", 20_000, 5), ("a million", 1_000_000, 20),
                                       ("ten million", 10_000_000, 60))
          if count <= 20_000 or not c.emulated],
        ("bits", "the same bits twice", 10, lambda: c.tests("*Backends.TwoRuns*", few("TwoRuns"))),
        ("recordings", "recordings, hold, stir, switching", 10,
         lambda: c.tests("Recordings*:Switching*:GravityRamp*:LocalSteps*",
                         "Recordings.Never*:Switching*:GravityRamp*:LocalSteps*")),
        ("recordings", "sums after many steps", 20,
         lambda: c.tests("*Backends.SumsAgree*", "Scenes/Backends.SumsAgree*/3")),
        ("errors", "memory, and when it runs out on the card", 10,
         lambda: c.tests("Gpu.*", "Gpu.MemoryThatRunsOut*")),
        ("errors", "a device that isn't there is one line and its exit code", 2, c.missing_device),
        ("bench", "sorts", 5, c.sorts),
        *([] if c.emulated else [
            ("bench", "steps, to a million particles", 30,
             lambda: c.bench("--most", str(min(c.most, 1_000_000)))),
            ("bench", "steps of ten million", 60,
             lambda: c.bench("--only", "10000k", "--most", "10000000"))]),
        *[("sanitizers", tool, 10, lambda tool=tool: c.sanitizer(tool))
          for tool in ("memcheck", "synccheck", "racecheck", "initcheck")],
        ("profile", "what bounds the hottest kernels, a million particles (ncu)", 20, c.profile),
        ("pictures", "interop: pictures pixel for pixel", 5, c.interop),
        ("pictures", "a snapshot equals the CPU's", 5, c.pictures),
    ]


class Report:
    """Written line by line, so that what is known stays known."""

    def __init__(self, folder, checks):
        self.files, self.outcomes = [], []
        if not folder:
            return
        os.makedirs(folder, exist_ok=True)
        date = datetime.date.today().isoformat()
        first = self.name = os.path.join(folder, f"{date}-gpu")
        for again in itertools.count(2):   # what was found before stays
            if not os.path.exists(f"{self.name}.jsonl"):
                break
            self.name = f"{first}-{again}"
        self.files = [open(f"{self.name}.{kind}", "w") for kind in ("jsonl", "md")]
        commit = commit_of(checks.build)
        self.append({"date": date, "commit": commit, "device": checks.device},
                    f"# GPU check, {date}\n\n{checks.device}, commit {commit}. "
                    "Made by `make gpu-check`.\n\n")

    def append(self, row, text):
        for file, line in zip(self.files, (json.dumps(row) + "\n", text)):
            file.write(line)
            file.flush()
            os.fsync(file.fileno())

    def note(self, name, outcome, detail, figures, seconds):
        self.outcomes.append(outcome)
        self.append({"check": name, "outcome": outcome, "detail": detail,
                     "seconds": round(seconds, 1), "figures": figures},
                    f"- {outcome}: {name}" + ("; " + " ".join(detail.split()) if detail else "")
                    + "\n" + table(figures))
        print(f"{outcome:8}{name}{': ' + detail if detail else ''} ({seconds:.0f} s)", flush=True)


def first_line(command):
    try:
        return subprocess.run(command, capture_output=True, text=True,
                              cwd=ROOT).stdout.strip().splitlines()[0]
    except (OSError, IndexError):
        return f"no {command[0]}"


def rows_of(text):
    return [json.loads(line) for line in text.splitlines() if line.startswith("{")]


def commit_of(build):
    """Of the sources that a bundle was built from, else of this checkout."""
    known = os.path.join(build, "commit")
    return first_line(["cat", known] if os.path.exists(known)
                      else ["git", "describe", "--always", "--dirty"])


def table(rows):
    if not rows:
        return ""
    columns = list(dict.fromkeys(key for row in rows for key in row))
    cell = lambda value: f"{value:.4g}" if isinstance(value, float) else str(value)
    lines = ["", "| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    lines += ["| " + " | ".join(cell(row.get(c, "")) for c in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--out", help="folder of the result; docs/results when there is a GPU")
    parser.add_argument("--budget", type=float, default=540, help="seconds, for all of it (540)")
    parser.add_argument("--most", type=int, default=10_000_000, help="largest number of particles")
    parser.add_argument("--only",
                        help="parts: identity, step, bits, recordings, errors, bench, sanitizers, "
                             "profile, pictures")
    arguments = parser.parse_args()
    if not os.path.exists(os.path.join(arguments.build, "cuda_tests")):
        sys.exit(f"gpu_check.py: {arguments.build}: no cuda_tests there; build with CUDA, or name "
                 "a build folder")
    checks = Checks(arguments)
    parts = arguments.only.split(",") if arguments.only else None
    report = Report(arguments.out or (f"{ROOT}/docs/results" if checks.gpu and not checks.emulated
                                      else None), checks)
    for part, name, seconds, check in checks_of(checks):
        begin, figures = time.monotonic(), []
        try:
            if not checks.gpu:
                raise Skipped("no CUDA device")
            if parts and part not in parts:
                raise Skipped("--only")
            if checks.left() < seconds:
                raise Skipped("no time left")
            detail, figures = check()
            outcome = "passed"
        except Skipped as why:
            outcome, detail = "skipped", str(why)
        except (Checks.Error, OSError, ValueError, LookupError,
                AttributeError) as why:   # the other checks go on
            outcome, detail = "failed", str(why)
        report.note(name, outcome, detail, figures, time.monotonic() - begin)
    if report.files:
        print(f"{report.name}.md")
    counts = {word: report.outcomes.count(word) for word in ("passed", "skipped", "failed")}
    print(", ".join(f"{n} {word}" for word, n in counts.items()))
    sys.exit(1 if counts["failed"] else 0)


main()
