"""Runs the cases of rows and takes their figures."""

import concurrent.futures
import subprocess
import time

import figures
import pbf_tools
import rows
import table


def run_of(case, number, start, given, folder):
    """The figures of one run, in their order, its device and its seconds. A run that has failed, as
    by the guard, has no figures: nan."""
    out = folder / f"{case.row}-{case.name}-{number}-{start}"
    begin = time.perf_counter()
    done = subprocess.run([given.pbf, "run", case.scene, *case.words(number, start, given.reduced),
                           "--backend", given.backend, "--threads", str(given.threads), "--quiet",
                           "--out", out], capture_output=True, text=True)
    seconds = time.perf_counter() - begin
    if done.returncode != 0:
        print(f"{case.row}/{case.name}, {case.settings[number]['name']}: {done.stderr}", flush=True)
        return [float("nan")] * len(case.figures), given.backend, seconds
    run = pbf_tools.open(out)
    found = [figures.value(run, f.source, seconds) for f in case.figures]
    for path in out.glob("*.vtkhdf"):
        path.unlink()
    return found, run.info["device"], seconds


def jobs_of(cases, given, old):
    """Case, setting and start of every run: first one of each setting, then those that repeat.
    Without the settings that the lines `old` have."""
    jobs = [(case, number, start) for case in cases
            for number in range(1 if given.reduced else len(case.settings))
            if not table.enough(old, case, number)
            for start in range(1 if given.reduced else case.starts[min(number, 1)])]
    return sorted(jobs, key=lambda job: job[2])


def all_of(chosen, given, folder, old=()):
    """The lines of the settings that have been run."""
    cases = [c for r in chosen for c in r.cases if c.reduced is not None or not given.reduced]
    found, end = {}, time.monotonic() + given.seconds

    def one(case, number, start):
        if time.monotonic() > end:
            print(f"left out: {case.row}/{case.name}/{number}, start {start}", flush=True)
            return
        result = run_of(case, number, start, given, folder)
        found.setdefault((case.row, case.name, number), []).append(result)
        print(f"{case.row}/{case.name}/{number}, start {start}: {result[2]:.1f} s", flush=True)

    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for job in [pool.submit(one, *job) for job in jobs_of(cases, given, old)]:
            job.result()
    defaults = rows.defaults_sha256()
    lines = []
    for case in cases:
        for number, setting in enumerate(case.settings):
            runs = found.get((case.row, case.name, number))
            if runs:
                scene = rows.scene_sha256(given.pbf, case, number)
                lines += table.lines_of(case, number, setting, runs, scene, defaults)
    return lines
