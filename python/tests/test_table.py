"""Tables of elements: numpy arrays and Arrow arrays on one memory."""

from pathlib import Path

import numpy as np
import polars
import pyarrow
import pytest
import shapely

import kfrac


@pytest.fixture(scope="module")
def table() -> kfrac.Table:
    return kfrac.load("koch").elements(4)


def test_columns_have_their_types(table: kfrac.Table) -> None:
    assert len(table) == 4**4
    types = {name: str(table[name].dtype) for name in table.columns}
    assert types == {
        "fractal": "int64",
        "age": "int64",
        "index": "int64",
        "x0": "float64",
        "y0": "float64",
        "x1": "float64",
        "y1": "float64",
        "fertile": "bool",
        "direction": "uint8",
        "visible": "bool",
        "joined": "bool",
    }
    assert all(array.shape == (4**4,) for array in dict(table).values())
    with pytest.raises(KeyError, match="x0"):
        table["x"]


def test_elements_are_those_of_the_curve(table: kfrac.Table) -> None:
    length = np.hypot(table["x1"] - table["x0"], table["y1"] - table["y0"])
    assert np.allclose(length, 3.0**-4)
    assert np.allclose(table["x0"][1:], table["x1"][:-1], atol=1e-14)
    assert np.array_equal(table["index"], np.arange(1, 4**4 + 1))
    assert (table["age"] == 4).all() and (table["fractal"] == 0).all()
    assert table["joined"][1:].all() and table["visible"].all()


def test_the_table_is_that_of_the_csv(tmp_path: Path) -> None:
    # One rule with directions and seeds, one system with maps, one set in space; the CSV is written by another way.
    for name, steps in [("ternary-tree", 5), ("barnsley-fern", 4), ("menger", 2), ("pythagoras", 6)]:
        fractal = kfrac.load(name)
        file = tmp_path / f"{name}.csv"
        fractal.write(file, steps)
        rows = polars.read_csv(file)
        table = fractal.elements(steps, threads=3)
        assert [column for column in table.columns if column != "joined"] == rows.columns
        for column in rows.columns:
            assert np.array_equal(table[column], rows[column].to_numpy()), (name, column)


def test_arrays_are_views_of_the_table(table: kfrac.Table) -> None:
    arrow = pyarrow.table(table)
    for name in table.columns:
        array = table[name]
        assert array.base is table
        assert not array.flags.owndata and not array.flags.writeable
        assert array.ctypes.data == table[name].ctypes.data
        if array.dtype != bool:
            chunk = arrow[name].chunk(0)
            assert chunk.buffers()[1].address == array.ctypes.data
    with pytest.raises(ValueError, match="WRITEABLE|writeable"):
        table["x0"].flags.writeable = True


def test_arrays_outlive_the_table() -> None:
    x = kfrac.load("koch").elements(3)["x1"]
    arrow = pyarrow.table(kfrac.load("koch").elements(3))
    [kfrac.load("dragon").elements(10) for _ in range(5)]
    assert x[-1] == 1.0
    assert arrow["x1"][-1].as_py() == 1.0


def test_readers_of_arrow_streams_take_the_table(table: kfrac.Table) -> None:
    for frame in [polars.DataFrame(table), polars.from_arrow(pyarrow.table(table))]:
        assert isinstance(frame, polars.DataFrame)
        assert frame.columns == table.columns
        for name in table.columns:
            assert np.array_equal(frame[name].to_numpy(), table[name])


def test_lines_join_what_joins(table: kfrac.Table) -> None:
    coordinates, offsets = table.ragged()
    assert offsets.tolist() == [0, 4**4 + 1]
    assert coordinates.shape == (4**4 + 1, 2)
    [line] = table.lines()
    assert isinstance(line, shapely.LineString)
    assert line.length == pytest.approx((4 / 3) ** 4)
    assert line.is_simple
    gaps = "initiator: segment\ngenerator: [[0, 0], [1/3, 0], {to: [2/3, 0], visible: false}, [1, 0]]"
    cantor = kfrac.parse(gaps).elements(1).lines()
    assert [list(line.coords) for line in cantor] == [[(0, 0), (1 / 3, 0)], [(2 / 3, 0), (1, 0)]]
    coordinates, offsets = kfrac.load("menger").elements(1).ragged()
    assert coordinates.shape[1] == 3


def test_limits_are_reported() -> None:
    with pytest.raises(kfrac.KfracError, match="more than 1000 elements"):
        kfrac.load("koch").elements(10, max_elements=1000)
    with pytest.raises(OverflowError):
        kfrac.load("koch").elements(-1)
