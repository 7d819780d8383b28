"""Scenes that build on others, from Python; and JUnit XML as Python's parser reads it."""

import json
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

import pbf_tools

COMMON = """domain: {min: [0, 0, 0], max: [0.8, 0.4, 0.4]}
fluid: {spacing: 0.04}
bodies: [{shape: block, min: [0, 0, 0], max: [0.2, 0.2, 0.2]}]
time: {step: 0.004, end: 0.02}
output: {every: 0.02}
measure_every: 2
"""


@pytest.fixture(autouse=True)
def here(pbf, tmp_path, monkeypatch):
    monkeypatch.setenv("PBF", str(pbf))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scenes").mkdir()
    (tmp_path / "scenes/common.yaml").write_text(COMMON)


SCENE = {"base": "scenes/common.yaml", "name": "on", "solver": {"iterations": 2}}


def test_the_base_of_a_dict_is_meant_from_the_working_folder():
    assert pbf_tools.plan(SCENE)["particles"] == 125
    run = pbf_tools.run(SCENE, "far/away/out", time__end=0.04)
    assert "iterations: 2\n" in run.scene and "base" not in run.scene
    assert run.times[-1] == pytest.approx(0.04)
    table = pbf_tools.batch([SCENE, {**SCENE, "name": "b"}], {"solver.iterations": [1, 3]},
                            "far/sweep", jobs=2)
    assert list(table["reason"]) == ["finished"] * 4
    assert len(pbf_tools.batch(SCENE, out="one")) == 1


def test_none_takes_a_block_of_the_base_away():
    Path("scenes/common.yaml").write_text(COMMON + "viscosity: {xsph: 0.1}\n")
    assert "xsph: 0.1" in pbf_tools.run(SCENE, "with").scene
    assert "viscosity: off" in pbf_tools.run({**SCENE, "viscosity": None}, "without").scene


def test_a_base_outside_needs_its_folder(tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    (other / "o.yaml").write_text(COMMON)
    scene = {**SCENE, "base": other / "o.yaml"}
    with pytest.raises(pbf_tools.PbfError, match="lies outside.*--base-folder") as error:
        pbf_tools.run(scene, "out")
    assert error.value.exit_code == 2 and not Path("out").exists()
    assert pbf_tools.plan(scene, base_folder=other)["particles"] == 125
    assert pbf_tools.run(scene, "out", base_folder=other).status == "finished"
    assert len(pbf_tools.batch(scene, out="sweep", base_folder=other)) == 1
    Path("file.yaml").write_text(f"base: {other}/o.yaml\n")
    assert pbf_tools.plan("file.yaml", base_folder="/")["particles"] == 125


def test_a_base_that_is_wrong_is_named_by_the_program():
    with pytest.raises(pbf_tools.PbfError, match="none.yaml is not there"):
        pbf_tools.plan({**SCENE, "base": "none.yaml"})
    with pytest.raises(pbf_tools.PbfError, match="names no file"):
        pbf_tools.plan({**SCENE, "base": None})
    with pytest.raises(pbf_tools.PbfError, match="names no file"):
        pbf_tools.plan({**SCENE, "base": ""})
    with pytest.raises(pbf_tools.PbfError, match="the path of one scene file"):
        pbf_tools.plan({**SCENE, "base": ["scenes/common.yaml"]})


def test_the_largest_seed_comes_through_and_the_next_is_refused():
    body = {"shape": "random_box", "min": [0, 0, 0], "max": [0.2, 0.2, 0.2], "count": 9}
    for seed in (2**63 - 1, 2**53 + 1):
        scene = {**SCENE, "bodies": [{**body, "seed": seed}]}
        assert f"seed: {seed}" in pbf_tools.run(scene, f"out{seed}").scene
    plain = {**SCENE, "bodies": [body]}
    assert f"seed: {2**63 - 1}" in pbf_tools.run(plain, "set",
                                                 **{"bodies[0].seed": 2**63 - 1}).scene
    for seed, why in ((2**63, "too large"), (-1, "out of range"), (1e18, "write all its digits")):
        with pytest.raises(pbf_tools.PbfError, match=why):
            pbf_tools.plan({**SCENE, "bodies": [{**body, "seed": seed}]})
        with pytest.raises(pbf_tools.PbfError, match=why):
            pbf_tools.plan(plain, **{"bodies[0].seed": seed})


BAD = "a\"b'<c>&amp;]]>\té\u2028\uffff"


def cases_of(path):
    root = ElementTree.parse(path).getroot()
    suite = root.find("testsuite")
    cases = suite.findall("testcase")
    assert int(suite.get("tests")) == len(cases) == int(root.get("tests"))
    assert int(suite.get("failures")) == len(suite.findall("testcase/failure"))
    assert float(suite.get("time")) >= 0
    return cases


def test_junit_of_a_suite_is_read_whatever_the_names_are(pbf):
    Path("suite.yaml").write_text(
        f"cases:\n  - {{name: {json.dumps(BAD)}, group: {json.dumps(f'<{BAD}>')}, "
        'scene: scenes/common.yaml, must: {speed: 1.0e-6}}\n  - {name: fine, group: g, scene: scenes/common.yaml, '
        'must: {speed: 100}}\n  - {name: none, group: g, scene: "no <&> such.yaml", must: '
        '{speed: 1}}\n', encoding="utf-8")
    done = subprocess.run([pbf, "stability", "--suite", "suite.yaml", "--junit", "s.xml",
                           "--quiet"], capture_output=True)
    assert done.returncode == 6
    bad, fine, none = cases_of("s.xml")
    assert bad.get("name") == BAD.replace("\uffff", "\\uffff")
    assert bad.get("classname") == f"<{bad.get('name')}>"
    assert "speed" in bad.find("failure").get("message") and "must" in bad.find("failure").text
    assert fine.find("failure") is None and float(fine.get("time")) > 0
    assert "no <&> such.yaml" in none.find("failure").get("message")


def test_junit_of_a_comparison(pbf):
    words = [pbf, "compare", "scenes/common.yaml", "--between", "cpu:float@1,cpu:float@2",
             "--warmup", "1", "--updates", "3", "--members", "2", "--quiet", "--junit", "c.xml"]
    assert subprocess.run(words, capture_output=True).returncode == 0
    cases = cases_of("c.xml")
    assert len(cases) > 10 and not any(c.find("failure") is not None for c in cases)
    other = subprocess.run([*words, "--set-b", "solver.iterations=1"], capture_output=True)
    assert other.returncode == 6
    failed = [c for c in cases_of("c.xml") if c.find("failure") is not None]
    assert failed and all(c.find("failure").get("message") for c in failed)
    assert any("tolerance" in c.find("failure").get("message") for c in failed)
