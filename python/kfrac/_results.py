"""Results of fractals as named tuples, and what unpickles fractals."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from ._kfrac import Fractal


class Diagnostic(NamedTuple):
    """Message about a file. Line and column count from 1; a message about the whole file has none."""

    file: str | None
    line: int | None
    column: int | None
    severity: str
    """"error" or "warning"."""
    message: str
    hint: str | None
    """Remedy, if one is known."""


class Bounds(NamedTuple):
    """Smallest box around a set: (x, y), or (x, y, z) in space, in the file's units. y points up."""

    min: tuple[float, ...]
    max: tuple[float, ...]


class Dimension(NamedTuple):
    """Dimension of a limit set."""

    value: float
    """Hausdorff dimension if it is exact, box dimension if it is measured."""
    std_error: float | None
    """Standard error of a measured value; None for an exact one."""
    closed_form: str | None
    """Equal expression, where one is known: "log(4)/log(3)"."""


class Forecast(NamedTuple):
    """Sizes of an approximant."""

    elements: int
    """Number of elements, infertile and invisible ones included."""
    fertile: int
    """Number of elements that the next step replaces."""
    fractals: int
    """Number of fractals that have been started: 1, and one for every seed."""
    length: float | None
    """Sum of the lengths of all elements, in the file's units; None if it is not determined."""
    area: float | None
    """Sum of the areas that closed outlines enclose, in square units; None if an outline is open."""


class Distance(NamedTuple):
    """Hausdorff distance of two sets, in the unit of their files."""

    value: float
    """Larger one of `there` and `back`."""
    error: float
    """Bound of the error of all distances."""
    there: float
    """Largest distance of a point of the first set from the second."""
    back: float
    """Largest distance of a point of the second set from the first."""
    same: bool
    """Whether the distance is within its error."""


class Entry(NamedTuple):
    """Fractal of the library."""

    name: str
    kind: str
    title: str | None
    tags: list[str]
    source: str | None


class Fit(NamedTuple):
    """System of maps that was fitted to a picture."""

    fractal: Fractal
    """The system; its unit is a pixel, and its view the frame of the picture."""
    iou: float
    """Intersection over union of attractor and shape."""
    hausdorff: float
    """Hausdorff distance of attractor and shape, in pixels."""
    exact: bool
    """Whether the pictures are the same."""
    method: str
    """Method by which it was found."""


def restore(
    text: str,
    name: str,
    zoom: tuple[str, str, float] | None,
    repetition: tuple[str, float, int] | None = None,
) -> Fractal:
    """Returns a fractal that was pickled."""
    from ._kfrac import parse

    fractal = parse(text, name)
    if zoom is not None:
        fractal = fractal.zoom(*zoom)
    if repetition is not None:
        group, cell, periods = repetition
        fractal = fractal.repeat(group, cell=cell, periods=periods)
    return fractal
