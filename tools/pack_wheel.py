"""Packs a program, its scenes and pbf_tools into a wheel; tools/wheel calls it.

The files of a wheel are named in https://packaging.python.org/specifications/binary-distribution-format.
The same content gives the same bytes: entries are sorted and have one time.
"""

import argparse
import ast
import base64
import hashlib
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "tools/pbf_tools"


def version() -> str:
    """`__version__` of the package, read without running it."""
    for node in ast.parse((PACKAGE / "__init__.py").read_text()).body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__version__":
            return ast.literal_eval(node.value)
    sys.exit(f"{PACKAGE}/__init__.py has no __version__")


def files(folder: Path) -> Iterator[tuple[str, bytes]]:
    for path in folder.rglob("*"):
        if path.is_file() and path.suffix != ".pyc":
            yield path.relative_to(folder.parent).as_posix(), path.read_bytes()


def metadata(number: str, project: dict, licenses: list[str]) -> str:
    lines = ["Metadata-Version: 2.1", "Name: pbf", f"Version: {number}",
             "Summary: A batch simulator for Position Based Fluids, and its Python tools",
             "License: MIT; licenses/ of this metadata has those of the libraries linked in",
             *(f"License-File: licenses/{name}" for name in licenses),
             f"Requires-Python: {project['requires-python']}",
             *(f"Requires-Dist: {need}" for need in project["dependencies"])]
    for extra, needs in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}",
                  *(f'Requires-Dist: {need} ; extra == "{extra}"' for need in needs)]
    lines += ["Description-Content-Type: text/plain", "",
              "pbf simulates a scene file and writes particle snapshots and pictures: pbf --help.",
              "Its scenes lie in share/pbf/configs of the environment that this is installed in.",
              "pbf_tools runs scenes from Python, and reads, plots and compares run files."]
    return "\n".join(lines) + "\n"


def contents(args: argparse.Namespace, number: str) -> dict[str, bytes]:
    """Of the wheel by path, without RECORD."""
    project = tomllib.loads((ROOT / "tools/pyproject.toml").read_text())["project"]
    data, info = f"pbf-{number}.data", f"pbf-{number}.dist-info"
    licenses = {path.name: path.read_bytes() for path in args.licenses.iterdir()}
    scripts = "".join(f"{name} = {entry}\n" for name, entry in project["scripts"].items())
    wheel = ("Wheel-Version: 1.0\nGenerator: pbf tools/wheel\nRoot-Is-Purelib: false\n"
             f"Tag: py3-none-{args.tag}\n")
    return {**dict(files(PACKAGE)),
            f"{data}/scripts/pbf": args.program.read_bytes(),
            # Where the program looks from bin/ (lib/base/shipped_file.h).
            **{f"{data}/data/share/pbf/{name}": text for name, text in files(ROOT / "configs")},
            # With a file of its own, pip removes the folder too.
            f"{data}/data/share/pbf/LICENSE": (ROOT / "LICENSE").read_bytes(),
            **{f"{info}/licenses/{name}": text for name, text in licenses.items()},
            f"{info}/METADATA": metadata(number, project, sorted(licenses)).encode(),
            f"{info}/WHEEL": wheel.encode(),
            f"{info}/entry_points.txt": f"[console_scripts]\n{scripts}".encode()}


def record(entries: dict[str, bytes], own: str) -> bytes:
    lines = []
    for name in sorted(entries):
        digest = base64.urlsafe_b64encode(hashlib.sha256(entries[name]).digest()).rstrip(b"=")
        lines.append(f"{name},sha256={digest.decode()},{len(entries[name])}\n")
    return "".join([*lines, f"{own},,\n"]).encode()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True)
    parser.add_argument("--licenses", type=Path, required=True, help="folder of texts")
    parser.add_argument("--tag", required=True, help="of the platform, e.g. linux_x86_64")
    parser.add_argument("--local", default="", help="behind the version, e.g. +cu130")
    parser.add_argument("--out", type=Path, required=True, help="folder of the wheel")
    args = parser.parse_args()
    said = subprocess.run([args.program, "info"], capture_output=True, text=True, check=True)
    if said.stdout.split("\n")[0] != f"pbf {version()}":
        sys.exit(f"{args.program} is {said.stdout.splitlines()[0]}, pbf_tools is {version()}: "
                 "build the program again")
    number = version() + args.local
    entries = contents(args, number)
    own = f"pbf-{number}.dist-info/RECORD"
    entries[own] = record(entries, own)
    path = args.out / f"pbf-{number}-py3-none-{args.tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        # The metadata last, as the format advises.
        for name in sorted(entries, key=lambda n: (".dist-info/" in n, n)):
            entry = zipfile.ZipInfo(name)  # of 1980
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if "/scripts/" in name else 0o100644) << 16
            wheel.writestr(entry, entries[name])
    print(path)


if __name__ == "__main__":
    main()
