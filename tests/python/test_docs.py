"""What the documents show works: doctests, the example, the pages, --help, tools/figures."""

import doctest
import importlib
import os
import pkgutil
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT, drawn
from matplotlib.image import imread

import pbf_tools
from pbf_tools.__main__ import COMMANDS

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT / "tools"), "PYTHONDONTWRITEBYTECODE": "1",
               "PYTHON": sys.executable, "PBF": os.path.abspath(os.environ["PBF_BINARY"])}
FOLDERS = (".github", "app", "configs", "kernels", "lib", "tests", "tools")
PAGES = [ROOT / "README.md", *(p for f in FOLDERS for p in sorted((ROOT / f).rglob("*.md")))]


def test_the_examples_in_docstrings_hold(minimal, tmp_path, monkeypatch):
    shutil.copy(minimal, tmp_path / "run.vtkhdf")
    monkeypatch.chdir(tmp_path)
    tried = 0
    for module in pkgutil.iter_modules(pbf_tools.__path__, "pbf_tools."):
        result = doctest.testmod(importlib.import_module(module.name))
        assert result.failed == 0, module.name
        tried += result.attempted
    assert tried > 20


def test_every_command_explains_itself_with_an_example(tools):
    for command in COMMANDS:
        code, out, _ = tools(command, "--help")
        assert code == 0 and f"python -m pbf_tools {command} " in out
    code, out, _ = tools("--help")
    assert code == 0 and "Example:" in out and all(c in out for c in COMMANDS)


def test_every_option_of_the_program_that_the_commands_name_is_there(tools, pbf):
    said = 0
    for command in COMMANDS:
        text = re.sub(r"\s+", " ", tools(command, "--help")[1])
        for name, words in re.findall(r"(?<!-m )\bpbf (bench|study|stability|run|compare|render|plan)"
                                      r"((?: +(?:--[a-z-]+|[\w/.,:]+))*)", text):
            shown = subprocess.run([pbf, name, "--help"], capture_output=True, text=True).stdout
            for option in re.findall(r"--[a-z-]+", words):
                said += 1
                assert re.search(rf"^ +(-\w,)?{option}\b", shown, re.MULTILINE), \
                    f"{command} names pbf {name} {option}"
    assert said > 3


