#!/usr/bin/env python3
"""Reads run files with h5py alone and holds them to the documented layout.

    check_run_file.py RUN.h5...

Exit status: 0 all good, 1 a file breaks the layout, 77 h5py is not installed.
"""

import sys

try:
    import h5py
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")
UNITS = {"Points": "m", "velocity": "m/s", "density": "kg/m^3", "id": "1"}
TEXTS = ("scene_path scene_text resolved_scene program_version commit compiler build_flags host "
         "started plan backend precision device driver status scene_sha256 "
         "scene_files warnings").split()


def check(condition, message):
    if not condition:
        raise AssertionError(message)


def check_header(vtk):
    check(list(vtk.attrs["Version"]) == [2, 2], "VTKHDF version is not 2.2")
    kind = vtk.attrs.get_id("Type").get_type()
    check(not kind.is_variable_str() and kind.get_size() == 8 and
          kind.get_cset() == h5py.h5t.CSET_ASCII, "Type is not a fixed-length ASCII string")
    check(vtk.attrs["Type"] == b"PolyData", "Type is not PolyData")


def check_steps(vtk, updates):
    steps = vtk["Steps"]
    count = int(steps.attrs["NSteps"])
    times = steps["Values"][:]
    check(len(times) == count, "Values and NSteps differ")
    check(np.all(np.diff(times) > 0), "times do not grow")
    check(len(updates) == count and np.all(np.diff(updates[:]) > 0), "updates do not grow")
    check(steps["Values"].attrs["units"] == "s", "times are not in seconds")
    if "bodies" in updates.parent:
        bodies = updates.parent["bodies"]
        check(bodies.shape == (count, len(bodies.attrs["names"]), len(bodies.attrs["columns"])),
              "bodies have not one row per step, body and column")
        check(len(bodies.attrs["units"]) == bodies.shape[2], "bodies have not a unit per column")
    for name in ("PartOffsets", "NumberOfParts", "PointOffsets"):
        check(steps[name].shape == (count,), f"Steps/{name} has not one row per step")
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        check(steps[name].shape == (count, 4), f"Steps/{name} has not four numbers per step")
    check(np.all(steps["NumberOfParts"][:] == 1), "a step has not one part")
    return count


def check_cells(vtk, k, n):
    part = int(vtk["Steps/PartOffsets"][k])
    for t, name in enumerate(TOPOLOGIES):
        group = vtk[name]
        cells = int(group["NumberOfCells"][part])
        ids = int(group["NumberOfConnectivityIds"][part])
        check((cells, ids) == ((1, n) if t == 0 else (0, 0)), f"{name} of step {k} is wrong")
        first = int(vtk["Steps/ConnectivityIdOffsets"][k, t])
        check(np.array_equal(group["Connectivity"][first:first + ids], np.arange(ids)),
              f"connectivity of {name} in step {k} is not 0..n-1")
        # The specification: a part with c cells has c+1 offsets, parts one after the other.
        at = int(group["NumberOfCells"][:part].sum()) + part
        check(list(group["Offsets"][at:at + cells + 1]) == ([0, n] if t == 0 else [0]),
              f"offsets of {name} in step {k} are wrong")


def check_frames(vtk, count):
    steps, data = vtk["Steps"], vtk["PointData"]
    check(set(data) == set(steps["PointDataOffsets"]), "a field has no offsets")
    check("id" in data and data["id"].dtype in (np.int32, np.int64), "no ids of 32 or 64 bits")
    check(vtk["Points"].dtype.kind == "f" and vtk["Points"].shape[1] == 3, "bad Points")
    for name in ["Points", *data]:
        item = vtk["Points"] if name == "Points" else data[name]
        check(item.attrs["units"] == UNITS.get(name, item.attrs["units"]), f"unit of {name}")
    previous_end = 0
    for k in range(count):
        n = int(vtk["NumberOfPoints"][int(steps["PartOffsets"][k])])
        first = int(steps["PointOffsets"][k])
        check(first >= previous_end, f"step {k} overlaps the one before")
        check(first % vtk["Points"].chunks[0] == 0 or n == 0, f"step {k} starts inside a chunk")
        previous_end = first + n
        points = vtk["Points"][first:first + n]
        check(points.shape == (n, 3) and np.all(np.isfinite(points)), f"points of step {k}")
        for name in data:
            at = int(steps["PointDataOffsets"][name][k])
            values = data[name][at:at + n]
            check(len(values) == n, f"{name} of step {k} is cut off")
            if name == "id":
                check(np.all(values >= 0) and np.all(np.diff(values) > 0),
                      f"ids of step {k} do not ascend")
            else:
                check(np.all(np.isfinite(values)), f"{name} of step {k} is not finite")
        check_cells(vtk, k, n)


def check_pbf(pbf):
    check(pbf.attrs["format_version"] == 1, "format version is not 1")
    for name in TEXTS:
        check(isinstance(pbf.attrs[name], str), f"{name} does not read as str")
    check(pbf.attrs["status"] in ("running", "finished", "stopped", "diverged"), "bad status")
    for name, size in (("domain_min", 3), ("domain_max", 3), ("spacing", 1),
                       ("smoothing_length", 1), ("rest_density", 1)):
        check(pbf[name].size == size and pbf[name].attrs["units"], f"{name} is wrong")
    rows = len(pbf["log/time"])
    for name, column in list(pbf["log"].items()) + list(pbf["log"].get("stage", {}).items()):
        if isinstance(column, h5py.Dataset):
            check(column.shape == (rows,), f"log column {name} has not {rows} rows")
            check(isinstance(column.attrs["units"], str), f"log column {name} has no unit")
    check(np.all(np.diff(pbf["log/time"][:]) >= 0), "the log's times run backwards")
    return rows


def main(paths):
    for path in paths:
        try:
            with h5py.File(path, "r", locking=False) as file:
                check_header(file["VTKHDF"])
                count = check_steps(file["VTKHDF"], file["pbf/frames/update"])
                if count:
                    check_frames(file["VTKHDF"], count)
                rows = check_pbf(file["pbf"])
        except (AssertionError, KeyError, OSError) as problem:
            print(f"{path}: {problem}")
            return 1
        print(f"{path}: {count} frames, {rows} log rows: good")
    return 0 if paths else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
