"""Work beside the interpreter: its lock, interrupts, forks, threads."""

import multiprocessing
import os
import signal
import sys
import sysconfig
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import kfrac

ENDLESS = 10**12
"""Number of points whose count takes hours."""


def interrupt_soon() -> None:
    """Interrupts the process from another thread, which runs only if the main one has released the lock."""
    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()


@pytest.fixture
def interrupts() -> Iterator[None]:
    """Interrupts raise exceptions, also where the tests run in the background and ignore them."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of Unix")
@pytest.mark.usefixtures("interrupts")
def test_an_interrupt_ends_work(fern: kfrac.Fractal) -> None:
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        fern.histogram(ENDLESS, 64)
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        kfrac.load("koch").png(20, size=64, detail=None, max_elements=ENDLESS * 10)
    # What was interrupted leaves nothing behind.
    assert fern.histogram(1000, 16).sum() == 1000


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of Unix")
def test_a_handler_of_signals_may_work_itself(fern: kfrac.Fractal) -> None:
    forecasts: list[int] = []

    def handle(*_: object) -> None:
        forecast = kfrac.load("koch").forecast(len(forecasts))
        assert forecast is not None
        forecasts.append(forecast.elements)
        if len(forecasts) == 3:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handle)
    signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)
    try:
        with pytest.raises(KeyboardInterrupt):
            fern.histogram(ENDLESS, 64)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert forecasts == [1, 4, 16]


def test_threads_share_fractals(fern: kfrac.Fractal) -> None:
    expected = [fern.histogram(50_000, 64, seed=seed) for seed in range(8)]
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda seed: fern.histogram(50_000, 64, seed=seed, threads=2), range(8)))
    assert all(np.array_equal(one, other) for one, other in zip(expected, found))


def draw(fractal: kfrac.Fractal, angle: float) -> bytes:
    return fractal.with_(angle=angle).png(7, size=100, threads=2)


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="there is no fork")
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_forked_workers_draw(pythagoras: kfrac.Fractal) -> None:
    angles = [20.0, 35.0, 50.0, 65.0]
    # Work has been done before, in threads, when the process forks.
    expected = [draw(pythagoras, angle) for angle in angles]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.starmap(draw, [(pythagoras, angle) for angle in angles])
    assert found == expected


def test_spawned_workers_draw(pythagoras: kfrac.Fractal) -> None:
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        [found] = pool.starmap(draw, [(pythagoras, 40.0)])
    assert found == draw(pythagoras, 40.0)


@pytest.mark.skipif(not sysconfig.get_config_var("Py_GIL_DISABLED"), reason="this interpreter has a lock")
def test_the_module_does_not_bring_the_lock_back() -> None:
    assert not sys._is_gil_enabled()  # pyright: ignore
