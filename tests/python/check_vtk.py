#!/usr/bin/env python3
"""Reads run files with VTK's own reader and holds the result to what h5py sees.

    check_vtk.py RUN.h5... [--picture OUT.png]

Exit status: 0 all good, 1 VTK shows something else, 77 VTK (9.3 or newer) or h5py is missing.
"""

import sys

try:
    import h5py
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkVersion
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

if (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) < (9, 3):
    print(f"skipped: VTK {vtkVersion.GetVTKVersion()} cannot read temporal VTKHDF")
    sys.exit(77)


def expected_step(vtk, k):
    steps = vtk["Steps"]
    n = int(vtk["NumberOfPoints"][int(steps["PartOffsets"][k])])
    first = int(steps["PointOffsets"][k])
    arrays = {"": vtk["Points"][first:first + n]}
    for name in vtk["PointData"]:
        at = int(steps["PointDataOffsets"][name][k])
        arrays[name] = vtk["PointData"][name][at:at + n]
    return n, arrays


def differences(path):
    """The number of steps, and what VTK shows otherwise than h5py."""
    found = []
    reader = vtkHDFReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    info = reader.GetOutputInformation(0)
    times = info.Get(Pipeline.TIME_STEPS()) or ()
    with h5py.File(path, "r", locking=False) as file:
        vtk = file["VTKHDF"]
        if not np.array_equal(times, vtk["Steps/Values"][:]):
            return len(times), [f"time steps {times}"]
        for k in [*range(len(times)), 0]:  # and back again: nothing may be left of a later step
            reader.UpdateTimeStep(times[k])
            mesh = reader.GetOutputDataObject(0)
            n, arrays = expected_step(vtk, k)
            sizes = (mesh.GetNumberOfPoints(), mesh.GetNumberOfVerts(), mesh.GetNumberOfCells())
            if sizes != (n, 1, 1) or mesh.GetCell(0).GetNumberOfPoints() != n:
                found.append(f"step {k}: points, vertices, cells {sizes} instead of {(n, 1, 1)}")
                continue
            for name, expected in arrays.items():
                data = mesh.GetPoints().GetData() if name == "" else mesh.GetPointData().GetArray(name)
                if data is None or not np.array_equal(vtk_to_numpy(data), expected):
                    found.append(f"step {k}: {name or 'points'} differ")
    return len(times), found


def draw(path, out):
    """First, middle and last step side by side, by PyVista, which by itself has .h5 for Fluent's."""
    import pyvista

    reader = pyvista.get_reader(path, force_ext=".vtkhdf")
    with h5py.File(path, "r", locking=False) as file:
        times = file["VTKHDF/Steps/Values"][:]
    plotter = pyvista.Plotter(off_screen=True, shape=(1, 3), window_size=(1500, 500))
    for column, time in enumerate((times[0], times[len(times) // 2], times[-1])):
        reader.reader.UpdateTimeStep(time)  # PyVista's wrapper of this reader has no time of its own
        mesh = pyvista.wrap(reader.reader.GetOutputDataObject(0)).copy()
        plotter.subplot(0, column)
        plotter.add_mesh(mesh, scalars="velocity", render_points_as_spheres=True, point_size=9,
                         scalar_bar_args={"title": f"speed m/s, t = {time:.3g} s"})
    plotter.link_views()
    plotter.screenshot(out)
    plotter.close()


def main(arguments):
    out = None
    if "--picture" in arguments:
        at = arguments.index("--picture")
        out = arguments[at + 1]
        del arguments[at:at + 2]
    bad = 0
    for path in arguments:
        count, found = differences(path)
        print(f"{path}: VTK {vtkVersion.GetVTKVersion()} shows {count} steps: "
              f"{'; '.join(found) if found else 'the same as h5py'}")
        bad += bool(found)
    if out:
        draw(arguments[0], out)
    return 1 if bad or not arguments else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
