"""Pictures, histograms and notebooks."""

import struct
import zlib

import numpy as np
import pytest
from numpy.typing import NDArray

import kfrac


def size_of(png: bytes) -> tuple[int, int]:
    """Returns width and height in the header of a PNG."""
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    return struct.unpack(">II", png[16:24])


def test_pictures_have_their_sizes(pythagoras: kfrac.Fractal) -> None:
    assert size_of(pythagoras.png(6, size=200))[0] == 200
    assert size_of(pythagoras.png(6, size=(120, 80))) == (120, 80)
    pixels = pythagoras.pixels(6, size=(120, 80))
    assert (pixels.shape, pixels.dtype) == ((80, 120, 4), np.uint8)
    assert pixels.flags.c_contiguous and pixels.flags.writeable
    assert 0 < (pixels[..., 3] > 0).mean() < 1
    svg = pythagoras.svg(6)
    assert svg.startswith("<svg") and 'width="1024"' in svg
    for size in [0, (0, 5)]:
        with pytest.raises(ValueError, match="at least 1 pixel"):
            pythagoras.png(size=size)
    with pytest.raises(ValueError, match="detail"):
        pythagoras.png(detail=-1)


def test_views_are_parts_of_the_whole() -> None:
    koch = kfrac.load("koch")
    whole = koch.pixels(5, size=(128, 128), view=(0, -0.25, 1, 1)).astype(int)
    part = koch.pixels(5, size=(64, 64), view=(0.5, -0.25, 0.5, 0.5)).astype(int)
    assert np.abs(whole[64:, 64:] - part).max() <= 2 and 0 < (part[..., 3] > 0).mean() < 1
    assert size_of(koch.png(5, size=60, view=(0, 0, 0.5, 0.25))) == (60, 30)
    for view in [(0, 0, 0, 1), (0, 0, 1, float("nan"))]:
        with pytest.raises(ValueError, match="a view is"):
            koch.png(view=view)
    with pytest.raises(ValueError, match="each select"):
        koch.zoom(10, "0.(1)").png(view=(0, 0, 1, 1))
    with pytest.raises(kfrac.KfracError, match="window"):
        kfrac.load("menger").png(2, size=20, view=(0, 0, 1, 1))


def test_results_do_not_depend_on_threads(pythagoras: kfrac.Fractal, fern: kfrac.Fractal) -> None:
    assert pythagoras.png(8, threads=1) == pythagoras.png(8, threads=3)
    one, three = (fern.histogram(500_000, 64, threads=threads) for threads in (1, 3))
    assert np.array_equal(one, three)


def random_walk(maps: NDArray[np.float64], weights: NDArray[np.float64], points: int) -> NDArray[np.float64]:
    """Returns points of the attractor by an independent iteration: rows of a, b, c, d, e, f with x' = a x + b y + e."""
    random = np.random.default_rng(1)
    walkers = np.zeros((10_000, 2))
    steps = 50 + points // len(walkers)
    found: list[NDArray[np.float64]] = []
    for step in range(steps):
        chosen = maps[random.choice(len(maps), len(walkers), p=weights)]
        x, y = walkers.T
        walkers = np.stack([chosen[:, 0] * x + chosen[:, 1] * y + chosen[:, 4], chosen[:, 2] * x + chosen[:, 3] * y + chosen[:, 5]], axis=1)
        if step >= 50:
            found.append(walkers)
    return np.concatenate(found)


def test_histograms_are_those_of_another_renderer() -> None:
    maps = np.array([[0.5, -0.3, 0.2, 0.4, 0.1, 0.3], [0.4, 0.2, -0.5, 0.3, 0.7, -0.2], [-0.3, 0.1, 0.2, 0.5, 0.2, 0.9]])
    weights = np.array([0.5, 0.3, 0.2])
    entries = "".join(
        f"\n  - {{matrix: [[{a}, {b}], [{c}, {d}]], shift: [{e}, {f}], weight: {weight}}}"
        for (a, b, c, d, e, f), weight in zip(maps, weights)
    )
    system = kfrac.parse(f"kind: ifs\nmaps:{entries}")
    counts = system.histogram(2_000_000, (64, 64))
    assert (counts.dtype, counts.shape, counts.sum()) == (np.uint32, (64, 64), 2_000_000)
    points = random_walk(maps, weights, 2_000_000)
    low, high = np.array(system.bounds(60))
    assert np.allclose([points.min(axis=0), points.max(axis=0)], [low, high], atol=0.02)
    # One scale for both axes, centred, as the picture has it.
    side = (high - low).max()
    corner = (low + high - side) / 2
    edges = [np.linspace(corner[axis], corner[axis] + side, 65) for axis in (0, 1)]
    expected = np.histogram2d(points[:, 0], points[:, 1], bins=(edges[0], edges[1]))[0].T[::-1]
    assert np.corrcoef(counts.ravel(), expected.ravel())[0, 1] > 0.99


def test_histograms_are_for_systems(pythagoras: kfrac.Fractal, fern: kfrac.Fractal) -> None:
    with pytest.raises(kfrac.KfracError, match="systems of maps"):
        pythagoras.histogram()
    with pytest.raises(kfrac.KfracError, match="counters"):
        fern.histogram(100, 30_000)
    assert fern.histogram(1000, 32, seed=1).sum() == 1000
    assert not np.array_equal(fern.histogram(1000, 32, seed=1), fern.histogram(1000, 32, seed=2))


def test_zooms_have_no_limit() -> None:
    koch = kfrac.load("koch")
    near, far = koch.zoom(3**40, at="0.(1)"), koch.zoom("3^4000", at="0.(1)")
    assert far.pixels(size=64).any()
    # The curve is similar to itself about the point.
    assert np.array_equal(near.pixels(size=64), far.pixels(size=64))
    with pytest.raises(kfrac.KfracError):
        koch.zoom("much", at="0.(1)")
    with pytest.raises(kfrac.KfracError):
        koch.zoom(3, at="here")


def test_pictures_are_repeated() -> None:
    dragon = kfrac.load("dragon")
    pixels = dragon.repeat("p4", periods=2).pixels(8, size=(200, 200)).astype(float)
    assert pixels.std() > 10
    assert np.abs(pixels[:100] - pixels[100:]).mean() < 1
    assert np.abs(pixels[:, :100] - pixels[:, 100:]).mean() < 1
    with pytest.raises(ValueError, match="no group 'p5'"):
        dragon.repeat("p5")
    with pytest.raises(ValueError, match="cell"):
        dragon.repeat("p1", cell=0)
    with pytest.raises(kfrac.KfracError, match="plane"):
        kfrac.load("menger").repeat("p1").png(1, size=64)


def test_notebooks_show_svg_or_png() -> None:
    small = kfrac.load("koch")._repr_mimebundle_()
    assert set(small) == {"text/plain", "image/svg+xml"}
    svg = small["image/svg+xml"]
    assert isinstance(svg, str) and len(svg) < 300_000
    large = kfrac.load("barnsley-fern")._repr_mimebundle_()
    assert set(large) == {"text/plain", "image/png"}
    png = large["image/png"]
    assert isinstance(png, bytes) and max(size_of(png)) == 512
    zlib.crc32(png)
