"""A view of a run file for ParaView (5.13 or later): particles as spheres coloured by speed, the time
in the picture, the edges of the domain. Edit it as you like; every line is ParaView's own scripting.

    PBF_RUN=out/demo/run.vtkhdf paraview --script=tools/paraview_state.py
    pvpython tools/paraview_state.py out/demo/run.vtkhdf picture.png 0.5    one moment, in s
    pvpython tools/paraview_state.py out/demo/run.vtkhdf film.png           all: film.0000.png, ...

Without PBF_RUN and arguments it opens out/demo/run.vtkhdf. The domain is that of
scene.resolved.yaml beside the run file; without it the edges are those of the particles.
"""

import os
import re
import sys

if {"-h", "--help"} & set(sys.argv[1:]):
    print(__doc__)  # also where there is no ParaView
    sys.exit()

import paraview
from paraview import simple as pv


def domain(run):
    """Lower and upper corner (m) from the scene beside the run file; None where there is none."""
    try:
        with open(os.path.join(os.path.dirname(run), "scene.resolved.yaml")) as file:
            text = file.read()
    except OSError:
        return None
    number = r"[-+.\deE]+"
    corner = rf"\[({number}), ({number}), ({number})\]"
    found = re.search(rf"^domain:\n  min: {corner}\n  max: {corner}$", text, re.MULTILINE)
    return found and (*map(float, found.groups()),)


def spacing(run):
    """The distance of particles at rest (m), likewise; None where it is not known."""
    try:
        with open(os.path.join(os.path.dirname(run), "scene.resolved.yaml")) as file:
            found = re.search(r"^fluid:\n(?:  .*\n)*?  spacing: (\S+)$", file.read(), re.MULTILINE)
    except OSError:
        return None
    return found and float(found.group(1))


def show(run):
    """Fills the active view; returns it and the reader."""
    if tuple(map(int, str(paraview.__version__).split(".")[:2])) < (5, 13):
        raise SystemExit(f"ParaView {paraview.__version__} shows only the first moment of a run, or "
                         "none: install 5.13 or later")
    if not os.path.isfile(run):
        raise SystemExit(f"{run}: no such file; name a run file in PBF_RUN or as an argument")
    particles = pv.OpenDataFile(run)
    pv.RenameSource("particles", particles)
    view = pv.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    view.OrientationAxesVisibility = 1

    shown = pv.Show(particles, view, "GeometryRepresentation")
    shown.SetRepresentationType("Point Gaussian")
    shown.ShaderPreset = "Sphere"
    shown.GaussianRadius = (spacing(run) or 0.02) / 2
    pv.ColorBy(shown, ("POINTS", "velocity", "Magnitude"))
    animation = pv.GetAnimationScene()
    animation.UpdateAnimationUsingDataTimeSteps()
    animation.GoToLast()  # at the start all is at rest, and there is no range of colours
    colors = pv.GetColorTransferFunction("velocity")
    colors.ApplyPreset("Viridis (matplotlib)", True)
    shown.RescaleTransferFunctionToDataRangeOverTime()
    shown.SetScalarBarVisibility(view, True)
    bar = pv.GetScalarBar(colors, view)
    bar.Title, bar.ComponentTitle = "speed", "m/s"
    bar.TitleColor = bar.LabelColor = [0, 0, 0]

    corners = domain(run)
    if corners:
        box = pv.Box(registrationName="domain")
        box.Center = [(a + b) / 2 for a, b in zip(corners[:3], corners[3:])]
        box.XLength, box.YLength, box.ZLength = (b - a for a, b in zip(corners[:3], corners[3:]))
        edges = pv.Show(box, view, "GeometryRepresentation")
        edges.SetRepresentationType("Outline")
    else:
        edges = pv.Show(pv.Outline(registrationName="extent", Input=particles), view)
    edges.AmbientColor = edges.DiffuseColor = [0.3, 0.3, 0.3]

    time = pv.AnnotateTime(registrationName="time")
    time.Format = "t = {time:.3f} s"
    label = pv.Show(time, view)
    label.Color = [0, 0, 0]

    pv.SetActiveSource(particles)
    animation.GoToFirst()
    pv.ResetCamera(view)
    view.CameraParallelProjection = 0
    center = view.CameraFocalPoint
    view.CameraPosition = [center[0] - 0.6, center[1] - 2, center[2] + 0.9]  # x to the right, z up
    view.CameraViewUp = [0, 0, 1]
    pv.ResetCamera(view)
    pv.GetActiveCamera().Zoom(1.3)
    return view, particles


def main(words):
    run = words[0] if words else os.environ.get("PBF_RUN", "out/demo/run.vtkhdf")
    view, particles = show(os.path.abspath(run))
    if len(words) < 2:
        pv.Render(view)
        return
    view.ViewSize = [1280, 800]
    if len(words) > 2:
        times = list(particles.TimestepValues)
        pv.GetAnimationScene().AnimationTime = min(times, key=lambda t: abs(t - float(words[2])))
        pv.SaveScreenshot(words[1], view)
    else:
        pv.SaveAnimation(words[1], view)


main([word for word in sys.argv[1:] if not word.startswith("-")])
