"""Measured dam-break fronts from the literature, dimensionless, as files in data/.

Every file states its source in its first lines. All use Z = x/a and T = t sqrt(n2 g/a), with a the
width of the column along the flow and n2 = height/width: for n2 = 2 that is the t sqrt(2g/a) of
Martin & Moyce and of Koshizuka & Oka, for n2 = 1 Lobovsky's t sqrt(g/H).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from .table import Table, read_csv

FOLDER = Path(__file__).parent / "data"


@dataclass(frozen=True)
class Reference:
    """One measured front: its file, what a legend calls it, the column's height over its width, and
    the Z at which the experiment's far wall stopped it."""

    file: str
    label: str
    ratio: float
    wall: float = float("inf")

    def read(self) -> Table:
        """Columns T and Z, before the far wall."""
        table = read_csv(FOLDER / self.file)
        return table.where(table["Z"] < self.wall)


REFERENCES = {
    "martin-moyce": Reference("martin_moyce_1952_front_n2_2_a2.25in.csv",
                              "Martin & Moyce 1952, a = 2.25 in (table 2)", 2),
    "martin-moyce-fig3": Reference("martin_moyce_1952_front_fig3_n2_2_a2.25in.csv",
                                   "Martin & Moyce 1952, a = 2.25 in (fig. 3)", 2),
    "martin-moyce-small": Reference("martin_moyce_1952_front_fig3_n2_2_a1.125in.csv",
                                    "Martin & Moyce 1952, a = 1.125 in (fig. 3)", 2),
    "koshizuka-oka": Reference("koshizuka_oka_1996_front.csv", "Koshizuka & Oka 1996", 2),
    "koshizuka-oka-2": Reference("koshizuka_oka_1996_front_dualsphysics.csv",
                                 "Koshizuka & Oka 1996 (2nd digitisation)", 2),
    "martin-moyce-square": Reference("martin_moyce_1952_front_n2_1_a2.25in.csv",
                                     "Martin & Moyce 1952, square, a = 2.25 in", 1),
    "lobovsky": Reference("lobovsky_2014_front_h600.csv", "Lobovsky et al. 2014, 0.6 m square", 1,
                          wall=2.68),
}
