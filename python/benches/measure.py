"""Measures the package, beside numba where it is installed, and prints a table.

    pip install . numba && pip install --group engines && python benches/measure.py

All times are of one core, the best of some rounds; those of engines and of tiles are of one run. The package is to be built in
release mode, as `pip install` does. Where KFRAC names the program, a part of a giant picture is drawn too.
"""

from __future__ import annotations

import importlib.util
import os
import resource
import runpy
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import kfrac
from kfrac.data import Batches, Dataset, write_parquet

HERE = Path(__file__).parent

SPEC = """
kind: dataset
categories: {systems: {random: {maps: [2, 7], sigma: anderson}, count: 300}}
picture: {size: SIZE, points: POINTS, mode: MODE}
"""


def spec(size: int = 256, points: str = "100k", mode: str = "hits") -> str:
    return SPEC.replace("SIZE", str(size)).replace("POINTS", points).replace("MODE", mode)


def dataset(size: int = 256, points: str = "100k", mode: str = "hits") -> Dataset:
    return Dataset.parse(spec(size, points, mode))


def best(work: Callable[[], object], rounds: int = 3) -> float:
    """Returns the shortest time of a call, in seconds."""
    times: list[float] = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return min(times)


def row(name: str, value: str) -> None:
    print(f"{name:<58} {value}")
    sys.stdout.flush()


def pictures() -> None:
    made = dataset()
    made.render(0, 300, threads=1)  # Draws the systems.
    arrays = best(lambda: made.render(0, 300, threads=1)) / 300
    row("arrays a second (256 x 256, 100 k points)", f"{1 / arrays:,.0f}  ({arrays * 1e3:.3f} ms)")
    png = best(lambda: [made.png(number) for number in range(300)]) / 300
    row("PNGs a second", f"{1 / png:,.0f}  ({png * 1e3:.3f} ms, {len(made.png(0)):,} bytes the first)")
    patches = dataset(362, "200k", "patch3")
    patches.render(0, 100, threads=1)
    million = best(lambda: [patches.png(number) for number in range(100)]) / 100 * 1e6 / 3600
    row("FractalDB-1k: 1 M PNGs, 362 x 362, 200 k points, patches", f"{million:.2f} core-hours")
    try:
        numba(made, arrays)
    except ImportError:
        row("beside numba", "numba is not installed")


def numba(made: Dataset, arrays: float) -> None:
    """Draws the same systems by a loop that numba compiles."""
    import numba as compiler  # pyright: ignore[reportMissingImports]

    @compiler.njit(fastmath=False)  # pyright: ignore
    def drawn(maps: Any, weights: Any, points: int, size: int, seed: int) -> Any:
        np.random.seed(seed)
        below = np.cumsum(weights) / weights.sum()
        places = np.empty((points, 2))
        x, y = 0.0, 0.0
        for step in range(points + 20):
            chosen = np.searchsorted(below, np.random.rand())
            a, b, c, d, e, f = maps[chosen]
            x, y = a * x + b * y + e, c * x + d * y + f
            if step >= 20:
                places[step - 20, 0] = x
                places[step - 20, 1] = y
        counts = np.zeros((size, size), dtype=np.uint32)
        low = np.array([places[:, 0].min(), places[:, 1].min()])
        high = np.array([places[:, 0].max(), places[:, 1].max()])
        scale = (size - 1) / (high - low)
        for point in range(points):
            column = int((places[point, 0] - low[0]) * scale[0])
            line = int((places[point, 1] - low[1]) * scale[1])
            counts[size - 1 - line, column] += 1
        return counts

    systems = [np.array(made.label(number)["maps"]) for number in range(100)]
    run = lambda: [drawn(maps[:, :6], maps[:, 6], 100_000, 256, 1) for maps in systems]  # noqa: E731
    run()
    one = best(run) / 100
    row("a loop by numba: arrays a second", f"{1 / one:,.0f}  ({one * 1e3:.2f} ms: {one / arrays:.1f} times as long)")


