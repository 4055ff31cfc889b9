"""Reading, parameters, numbers and mistakes."""

import copy
import math
import pickle
from pathlib import Path

import pytest

import kfrac

KOCH = """
title: A curve
params: {height: sqrt(3)/6}
initiator: segment
generator: [[0, 0], [1/3, 0], [1/2, height], [2/3, 0], [1, 0]]
"""


def test_a_file_and_a_name_are_loaded(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(KOCH)
    mine = kfrac.load(file)
    assert (mine.name, mine.kind, mine.title, mine.space) == ("mine", "rule", "A curve", 2)
    assert mine.compare(kfrac.load("koch"), tolerance=0.01).same
    assert kfrac.load("menger").space == 3


def test_parameters_make_members_of_a_family(pythagoras: kfrac.Fractal) -> None:
    tree = kfrac.load("pythagoras", angle=30)
    assert tree.parameters == {"angle": 30.0}
    assert pythagoras.with_(angle=30).yaml() == tree.yaml()
    assert pythagoras.parameters != tree.parameters
    assert pythagoras.with_().yaml() == pythagoras.yaml()
    with pytest.raises(kfrac.KfracError, match="did you mean 'angle'"):
        pythagoras.with_(angel=30)
    with pytest.raises(TypeError, match="is no number"):
        pythagoras.with_(angle="30")  # pyright: ignore[reportArgumentType]


def test_complex_parameters_are_complex_numbers() -> None:
    text = "kind: ifs\nparams: {s: [0.5, 0.25]}\nmaps: [{times: s}, {times: s, shift: [1, 0]}]"
    system = kfrac.parse(text)
    assert system.parameters == {"s": 0.5 + 0.25j}
    turned = system.with_(s=0.5j)
    assert turned.parameters == {"s": 0.5j}
    assert kfrac.parse(turned.yaml()).parameters == {"s": 0.5j}


def test_mistakes_have_their_places() -> None:
    text = "params: {height: 1/3}\ninitiator: segment\ngenerator: [[0, 0], [1/3, hight], [1, o]]\n"
    with pytest.raises(kfrac.KfracError) as caught:
        kfrac.parse(text, name="mine.yaml")
    error = caught.value
    assert isinstance(error, ValueError)
    places = [(found.file, found.line, found.column) for found in error.diagnostics]
    assert places == [("mine.yaml", 3, 27), ("mine.yaml", 3, 39)]
    first = error.diagnostics[0]
    assert first.severity == "error"
    assert first.hint == "did you mean 'height'?"
    again = pickle.loads(pickle.dumps(error))
    assert again.diagnostics == error.diagnostics
    assert str(again) == str(error)


def test_check_reports_warnings() -> None:
    assert kfrac.load("koch").check() == []
    found = kfrac.parse(KOCH.replace("[1/2, height]", "[1/2, 0.3]")).check()
    assert [(it.severity, it.line) for it in found] == [("warning", 3)]


def test_numbers_are_those_of_the_closed_forms() -> None:
    koch = kfrac.load("koch")
    forecast = koch.forecast(2000)
    assert forecast is not None
    assert forecast.elements == 4**2000
    assert forecast.fertile == 4**2000
    small = koch.forecast(5)
    assert small is not None
    assert small.length == pytest.approx((4 / 3) ** 5)
    huge = kfrac.load("dragon").forecast(20_000)
    assert huge is not None
    assert huge.elements == 2**20_000
    dimension = koch.dimension()
    assert dimension.value == pytest.approx(math.log(4) / math.log(3))
    assert (dimension.std_error, dimension.closed_form) == (None, "log(4)/log(3)")
    low, high = koch.bounds(1)
    assert low == (0.0, 0.0) and high == pytest.approx((1.0, math.sqrt(3) / 6))
    assert kfrac.load("menger").bounds(2) == kfrac.Bounds((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))


def test_info_describes_the_steps() -> None:
    info = kfrac.load("koch").info(4)
    assert info["elements"] == [4**step for step in range(5)]
    assert info["length"] == pytest.approx([(4 / 3) ** step for step in range(5)])
    assert (info["kind"], info["steps"], info["random"], info["regular"]) == ("rule", 4, False, True)
    assert info["dimension"].closed_form == "log(4)/log(3)"
    assert info["similarity_dimension"] == pytest.approx(info["dimension"].value)
    assert info["limit_bounds"].max == pytest.approx((1.0, math.sqrt(3) / 6))
    space = kfrac.load("menger").info(2)
    assert space["elements"] == [1, 20, 400]
    assert len(space["bounds"].min) == 3


def test_distances_have_errors() -> None:
    koch, straight = kfrac.load("koch"), kfrac.parse("initiator: segment\ngenerator: [[0, 0], [1/2, 0], [1, 0]]")
    distance = koch.compare(straight)
    assert distance.value == pytest.approx(math.sqrt(3) / 6, abs=distance.error)
    assert not distance.same and distance.error < 2e-3
    assert koch.compare(straight, steps=0).same
    with pytest.raises(kfrac.KfracError, match="space"):
        koch.compare(kfrac.load("menger"))
    with pytest.raises(ValueError, match="tolerance"):
        koch.compare(straight, tolerance=0)


def test_fractals_are_pickled(pythagoras: kfrac.Fractal) -> None:
    changed = pythagoras.with_(angle=27)
    for tree in [changed.zoom("3^50", at="0.(1)"), changed.repeat("pmm", cell=1.5, periods=2)]:
        for again in [pickle.loads(pickle.dumps(tree)), copy.deepcopy(tree)]:
            assert (again.name, again.parameters) == (tree.name, tree.parameters)
            assert again.png(size=64) == tree.png(size=64)


def test_the_library_is_listed() -> None:
    plants = kfrac.library(tag="plant")
    names = [entry.name for entry in plants]
    assert "barnsley-fern" in names and "koch" not in names
    assert all("plant" in entry.tags for entry in plants)
    everything = kfrac.library()
    assert len(everything) > 100
    systems = kfrac.library(kind="ifs")
    assert {entry.kind for entry in systems} == {"ifs"}
    assert 0 < len(systems) < len(everything)
    for entry in plants[:5]:
        assert kfrac.load(entry.name).title == entry.title


def test_a_fit_finds_the_gasket() -> None:
    gasket = kfrac.parse("kind: ifs\nvertices: {points: [[0, 0], [1, 0], [0.5, 1]], shrink: 1/2}")
    picture = gasket.histogram(200_000, size=96) > 0
    fit = kfrac.fit(picture, maps=3, effort=2000)
    assert fit.exact and fit.iou > 0.8
    assert fit.fractal.kind == "ifs"
    assert fit.hausdorff < 4
    with pytest.raises(kfrac.KfracError, match="no pixel"):
        kfrac.fit(picture & False)
    with pytest.raises(ValueError, match="no method"):
        kfrac.fit(picture, method="best")  # pyright: ignore[reportArgumentType]
