"""Families of fractals: all combinations of values of parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from ._kfrac import Fractal

T = TypeVar("T")

Number = float | complex


class Sweep(Sequence[Fractal]):
    """Sequence of fractals with different values of parameters; the last parameter varies fastest.

    Members are made when they are asked for. A sweep can be sliced, pickled and shared between workers.
    """

    def __init__(self, fractal: Fractal, values: dict[str, list[Number]], numbers: range) -> None:
        self._fractal = fractal
        self._values = values
        self._numbers = numbers

    def __len__(self) -> int:
        return len(self._numbers)

    def _of(self, number: int) -> dict[str, Number]:
        """Returns the values of the member with a number among all combinations."""
        chosen: dict[str, Number] = {}
        for name, values in reversed(self._values.items()):
            number, place = divmod(number, len(values))
            chosen[name] = values[place]
        return {name: chosen[name] for name in self._values}

    @overload
    def __getitem__(self, index: int) -> Fractal: ...
    @overload
    def __getitem__(self, index: slice) -> Sweep: ...
    def __getitem__(self, index: int | slice) -> Fractal | Sweep:
        if isinstance(index, slice):
            return Sweep(self._fractal, self._values, self._numbers[index])
        return self._fractal.with_(**self._of(self._numbers[index]))

    @property
    def parameters(self) -> dict[str, NDArray[np.float64 | np.complex128]]:
        """Values of each parameter, one for each member: arrays of shape (members,)."""
        rows = [self._of(number) for number in self._numbers]
        return {name: np.array([row[name] for row in rows]) for name in self._values}

    def map(self, function: Callable[[Fractal], T], *, threads: int | None = None) -> list[T]:
        """Returns the results of a function for all members, in their order.

        Members are shared between threads: drawing and measuring run without the interpreter's lock. Where the function
        takes `threads=1` to its methods, cores are used evenly.
        """
        with ThreadPoolExecutor(threads) as pool:
            return list(pool.map(function, self))

    def __repr__(self) -> str:
        values = ", ".join(f"{name}: {len(values)}" for name, values in self._values.items())
        return f"<kfrac.Sweep of {self._fractal.name!r}: {len(self)} fractals; {values}>"


def sweep(fractal: Fractal | str, /, **parameters: Iterable[Number] | Number) -> Sweep:
    """Returns the fractals with all combinations of values of parameters.

    Parameters
    ----------
    fractal : Fractal or str
        A fractal, or what `load` takes.
    **parameters : iterable of numbers, or number
        Values of each parameter.

    Returns
    -------
    Sweep
        Sequence of fractals; the last parameter varies fastest.

    Raises
    ------
    KfracError
        If the file has no such parameter. Values out of range are reported where their member is made.
    """
    if not isinstance(fractal, Fractal):
        from ._kfrac import load

        fractal = load(fractal)
    values: dict[str, list[Number]] = {}
    for name, given in parameters.items():
        listed = list(given) if isinstance(given, Iterable) else [given]
        values[name] = [value if isinstance(value, complex) else float(value) for value in listed]
    count = 1
    for listed in values.values():
        count *= len(listed)
    swept = Sweep(fractal, values, range(count))
    if count > 0:
        swept[0]  # Reports parameters that the file does not have.
    return swept
