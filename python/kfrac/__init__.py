"""Linear fractals: grown from production rules, drawn and measured.

>>> import kfrac
>>> tree = kfrac.load("pythagoras", angle=30)
>>> tree.forecast(8).elements
766
>>> tree.elements(8)["x0"].dtype
dtype('float64')

`load` reads a file or a fractal of the library, `parse` a text; `library` lists the library. A `Fractal` draws itself
(`svg`, `png`, `pixels`, `histogram`), lists its elements (`elements`) and measures itself (`info`, `forecast`, `bounds`,
`dimension`, `compare`). `sweep` is a family of fractals, and `fit` finds a system of maps for a picture. A mistake in a file
or an argument is a `KfracError`.
"""

from ._kfrac import Fractal, KfracError, Table, fit, library, load, parse
from ._results import Bounds, Diagnostic, Dimension, Distance, Entry, Fit, Forecast
from ._sweep import Sweep, sweep

__all__ = [
    "Bounds",
    "Diagnostic",
    "Dimension",
    "Distance",
    "Entry",
    "Fit",
    "Forecast",
    "Fractal",
    "KfracError",
    "Sweep",
    "Table",
    "fit",
    "library",
    "load",
    "parse",
    "sweep",
]
