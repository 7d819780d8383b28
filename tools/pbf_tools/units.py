"""Units of columns, at the end of their names: "H2_m", "t_ms", "U_x_m_s"."""

from __future__ import annotations

import re

# Unit -> the one of run files, and how much of that it is: the table of the program
# (lib/data/units.cpp).
UNITS = {"s": ("s", 1.0), "ms": ("s", 1e-3), "m": ("m", 1.0), "cm": ("m", 1e-2), "mm": ("m", 1e-3),
         "m/s": ("m/s", 1.0), "cm/s": ("m/s", 1e-2), "mm/s": ("m/s", 1e-3), "Pa": ("Pa", 1.0),
         "hPa": ("Pa", 1e2), "kPa": ("Pa", 1e3), "mbar": ("Pa", 1e2), "bar": ("Pa", 1e5),
         "N": ("N", 1.0), "kN": ("N", 1e3), "N m": ("N m", 1.0), "N s": ("N s", 1.0),
         "kg": ("kg", 1.0), "g": ("kg", 1e-3), "kg/s": ("kg/s", 1.0), "kg m/s": ("kg m/s", 1.0),
         "kg/m^3": ("kg/m^3", 1.0), "J": ("J", 1.0), "kJ": ("J", 1e3), "rad/s": ("rad/s", 1.0),
         "deg": ("deg", 1.0)}


def ending(unit: str) -> str:
    """How the name of a column ends that is in this unit.

    >>> ending("kg m/s"), ending("1")
    ('_kg_m_s', '')
    """
    return "" if unit in ("", "1") else "_" + re.sub("[ /]", "_", unit.replace("^", ""))


ENDINGS = {ending(unit): unit for unit in sorted(UNITS, key=len, reverse=True)}


def split(column: str) -> tuple[str, str]:
    """The name of a column without its unit, and the unit, "" where it says none.

    >>> split("U_x_m_s"), split("H2_mm"), split("t_over_T"), split("_s")
    (('U_x', 'm/s'), ('H2', 'mm'), ('t_over_T', ''), ('_s', ''))
    """
    found = next((end for end in ENDINGS if column.endswith(end) and column != end), "")
    return column[:len(column) - len(found)], ENDINGS.get(found, "")


def factor(unit: str, wanted: str) -> float | None:
    """What a value in `unit` is multiplied by to be in `wanted`; None for another quantity.

    >>> factor("kPa", "Pa"), factor("m", "mm"), factor("Pa", "m")
    (1000.0, 1000.0, None)
    """
    (base, scale), (other, over) = (UNITS.get(u, (u, 1.0)) for u in (unit, wanted))
    return scale / over if base == other else None
