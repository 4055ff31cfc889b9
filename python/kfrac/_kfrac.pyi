"""Types of the compiled module."""

from collections.abc import Mapping
from os import PathLike
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._results import Bounds, Diagnostic, Dimension, Distance, Entry, Fit, Forecast

Size = int | tuple[int, int]
View = tuple[float, float, float, float]

class KfracError(ValueError):
    """Mistake in a file or an argument."""

    diagnostics: list[Diagnostic]
    """Mistakes in a file, each with its place; empty for other mistakes."""

class Table:
    """Elements of an approximant, in order of traversal, column by column."""

    def __len__(self) -> int: ...
    @property
    def columns(self) -> list[str]: ...
    def keys(self) -> list[str]: ...
    def __getitem__(self, name: str, /) -> NDArray[Any]: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...
    def ragged(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]: ...
    def lines(self) -> NDArray[np.object_]: ...

class Fractal:
    """Linear fractal: a rule, a system of maps, a structure or an L-system, with values of its parameters."""

    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> Literal["rule", "ifs", "instancing", "lsystem"]: ...
    @property
    def title(self) -> str | None: ...
    @property
    def space(self) -> Literal[2, 3]: ...
    @property
    def parameters(self) -> dict[str, float | complex]: ...
    def with_(self, **parameters: float | complex) -> Fractal: ...
    def zoom(self, factor: str | float, at: str, turn: float = 0.0) -> Fractal: ...
    def elements(
        self,
        steps: int | None = None,
        *,
        seed: int = 0,
        max_elements: int = 50_000_000,
        threads: int | None = None,
    ) -> Table: ...
    def svg(
        self,
        steps: int | None = None,
        *,
        size: Size = 1024,
        detail: float | None = None,
        view: View | None = None,
        seed: int = 0,
        max_elements: int = 50_000_000,
        threads: int | None = None,
    ) -> str: ...
    def png(
        self,
        steps: int | None = None,
        *,
        size: Size = 1024,
        detail: float | None = None,
        view: View | None = None,
        seed: int = 0,
        max_elements: int = 50_000_000,
        threads: int | None = None,
    ) -> bytes: ...
    def pixels(
        self,
        steps: int | None = None,
        *,
        size: Size = 512,
        detail: float | None = None,
        view: View | None = None,
        seed: int = 0,
        max_elements: int = 50_000_000,
        threads: int | None = None,
    ) -> NDArray[np.uint8]: ...
    def write(
        self,
        path: str | PathLike[str],
        steps: int | None = None,
        *,
        size: Size = 1024,
        detail: float | None = None,
        view: View | None = None,
        seed: int = 0,
        max_elements: int = 50_000_000,
        threads: int | None = None,
    ) -> None: ...
    def histogram(
        self,
        points: int = 10_000_000,
        size: Size = 512,
        *,
        seed: int = 0,
        threads: int | None = None,
    ) -> NDArray[np.uint32]: ...
    def info(self, steps: int | None = None, *, seed: int = 0) -> dict[str, Any]: ...
    def forecast(self, steps: int | None = None, *, seed: int = 0) -> Forecast | None: ...
    def dimension(self) -> Dimension: ...
    def bounds(self, steps: int | None = None, *, seed: int = 0) -> Bounds: ...
    def check(self) -> list[Diagnostic]: ...
    def yaml(self) -> str: ...
    def compare(self, other: Fractal, *, steps: int | None = None, tolerance: float = 1e-3) -> Distance: ...
    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> Mapping[str, str | bytes]: ...

class Dataset:
    """Data set of pictures with labels: a file of the kind `dataset`."""

    def __init__(self, path: str | PathLike[str]) -> None: ...
    @staticmethod
    def parse(text: str, name: str = "dataset.yaml") -> Dataset: ...
    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> tuple[NDArray[np.uint8], int]: ...
    def __getitems__(self, indices: list[int]) -> list[tuple[NDArray[np.uint8], int]]: ...
    @property
    def categories(self) -> int: ...
    @property
    def instances(self) -> int: ...
    @property
    def size(self) -> int: ...
    @property
    def text(self) -> str: ...
    def png(self, index: int) -> bytes: ...
    def label(self, index: int) -> dict[str, Any]: ...
    def category(self, number: int) -> str: ...
    def shard(self, number: int, count: int) -> tuple[int, int]: ...
    def render(
        self, start: int, stop: int, *, threads: int | None = None
    ) -> tuple[NDArray[np.uint8], NDArray[np.int64]]: ...

def load(name: str | PathLike[str], /, **parameters: float | complex) -> Fractal: ...
def parse(text: str, /, name: str = "text", **parameters: float | complex) -> Fractal: ...
def library(*, tag: str | None = None, kind: str | None = None) -> list[Entry]: ...
def fit(
    picture: NDArray[np.bool_],
    *,
    maps: int | tuple[int, int] = (2, 8),
    method: Literal["auto", "collage", "skeleton", "moments"] = "auto",
    similar: bool = False,
    effort: int = 20_000,
    seed: int = 0,
    threads: int | None = None,
) -> Fit: ...
