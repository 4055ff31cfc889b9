"""Pictures that are too large for one machine, and clouds of many points, by the `mapped` of the recipe of an engine."""

import subprocess
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import kfrac

Mapped = Callable[[Callable[[Any], Any], Sequence[Any], int], list[Any]]


def windows(fractal: kfrac.Fractal, size: int, tile: int) -> list[tuple[float, float, float, float]]:
    """Returns the parts of the plane that the tiles of a square picture show. `tile` divides `size`."""
    info = fractal.info()
    known = np.array([box for box in (info["bounds"], info["limit_bounds"]) if box])
    low, high = known[:, 0].min(axis=0), known[:, 1].max(axis=0)
    side = (high - low).max()
    corner, own = (low + high - side) / 2, side * tile / size
    numbers = range(size // tile)
    return [(corner[0] + column * own, corner[1] + row * own, own, own) for row in numbers for column in numbers]


def boxes(mapped: Mapped, fractal: kfrac.Fractal, size: int, tile: int, parts: int) -> NDArray[np.int64]:
    """Counts the boxes of 1, 2, 4, ... `tile` pixels in which a pixel is at least half opaque. `tile`, a power of two, divides
    `size`, and the style has no background. Lines are as wide as in a picture of the size of a tile."""
    sizes = [1 << level for level in range(tile.bit_length())]

    def count(window: tuple[float, float, float, float]) -> NDArray[np.int64]:
        opacity = fractal.pixels(size=(tile, tile), detail=1, view=window, threads=1)[..., 3]
        scales = [opacity.reshape(tile // box, box, tile // box, box).max(axis=(1, 3)) for box in sizes]
        return np.array([np.count_nonzero(scale > 127) for scale in scales])

    return np.sum(mapped(count, windows(fractal, size, tile), parts), axis=0)


def cloud(mapped: Mapped, system: kfrac.Fractal, points: int, size: int, parts: int) -> NDArray[np.uint32]:
    """Counts points of random iteration in pixels. Each part draws a share of them, with a seed of its own."""
    shares = [(part, points // parts + (part < points % parts)) for part in range(parts)]
    counts = mapped(lambda it: system.histogram(it[1], size, seed=it[0], threads=1), shares, parts)
    return np.asarray(sum(counts[1:], start=counts[0]), dtype=np.uint32)


def tiles(mapped: Mapped, rule: str, size: int, folder: str, parts: int, program: str = "kfrac") -> None:
    """Draws a pyramid of tiles into a folder that the machines share, by the program `kfrac`; the last part completes it."""

    def draw(part: int) -> None:
        options = ["--size", str(size), "--detail", "1", "--tiles", folder, "--shard", f"{part + 1}/{parts}"]
        subprocess.run([program, "grow", rule, *options, "--quiet", "--threads", "1"], check=True)

    mapped(draw, range(parts), parts)


if __name__ == "__main__":
    # Here in this process; on a cluster by the function of the same name in on_dask.py, on_ray.py or on_spark.py.
    def mapped(function: Callable[[Any], Any], values: Sequence[Any], parts: int) -> list[Any]:
        return [function(value) for value in values]

    counts = boxes(mapped, kfrac.load("koch"), size=2048, tile=256, parts=8)
    slopes = np.log2(counts[:-1] / counts[1:])
    print("boxes", counts, "slopes", slopes.round(2))
    fern = cloud(mapped, kfrac.load("barnsley-fern"), points=1_000_000, size=256, parts=8)
    print("points", fern.sum(), "in", np.count_nonzero(fern), "pixels")
