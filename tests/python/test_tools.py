"""tools/setup, tools/demo and tools/test, with commands in their place that say how they were called."""

import os
import pty
import re
import shutil
import subprocess

import pytest
from conftest import ROOT

CMAKE = """
case "$1" in
  --build)
    for i in 1 2 3; do echo "[$i/3] Building CXX object $i"; done
    [ -z "$BREAK" ] || { echo "FAILED: it is broken"; exit 1; }
    mkdir -p build
    printf '%s\\n' '#!/bin/sh' 'echo "pbf $*" >>calls; mkdir -p out/demo mine' >build/pbf
    chmod +x build/pbf ;;
  *)
    touch build/CMakeCache.txt
    case "$*" in *-DPBF_CUDA=OFF*) echo "-- CUDA backend: off" ;; *) echo "-- CUDA backend: on" ;; esac ;;
esac
"""
GPU = 'echo "GPU 0: NVIDIA H200 (UUID: GPU-0)"'
NO_GPU = 'echo "NVIDIA-SMI has failed"; exit 9'


@pytest.fixture
def tree(tmp_path):
    """A copy of tools/ and a way to run one of them: tree(arguments, nvidia_smi=..., ...)."""
    (tmp_path / "tools").mkdir()
    for name in ("setup", "demo", "test", "shared.sh"):
        shutil.copy(ROOT / "tools" / name, tmp_path / "tools")
    commands = tmp_path / "bin"
    commands.mkdir()

    def command(name, body):
        (commands / name).write_text(f'#!/bin/sh\necho "{name} $*" >>"{tmp_path}/calls"\n{body}\n')
        (commands / name).chmod(0o755)

    command("cmake", CMAKE)
    command("ctest", "")
    command("apt-get", "echo 'Unpacking g++'")
    command("apt-cache", "")

    def run(*arguments, nvidia_smi=NO_GPU, installed=True, terminal=False, **environment):
        command("nvidia-smi", nvidia_smi)
        command("dpkg-query", "echo installed" if installed else "exit 1")
        (tmp_path / "calls").write_text("")
        env = {**os.environ, "PATH": f"{commands}:/usr/bin:/bin", **environment}
        if not terminal:
            done = subprocess.run(arguments, cwd=tmp_path, env=env, capture_output=True, text=True,
                                  timeout=60)
            text = done.stdout + done.stderr
        else:
            ours, theirs = pty.openpty()
            done = subprocess.Popen(arguments, cwd=tmp_path, env=env, stdin=theirs, stdout=theirs,
                                    stderr=theirs)
            os.close(theirs)
            text = ""
            try:
                while part := os.read(ours, 4096):
                    text += part.decode()
            except OSError:  # the other end is closed
                pass
            os.close(ours)
            done.wait(60)
        calls = (tmp_path / "calls").read_text().splitlines()
        return done.returncode, text, [c for c in calls if c.startswith(("cmake", "pbf", "ctest"))]

    (tmp_path / "build/venv/bin").mkdir(parents=True)
    (tmp_path / "build/venv/bin/python").symlink_to("/bin/true")
    run.folder = tmp_path
    return run


@pytest.mark.parametrize("tool", ["setup", "demo", "test"])
def test_a_tool_explains_itself_and_refuses_what_it_does_not_know(tree, tool):
    code, text, calls = tree(f"tools/{tool}", "--help")
    assert code == 0 and f"Example" in text and f"tools/{tool}" in text and "#" not in text
    assert calls == []
    code, text, calls = tree(f"tools/{tool}", "nonsense")
    assert code == 2 and "unknown argument 'nonsense'" in text and calls == []


@pytest.mark.parametrize("tool", ["demo", "test"])
@pytest.mark.parametrize("options,nvidia_smi,cuda,native", [
    ([], NO_GPU, "OFF", False),
    ([], GPU, "AUTO", True),
    (["--cuda"], NO_GPU, "ON", False),
    (["--cuda"], GPU, "ON", True),
    (["--no-cuda"], GPU, "OFF", False)])
def test_cuda_is_built_where_a_gpu_or_a_wish_is(tree, tool, options, nvidia_smi, cuda, native):
    code, text, calls = tree(f"tools/{tool}", *options, nvidia_smi=nvidia_smi)
    assert code == 0
    assert f"-DPBF_CUDA={cuda}" in calls[0]
    assert ("-DCMAKE_CUDA_ARCHITECTURES=native" in calls[0]) == native
    assert ("without" if cuda == "OFF" else "with") + " the CUDA backend" in text


def test_the_demo_builds_the_program_alone_passes_options_on_and_says_what_is_next(tree):
    code, text, calls = tree("tools/demo", "--", "--threads", "2")
    assert code == 0
    assert "-DPBF_TESTS=OFF" in calls[0] and "-DCMAKE_BUILD_TYPE=Release" in calls[0]
    assert calls[1:] == [
        "cmake --build build --target pbf",
        "pbf run configs/demo.yaml --out out/demo --overwrite --threads 2"]
    for part in ("build/pbf --help", f"{tree.folder}/out/demo", "frames/", "run.vtkhdf",
                 "build/pbf render out/demo/run.vtkhdf", "cp configs/demo.yaml", "tools/test",
                 "README.md"):
        assert part in text, part
    _, text, calls = tree("tools/demo", "--", "--out", "mine")
    assert calls[0].count("TESTS") == 0  # a build folder that is there stays as it is
    assert calls[2] == "pbf run configs/demo.yaml --overwrite --out mine"
    assert f"{tree.folder}/mine" in text and "render mine/run.vtkhdf" in text


