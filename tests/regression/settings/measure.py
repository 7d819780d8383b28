"""Runs the cases of rows and takes their figures."""

import concurrent.futures
import subprocess
import time

import figures
import pbf_tools
import rows
import table

GUARD = 3  # exit code of pbf


def run_of(case, number, start, given, folder):
    """The figures of one run, in their order, its device and its seconds. In place of the figures of a
    run that has failed stands the reason: a text."""
    out = folder / f"{case.row}-{case.name}-{number}-{start}"
    begin = time.perf_counter()
    done = subprocess.run([given.pbf, "run", case.scene, *case.words(number, start, given.reduced),
                           "--backend", given.backend, "--threads", str(given.threads), "--quiet",
                           "--out", out], capture_output=True, text=True)
    seconds = time.perf_counter() - begin
    if done.returncode != 0:
        print(f"{case.row}/{case.name}, {case.settings[number]['name']}: {done.stderr}", flush=True)
        return reason(done.returncode, done.stderr), device_of(out), seconds
    run = pbf_tools.open(out)
    found = [figures.value(run, f.source, seconds) for f in case.figures]
    for path in out.glob("*.vtkhdf"):
        path.unlink()
    return found, run.info["device"], seconds


def reason(code, message):
    """Why a run has failed, in a few words."""
    if code == GUARD:
        return "stopped by the guard"
    last = message.strip().splitlines()[-1] if message.strip() else "no message"
    return f"failed with {code}: {last.removeprefix('pbf: error: ').split(';')[0][:80]}"


def device_of(out):
    """Of a run that was stopped, as far as it is known."""
    try:
        return pbf_tools.open(out).info["device"]
    except (pbf_tools.ToolError, KeyError, OSError):
        return ""


def jobs_of(cases, given, old):
    """Case, setting and start of every run: first one of each setting, then those that repeat.
    Without the settings that the lines `old` have."""
    jobs = [(case, number, start) for case in cases
            for number in range(1 if given.reduced else len(case.settings))
            if not table.enough(old, case, number)
            for start in range(1 if given.reduced else case.starts[min(number, 1)])]
    return sorted(jobs, key=lambda job: job[2])


def all_of(chosen, given, folder, old=()):
    """The lines of the settings that have been run, and how many runs were left out. Scenes are hashed
    before the first run, as they are read then."""
    cases = [c for r in chosen for c in r.cases if c.reduced is not None or not given.reduced]
    jobs, defaults = jobs_of(cases, given, old), rows.defaults_sha256()
    scenes = {(case.row, case.name, number): rows.scene_sha256(given.pbf, case, number)
              for case, number, _ in jobs}
    found, left_out, end = {}, [], time.monotonic() + given.seconds

    def one(case, number, start):
        if time.monotonic() >= end:
            left_out.append(case)
            print(f"left out: {case.row}/{case.name}/{number}, start {start}", flush=True)
            return
        result = run_of(case, number, start, given, folder)
        found.setdefault((case.row, case.name, number), []).append(result)
        print(f"{case.row}/{case.name}/{number}, start {start}: {result[2]:.1f} s", flush=True)

    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for job in [pool.submit(one, *job) for job in jobs]:
            job.result()
    lines = []
    for case in cases:
        for number, setting in enumerate(case.settings):
            key = case.row, case.name, number
            if key in found:
                lines += table.lines_of(case, number, setting, found[key], scenes[key], defaults)
    return lines, len(left_out)