def run_python(arguments, folder):
    done = subprocess.run([sys.executable, *arguments], cwd=folder, env=ENVIRONMENT,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def demo(pbf, tmp_path):
    """A folder with out/demo/run.vtkhdf, as after tools/demo, but coarser and without pictures."""
    subprocess.run([pbf, "run", ROOT / "configs/demo.yaml", "--set", "fluid.spacing=0.025",
                    "--set", "render=off", "--set", "time.end=0.6",
                    "--quiet", "--out", tmp_path / "out/demo"], check=True, capture_output=True)
    return tmp_path


def test_the_example_script_runs(demo):
    out = run_python([ROOT / "tools/example.py"], demo)
    assert "6144 particles" in out and re.search(r"energy: \d+\.?\d* J at the start", out)


def test_the_tutorial_runs_and_draws_its_figure(tmp_path):
    environment = {**ENVIRONMENT, "TUTORIAL_SPACING": "0.05", "TUTORIAL_OUT": "t",
                   "MPLBACKEND": "Agg"}
    script = ROOT / "tools/tutorial.py"
    done = subprocess.run([sys.executable, script], cwd=tmp_path, env=environment, text=True,
                          capture_output=True)
    assert done.returncode == 0, done.stderr
    assert "12 runs" in done.stdout and re.search(r"least error below .* iterations", done.stdout)
    picture = imread(tmp_path / "t/error_against_time.png")
    assert picture.shape[1] > 600 and picture[..., :3].std() > 0.02  # not blank
    assert script.read_text().count("# %%") >= 5
    run_again = subprocess.run([sys.executable, script], cwd=tmp_path, env=environment, text=True,
                               capture_output=True)  # goes on, as a cell that is run again
    assert run_again.returncode == 0, run_again.stderr


def test_the_pages_python_examples_run(demo):
    blocks = [b for page in PAGES
              for b in re.findall(r"```python\n(.*?)```", page.read_text(), re.DOTALL)]
    assert len(blocks) >= 2 and any("pbf_tools.open" in b for b in blocks)
    assert any("import h5py" in b for b in blocks)
    for block in blocks:
        assert run_python(["-c", block], demo).strip()


def test_the_tutorial_of_the_python_tools_runs_in_its_order(demo, pictures):
    for folder in ("frames", "density"):  # what needs OpenGL
        shutil.copytree(pictures / "frames", demo / "out/demo" / folder)
    page = (ROOT / "tools/README.md").read_text().partition("## Reading run files")[0]
    done = []
    for kind, block in re.findall(r"```(\w*)\n(.*?)```", page, re.DOTALL):
        if kind == "python":
            assert run_python(["-c", block], demo).strip()
        for line in block.splitlines() if not kind else ():
            if line.startswith("python -m pbf_tools "):
                run_python(line.split()[1:], demo)
                done += line.split()[3:4]
    assert {"plot-log", "plot-energy", "video", "plot-batch"} <= set(done)
    for name in ("force", "energy", "sweep", "iterations"):
        assert drawn(demo / f"{name}.png"), name
    assert all((demo / f"{name}.gif").exists() for name in ("demo", "slow", "density"))


def test_the_page_of_the_python_tools_lists_every_command():
    page = (ROOT / "tools/README.md").read_text().partition("## Commands")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| (`[^|]*) \|", page, re.MULTILINE)
    assert sorted(re.findall(r"`([\w-]+)`", " ".join(rows))) == sorted(COMMANDS)


def test_the_figures_of_speed_are_drawn_again_from_committed_times(tmp_path):
    done = subprocess.run([ROOT / "tools/figures", "--from-data", "--out", tmp_path], text=True,
                          env=ENVIRONMENT, capture_output=True)
    assert done.returncode == 0, done.stderr
    page = (ROOT / "tests/regression/bench/README.md").read_text()
    for name in ("reference_speedup", "reference_stages"):
        committed = imread(ROOT / f".github/{name}.png")
        assert abs(imread(tmp_path / f"{name}.png").shape[1] / committed.shape[1] - 1) < 0.05
        assert f".github/{name}.png" in page
    done = subprocess.run([ROOT / "tools/figures", "--everything"], capture_output=True, text=True)
    assert done.returncode == 2 and "--everything" in done.stderr


def anchors(page):
    """Of a page's headings, as sites that show Markdown make them."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}


def broken_links(page):
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+://", target):
            continue
        path, _, anchor = target.partition("#")
        there = page.parent / path if path else page
        if not there.exists() or anchor and anchor not in anchors(there):
            yield target


def test_every_link_between_pages_leads_somewhere(tmp_path):
    assert len(PAGES) > 15
    for page in PAGES:
        assert not list(broken_links(page)), page
    (tmp_path / "there.md").write_text("# A heading, with `code`\n")
    (tmp_path / "page.md").write_text("[a](there.md) [b](there.md#a-heading-with-code) [c](none.md)"
                                      " [d](there.md#none) [e](https://example.org)")
    assert list(broken_links(tmp_path / "page.md")) == ["none.md", "there.md#none"]


def test_the_front_page_leads_to_every_other_and_is_short():
    front = ROOT / "README.md"
    assert len(front.read_text().splitlines()) <= 150
    linked, to_read = {front}, [front]
    while to_read:
        page = to_read.pop()
        for target in re.findall(r"\]\(([^)#\s]+\.md)", page.read_text()):
            there = (page.parent / target).resolve()
            if "://" not in target and there not in linked:
                linked.add(there)
                to_read.append(there)
    assert not {p.resolve() for p in PAGES} - linked


def test_the_scene_of_the_front_page_is_the_demo():
    shown = re.findall(r"```yaml\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    lines = (ROOT / "configs/demo.yaml").read_text().splitlines(keepends=True)
    assert shown == ["".join(line for line in lines if not line.startswith("#"))]


def yaml_blocks(page):
    return re.findall(r"```yaml\n(.*?)```", page.read_text(), re.DOTALL)


def test_every_whole_scene_of_the_pages_can_be_planned(tmp_path):
    planned = 0
    for page in PAGES:
        for block in yaml_blocks(page):
            if re.search("^domain:", block, re.MULTILINE) and re.search("^time:", block, re.MULTILINE):
                (tmp_path / "scene.yaml").write_text(block)
                done = subprocess.run([ENVIRONMENT["PBF"], "plan", tmp_path / "scene.yaml"],
                                      capture_output=True, text=True)
                assert done.returncode == 0 and not done.stderr, (page, block, done.stderr)
                planned += 1
    assert planned >= 3


def test_fragments_of_scenes_on_the_pages_fit_into_a_scene(tmp_path):
    """Blocks with bodies, obstacles or motion, laid over a tank that has room for them."""
    tank = {"domain": "{min: [0, 0, 0], max: [3.5, 1, 1]}", "fluid": "{spacing: 0.025}",
            "bodies": "[{shape: block, min: [0, 0, 0], max: [1, 1, 0.3]}]",
            "time": "{step: 0.002, end: 1}", "gravity": "9.81"}
    for name in ("gate", "fall"):
        (tmp_path / f"{name}.csv").write_text("t,x,y,z\n0,0,0,0\n1,0,0,1\n")
    tried = 0
    for block in yaml_blocks(ROOT / "configs/README.md"):
        keys = set(re.findall(r"^(\w+):", block, re.MULTILINE))
        if not keys & {"bodies", "obstacles"} or "time" in keys or not keys:
            continue
        rest = "".join(f"{key}: {value}\n" for key, value in tank.items() if key not in keys)
        (tmp_path / "scene.yaml").write_text(block + rest)
        done = subprocess.run([ENVIRONMENT["PBF"], "plan", tmp_path / "scene.yaml"],
                              capture_output=True, text=True)
        assert done.returncode == 0, (block, done.stderr)
        tried += 1
    assert tried >= 3


def test_the_study_and_the_suite_of_the_pages_are_read(tmp_path):
    blocks = yaml_blocks(ROOT / "configs/README.md")
    study = next(b for b in blocks if "\ngrid:" in b)
    suite = next(b for b in blocks if b.startswith("cases:"))
    shutil.copytree(ROOT / "configs", tmp_path / "configs")
    (tmp_path / "configs/study/mine.yaml").write_text(study)
    (tmp_path / "configs/mine.yaml").write_text(suite)
    done = subprocess.run([ENVIRONMENT["PBF"], "study", tmp_path / "configs/study/mine.yaml", "--list"],
                          capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.count("Jacobi") == 30, done.stderr
    done = subprocess.run([ENVIRONMENT["PBF"], "stability", "--suite", tmp_path / "configs/mine.yaml",
                           "--reduced"], capture_output=True, text=True)
    assert done.returncode == 0 and "overfull_box" in done.stdout, done.stdout + done.stderr


def test_the_table_of_commands_has_every_command_of_the_program():
    """And the table of exit codes every code, as pbf --help lists them."""
    out = subprocess.run([os.environ["PBF_BINARY"], "--help"], capture_output=True, text=True).stdout
    commands = re.search(r"Subcommands:\n(.*?)\n\n", out, re.DOTALL).group(1)
    codes = re.search(r"Exit codes:\n(.*?)\n\n", out, re.DOTALL).group(1)
    page = (ROOT / "app/README.md").read_text()
    assert set(re.findall(r"^\| `pbf (\w+)", page, re.MULTILINE)) == set(
        re.findall(r"^  (\w+)", commands, re.MULTILINE))
    assert re.findall(r"^\| (\d+) \|", page, re.MULTILINE) == re.findall(
        r"^  (\d+) ", codes, re.MULTILINE)


def test_the_plan_on_the_page_is_the_one_that_the_program_prints(pbf, tmp_path):
    """But for bytes, which depend on the libraries of the build, and for the run time."""
    page = (ROOT / "app/README.md").read_text()
    words, shown = re.search(r"<code>pbf (plan [^<]*)</code></summary>\n\n```\n(.*?)```", page,
                             re.DOTALL).groups()
    done = subprocess.run([pbf, *words.split()], capture_output=True, text=True, cwd=ROOT,
                          env={**ENVIRONMENT, "PBF_CALIBRATION": str(tmp_path / "none.csv")})
    assert done.returncode == 0, done.stderr
    def plain(text):
        return [line for line in text.splitlines() if not re.search("MiB|KiB|run time", line)]
    assert plain(shown) == plain(done.stdout) and "MiB on the host" in shown


def test_the_commands_of_the_front_page_run_one_after_the_other(tmp_path):
    shutil.copytree(ROOT / "configs", tmp_path / "configs")
    (tmp_path / "build").mkdir()
    (tmp_path / "build/pbf").symlink_to(os.environ["PBF_BINARY"])
    lines = [line for line in (ROOT / "README.md").read_text().splitlines()
             if line.startswith(("build/pbf ", "cp "))]
    assert len(lines) == 5
    for line in lines:
        done = subprocess.run(line, shell=True, cwd=tmp_path, capture_output=True, text=True)
        if done.returncode == 4 and ("OpenGL" in done.stderr or "no pictures" in done.stderr):
            pytest.skip("no OpenGL")
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/my/run.vtkhdf").exists() and list(tmp_path.glob("out/my/frames/*.png"))
