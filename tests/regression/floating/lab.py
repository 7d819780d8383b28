"""What the parts of this page share: runs of scenes, tables, fits and figures."""

import csv
import subprocess
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))

G, RHO = 9.81, 1000.0  # m/s^2, kg/m^3


class Lab:
    """Runs scenes with one program in one folder; tables and figures go to `out`."""

    def __init__(self, pbf, folder, out):
        self.pbf, self.folder, self.out, self.count = pbf, Path(folder), Path(out), 0

    def run(self, scene, settings=""):
        """The run of the scene, a text, with the settings of --set, parted by spaces."""
        import pbf_tools
        self.count += 1
        place = self.folder / f"run{self.count}"
        path = place.with_suffix(".yaml")
        path.write_text(scene + "\noutput: {every: 1000}\nthreads: 1\n")
        command = [self.pbf, "run", str(path), "--out", str(place), "--quiet"]
        for s in settings.split():
            command += ["--set", s]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(done.stderr)
        return pbf_tools.open(place / "run.vtkhdf")

    def table(self, name, rows):
        with open(self.out / f"{name}.csv", "w", newline="") as file:
            table = csv.DictWriter(file, rows[0], lineterminator="\n")
            table.writeheader()
            for row in rows:
                table.writerow({k: f"{v:.4g}" if isinstance(v, (float, np.floating)) else v
                                for k, v in row.items()})
                print(name, {k: f"{v:.4g}" if isinstance(v, (float, np.floating)) else v
                             for k, v in row.items()}, file=sys.stderr)

    def figure(self, name, panels):
        """An empty figure of this many panels side by side, and a function that saves it."""
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        figure, axes = plt.subplots(1, panels, figsize=(4.2 * panels, 3.2), squeeze=False)

        def save():
            figure.tight_layout()
            figure.savefig(self.out / f"{name}.png", dpi=90)
            plt.close(figure)
        return axes[0], save


def harmonic(times, values, omega):
    """Mean, complex amplitude c of values = mean + Re c exp(-i omega t), and the RMS of the rest."""
    m = np.stack([np.ones_like(times), np.cos(omega * times), np.sin(omega * times)], 1)
    c = np.linalg.lstsq(m, values, rcond=None)[0]
    return c[0], c[1] + 1j * c[2], np.std(values - m @ c)


def extreme(times, values, sign):
    """Time and value of the first extreme of this sign after the start, by a parabola."""
    k = int(np.argmax(sign * values))
    k = min(max(k, 1), len(values) - 2)
    below, above = values[k - 1] - values[k], values[k + 1] - values[k]
    curve = below + above
    if curve == 0:
        return times[k], values[k]
    shift = (below - above) / (2 * curve)
    return (times[k] + shift * (times[k + 1] - times[k]),
            values[k] - (above - below) ** 2 / (8 * curve))
