#!/usr/bin/env python3
"""Runs the tests of tools/pbf_tools (test_*.py here) with pytest.

    PBF_BINARY=build/pbf PBF_SAMPLE_FOLDER=FOLDER run_pytest.py [pytest arguments]

PBF_SAMPLE_FOLDER holds the run files that the C++ test "run files for the Python checks" writes.
Exit status: that of pytest, 77 when a package that they need is not installed.
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent

try:
    import h5py  # noqa: F401
    import matplotlib  # noqa: F401
    import numpy  # noqa: F401
    import pytest
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

if __name__ == "__main__":
    for name in ("PBF_BINARY", "PBF_SAMPLE_FOLDER"):
        if not os.environ.get(name):
            sys.exit(f"run_pytest.py: set {name}; see its first lines")
    sys.dont_write_bytecode = True
    sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", str(HERE), *sys.argv[1:]]))
