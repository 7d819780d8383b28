"""CITATION.cff: complete, and of the version that the program says."""

import re
import subprocess

import pytest
from conftest import ROOT

import pbf_tools

FILE = ROOT / ".github/CITATION.cff"


@pytest.fixture(scope="module")
def citation():
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    return yaml.safe_load(FILE.read_text())


def test_the_citation_has_what_the_format_asks_for_and_nothing_else(citation):
    """The keys of its schema, version 1.2.0; in `references` of an article."""
    assert {"cff-version", "message", "title", "authors"} <= set(citation)
    assert set(citation) <= {"cff-version", "message", "title", "authors", "type", "version",
                             "date-released", "license", "abstract", "keywords", "references", "doi",
                             "repository-code", "url", "commit", "contact", "identifiers"}
    assert citation["cff-version"] == "1.2.0" and citation["type"] == "software"
    assert citation["license"] == "MIT" and (ROOT / "LICENSE").read_text().startswith("MIT")
    assert all(set(a) <= {"name", "given-names", "family-names", "orcid"} for a in citation["authors"])


def test_the_version_of_the_citation_is_that_of_the_program_and_of_the_front_page(citation, pbf):
    said = subprocess.run([pbf, "info"], capture_output=True, text=True, check=True).stdout
    front = (ROOT / "README.md").read_text()
    assert str(citation["version"]) == pbf_tools.__version__
    assert said.startswith(f"pbf {citation['version']}\n")
    assert re.search(r"^@software\{.* version = \{(.*?)\}\}$", front, re.M)[1] == citation["version"]
    assert f"title = {{{citation['title']}}}" in front
    date = re.search(rf"^## {citation['version']} \((.*)\)$",
                     (ROOT / ".github/CHANGELOG.md").read_text(), re.M)[1]
    assert str(citation["date-released"]) == date


def test_the_method_is_cited_as_on_the_front_page(citation):
    method, = citation["references"]
    assert method["doi"] == "10.1145/2461912.2461984"
    front = (ROOT / "README.md").read_text()
    assert f"https://doi.org/{method['doi']}" in front
    assert [a["family-names"] for a in method["authors"]] == ["Macklin", "Müller"]
    assert f"*{method['title']}*, {method['journal']} {method['volume']}({method['issue']}), " \
           f"{method['start']}, {method['year']}" in front