def elements() -> None:
    dragon = kfrac.load("dragon")
    for steps, threads in [(20, 1), (23, 1), (23, 2)]:
        taken = best(lambda: dragon.elements(steps, threads=threads))
        row(f"elements of dragon({steps}) to memory, {threads} thread(s)", f"{2**steps / taken / 1e6:.1f} M/s ({taken:.3f} s)")
    tree = kfrac.load("pythagoras")
    calls = 2000
    call = best(lambda: [tree.with_(angle=30) for _ in range(calls)]) / calls
    row("a call of with_", f"{call * 1e6:.1f} µs")
    call = best(lambda: [tree.forecast(3) for _ in range(calls)]) / calls
    row("a call of forecast", f"{call * 1e6:.1f} µs")
    call = best(lambda: [tree.title for _ in range(calls)]) / calls
    row("a call of title", f"{call * 1e6:.2f} µs")


def workers() -> None:
    try:
        from torch.utils.data import DataLoader  # pyright: ignore
    except ImportError:
        row("torch's DataLoader", "torch is not installed")
        return
    made = Dataset.parse(spec() + "instances: {count: 40}\n")
    made.render(0, len(made), threads=2)  # Draws the systems.
    batches = Batches(made, 250)
    loaders: dict[int, Any] = {
        workers: DataLoader(batches, batch_size=None, num_workers=workers)  # pyright: ignore
        for workers in (0, 2)
    }
    times = {workers: best(lambda: [None for _ in loader]) for workers, loader in loaders.items()}
    row("torch's DataLoader with 2 workers beside none", f"{times[0] / times[2]:.2f} times as fast")


ENGINES = {"dask": "distributed", "ray": "ray", "spark": "pyspark"}


def on_engine(name: str, count: int) -> float:
    """Returns the time in which workers write a data set of 6,000 pictures, in seconds, after a smaller one."""
    cluster = runpy.run_path(str(HERE.parent / "tests" / "cluster.py"), run_name="cluster")
    recipe = runpy.run_path(str(HERE.parent / "examples" / f"on_{name}.py"), run_name="recipe")
    made, parts = Dataset.parse(spec() + "instances: {count: 20}\n"), 24

    def written(part: int) -> int:
        with tempfile.TemporaryDirectory() as folder:
            write_parquet(made, Path(folder) / "part.parquet", shard=(part % parts + 1, parts))
        return part

    with cluster["CLUSTERS"][name](count):
        recipe["mapped"](written, range(4), 4)
        start = time.perf_counter()
        recipe["mapped"](written, range(parts), parts)
        return time.perf_counter() - start


def engines() -> None:
    for name, module in ENGINES.items():
        if importlib.util.find_spec(module) is None:
            row(name, f"{module} is not installed")
            continue
        if name == "spark" and shutil.which("java") is None:
            row(name, "there is no java")
            continue
        times: list[float] = []
        for count in [1, 2]:
            done = subprocess.run(
                [sys.executable, __file__, name, str(count)],
                env=os.environ | {"PYSPARK_PYTHON": sys.executable},
                stdout=subprocess.PIPE,
                text=True,
                check=True,
            )
            times.append(float(done.stdout.split()[-1]))
        row(f"{name}: a data set by 2 workers beside 1", f"{times[0] / times[1]:.2f} times as fast ({times[0]:.1f} s and {times[1]:.1f} s)")


def giant() -> None:
    """Draws a part of a pyramid of 2^17 pixels a side."""
    program = os.environ.get("KFRAC")
    if program is None:
        row("a pyramid of 2^17 pixels", "KFRAC does not name the program")
        return
    with tempfile.TemporaryDirectory() as folder:
        options = "--detail 1 --size 131072 --shard 1/64 --threads 1 --quiet".split()
        start = time.perf_counter()
        subprocess.run([program, "grow", "dragon", *options, "--tiles", folder], check=True, stdout=subprocess.DEVNULL)
        taken = time.perf_counter() - start
        count = len(list(Path(folder).rglob("*.png")))
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    row("1/64 of a pyramid of the dragon, 2^17 pixels a side", f"{taken:.0f} s, {count:,} tiles, {memory:.0f} MiB at most")


if __name__ == "__main__":
    if len(sys.argv) == 3:
        print(on_engine(sys.argv[1], int(sys.argv[2])))
        sys.exit()
    giant()  # First: the memory is the largest of all programs that have ended.
    pictures()
    elements()
    workers()
    engines()
