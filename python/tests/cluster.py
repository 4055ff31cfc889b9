"""Program of `test_engines.py`: the recipe of an engine on two workers, with one of them killed.

`cluster.py ENGINE FOLDER SCENARIO`, where FOLDER is an empty one that the workers share. It is a program of its own, because
engines leave threads, processes and handlers of signals behind.
"""

import os
import runpy
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

import kfrac
from kfrac.data import render

SPEC = """
kind: dataset
seed: 3
categories: {systems: [{random: {maps: [2, 5], sigma: anderson}, count: 6}, {rule: pythagoras, params: {angle: 'uniform(20, 70)'}}]}
instances: {count: 10, weights: jitter(0.1), flips: true}
picture: {size: 48, points: 20k}
"""

PARTS = 6

GASKET = "{kind: ifs, vertices: {points: [[0, 0], [1, 0], [0.5, 0.8]], shrink: 1/2}}"


def recipe(name: str) -> SimpleNamespace:
    """Loads an example without running its last block."""
    path = Path(__file__).parent.parent / "examples" / f"{name}.py"
    return SimpleNamespace(**runpy.run_path(str(path), run_name="recipe"))


@contextmanager
def dask_cluster(workers: int) -> Any:
    from dask.distributed import Client

    with Client(n_workers=workers, threads_per_worker=1, dashboard_address=None) as client:
        yield client


@contextmanager
def ray_cluster(workers: int) -> Any:
    import ray

    ray.init(num_cpus=workers, include_dashboard=False)
    try:
        yield
    finally:
        ray.shutdown()


@contextmanager
def spark_cluster(workers: int) -> Any:
    from pyspark.sql import SparkSession

    spark = SparkSession.builder.master(f"local[{workers},4]").config("spark.ui.enabled", "false").getOrCreate()
    try:
        yield
    finally:
        spark.stop()


CLUSTERS: dict[str, Callable[[int], AbstractContextManager[Any]]] = {
    "dask": dask_cluster,
    "ray": ray_cluster,
    "spark": spark_cluster,
}


def fatal_once(folder: Path, name: str) -> Callable[[], None]:
    """Returns a function that counts its calls in files, and kills the process of the third one."""

    def count() -> None:
        for number in range(100):
            try:
                (folder / f"{name}-{number}").touch(exist_ok=False)
            except FileExistsError:
                continue
            if number == 2:
                (folder / f"{name}-killed").write_text(str(os.getpid()))
                # Ray may abort if a worker dies while the result of its task before arrives.
                time.sleep(2)
                os.kill(os.getpid(), signal.SIGKILL)
            return

    return count


def fatal_path(path: Path, count: Callable[[], None]) -> os.PathLike[str]:
    """Returns the path of a file, the reading of which kills a worker."""

    class Fatal(os.PathLike[str]):
        def __fspath__(self) -> str:
            count()
            return str(path)

    return Fatal()


def check_kill(folder: Path, name: str) -> None:
    """Checks that a worker, and not this process, was killed, and that its part was done again."""
    assert int((folder / f"{name}-killed").read_text()) != os.getpid()
    calls = len([path for path in folder.glob(f"{name}-*") if path.name.split("-")[1].isdigit()])
    assert calls > PARTS, calls


def same(engine: SimpleNamespace, folder: Path) -> None:
    """A data set and a family, each with a worker killed in the middle; then a mistake of a worker."""
    spec = folder / "set.yaml"
    spec.write_text(SPEC)
    numbers = range(5, 65)
    expected = render(spec, numbers, threads=1)
    found = engine.pictures(fatal_path(spec, fatal_once(folder, "picture")), numbers, PARTS)
    check_kill(folder, "picture")
    for one, other in zip(expected, found):
        assert (one.dtype, one.shape) == (other.dtype, other.shape)
        assert one.tobytes() == other.tobytes()

    family = kfrac.sweep("pythagoras", angle=np.linspace(10, 80, 12))
    count = fatal_once(folder, "tree")

    def drawn(tree: kfrac.Fractal) -> bytes:
        count()
        return tree.png(7, size=100, threads=1)

    pictures = engine.mapped(drawn, family, PARTS)
    check_kill(folder, "tree")
    assert pictures == [tree.png(7, size=100) for tree in family]

    large(engine, folder)

    def wrong(number: int) -> kfrac.Fractal:
        return kfrac.parse("kind: ifs\nvertces: []\n" if number == 4 else GASKET)

    try:
        engine.mapped(lambda number: wrong(number).name, range(6), PARTS)
    except kfrac.KfracError as error:
        diagnostic = error.diagnostics[0]
        assert (diagnostic.line, diagnostic.column) == (2, 1), error.diagnostics
        assert diagnostic.hint is not None and "did you mean 'vertices'" in diagnostic.hint, diagnostic
    else:
        raise AssertionError("the mistake is not reported")


def large(engine: SimpleNamespace, folder: Path) -> None:
    """Boxes, points and tiles of a large picture."""
    giant = recipe("giant")

    def here(function: Callable[[Any], Any], values: Any, parts: int) -> list[Any]:
        return [function(value) for value in values]

    koch, fern = kfrac.load("koch"), kfrac.load("barnsley-fern")
    found, expected = (giant.boxes(mapped, koch, 512, 64, PARTS) for mapped in (engine.mapped, here))
    assert np.array_equal(found, expected), (found, expected)
    # The slope of the counts between boxes of 4 and of 32 pixels is about the dimension.
    assert abs(np.log2(found[2] / found[5]) / 3 - np.log(4) / np.log(3)) < 0.1, found
    found, expected = (giant.cloud(mapped, fern, 100_003, 64, PARTS) for mapped in (engine.mapped, here))
    assert np.array_equal(found, expected) and found.sum() == 100_003

    if program := os.environ.get("KFRAC"):
        pyramids = [folder / "shared", folder / "alone"]
        giant.tiles(engine.mapped, "koch", 1024, str(pyramids[0]), PARTS, program)
        giant.tiles(here, "koch", 1024, str(pyramids[1]), 1, program)
        files = [{path.relative_to(it): path.read_bytes() for path in it.rglob("*") if path.is_file()} for it in pyramids]
        assert len(files[0]) > 20 and files[0] == files[1]


def interrupted(engine: SimpleNamespace, folder: Path) -> None:
    """An interrupt, while workers do what takes hours."""
    began = folder / "began"

    def endless(fern: kfrac.Fractal) -> int:
        began.touch()
        return int(fern.histogram(10**12, 64, threads=1).sum())

    def interrupt() -> None:
        while not began.exists():
            time.sleep(0.05)
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt, daemon=True).start()
    try:
        engine.mapped(endless, [kfrac.load("barnsley-fern")] * 2, 2)
    except KeyboardInterrupt:
        return
    raise AssertionError("the interrupt is not raised")


if __name__ == "__main__":
    # A shell that runs a program in the background lets it ignore interrupts.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    name, folder, scenario = sys.argv[1], Path(sys.argv[2]), sys.argv[3]
    with CLUSTERS[name](2):
        {"same": same, "interrupted": interrupted}[scenario](recipe(f"on_{name}"), folder)
    print("done", flush=True)