def test_the_tests_get_the_options_of_cmake_and_of_ctest(tree):
    code, _, calls = tree("tools/test", "-DPBF_WERROR=ON", "--", "-R", "resume")
    assert code == 0
    assert "-DPBF_TESTS=ON" in calls[0] and calls[0].endswith("-DPBF_WERROR=ON")
    assert calls[1] == "cmake --build build --target all"
    assert calls[2].startswith("ctest ") and calls[2].endswith(" -R resume")


def test_the_quick_part_is_less_is_chosen_by_its_label_and_says_that_it_is_a_part(tree):
    code, text, calls = tree("tools/test", "--quick", "--", "-R", "guard")
    assert code == 0
    assert calls[1] == "cmake --build build --target pbf unit oracle cli backend frozen"
    assert "-L quick" in calls[2] and calls[2].endswith(" -R guard")
    assert text.rstrip().splitlines()[-1].startswith("tools/test: this was the quick part")
    code, text, calls = tree("tools/test")
    assert code == 0 and "quick" not in text and "-L" not in calls[2].split()


def test_the_quick_part_needs_no_python_packages(tree):
    (tree.folder / "build/venv/bin/python").unlink()
    code, text, _ = tree("tools/test", "--quick")
    assert code == 0 and "pytest" not in text


def test_a_build_that_fails_shows_all_of_its_output(tree):
    code, text, calls = tree("tools/demo", BREAK="yes")
    assert code == 1
    assert "[2/3] Building" in text and "FAILED: it is broken" in text and "failed, see above" in text
    assert not any(c.startswith("pbf") for c in calls)
    code, text, _ = tree("tools/demo", BREAK="yes", terminal=True)
    assert code == 1 and "FAILED: it is broken\r\n" in text and "the build failed, see above" in text
    assert "build/build.log" in text and "[2/3] Building" in (tree.folder / "build/build.log").read_text()


def test_a_terminal_shows_each_step_in_one_line_that_is_overwritten(tree):
    code, text, _ = tree("tools/setup", installed=False, terminal=True)
    assert code == 0 and re.search(r"\r\x1b\[K\d+ s  Unpacking g\+\+\r\x1b\[K", text)
    assert "tools/setup: installing g++ cmake" in text
    code, text, _ = tree("tools/setup", installed=False)
    assert code == 0 and "\r" not in text and "\x1b" not in text and "Unpacking" not in text
    code, text, _ = tree("tools/setup")
    assert code == 0 and "nothing is missing" in text


def test_setup_installs_for_pictures_alone_where_nothing_is_built(tree):
    code, text, _ = tree("tools/setup", "--pictures", installed=False)
    assert code == 0 and re.search(r"^tools/setup: installing libosmesa6$", text, re.MULTILINE)
    code, text, _ = tree("tools/setup", "--pictures")
    assert code == 0 and "nothing is missing" in text
    code, text, _ = tree("tools/setup", "--ranks", installed=False)
    assert code == 0 and "g++" in text and text.count("libopenmpi-dev openmpi-bin") == 1


def test_the_container_is_made_of_what_is_here_and_of_the_packages_of_setup():
    text = (ROOT / "tools/container/Dockerfile").read_text().replace("\\\n", "")
    copied = [words.split()[:-1] for words in re.findall(r"^COPY (?!--)(.*)$", text, re.MULTILINE)]
    sources = {source for words in copied for source in words}
    assert all((ROOT / source).exists() for source in sources)
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True).stdout
    assert {line.split("/")[0] for line in tracked.splitlines()} <= sources and ".git" in sources
    assert "apt-get" not in text and text.count("tools/setup --pictures") == 1
    used = set(re.findall(r"\b(build_static|copy_licenses|cuda_toolkit)\b", text))
    static = (ROOT / "tools/static.sh").read_text()
    assert len(used) == 3 and all(f"\n{name}() {{" in static for name in used)


def test_a_long_build_says_where_it_is_at_least_every_ten_seconds(tree):
    """Here every second. Compilers may take longer than that over one file, and say nothing."""
    assert "\nevery=10\n" in (ROOT / "tools/shared.sh").read_text()
    follow = ". tools/shared.sh; every=1; follow log"
    slow = "echo '[1/9] Building CXX object a.o'; sleep 3; printf '[2/9'; sleep 2; echo '] half a line'"
    _, text, _ = tree("bash", "-c", f"{{ {slow}; }} | {{ {follow}; }}")
    said = [int(s) for s in re.findall(r"^(\d+) s  \[1/9\] Building CXX object a\.o$", text, re.MULTILINE)]
    assert len(said) >= 3 and max(b - a for a, b in zip(said, said[1:])) <= 3, text
    assert (tree.folder / "log").read_text() == "[1/9] Building CXX object a.o\n[2/9] half a line\n"
    _, text, _ = tree("bash", "-c", f"sleep 2.5 | {{ {follow}; }}")
    assert re.search(r"^\d s  \.\.\.$", text, re.MULTILINE)


def test_a_terminal_keeps_what_the_compiler_says_and_counts_the_seconds(tree):
    slow = "echo '[1/2] Building a'; sleep 2.5; echo 'a.cpp:1: warning: w'; echo '[2/2] Linking'"
    _, text, _ = tree("bash", "-c", f". tools/shared.sh; {{ {slow}; }} | follow log kept", terminal=True)
    assert "\ra.cpp:1: warning: w\r\n" in text.replace("\x1b[K", "")
    assert "1 s  [1/2] Building a\r" in text and "2 s  [1/2] Building a\r" in text
