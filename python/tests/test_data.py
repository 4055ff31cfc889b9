"""Data sets: arrays, batches, workers, files."""

import doctest
import io
import json
import multiprocessing
import pickle
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pyarrow.parquet
import pytest
from numpy.typing import NDArray
from PIL import Image

import kfrac
import kfrac.data
from kfrac.data import Batches, Dataset, render, write_parquet

SPEC = """
kind: dataset
seed: 5
categories: {systems: [{random: {maps: [2, 5], sigma: anderson}, count: 6}, {rule: pythagoras, params: {angle: 'uniform(20, 70)'}}]}
instances: {count: 10, weights: jitter(0.1), flips: true}
picture: {size: 48, points: 20k, mode: MODE, colour: COLOUR}
"""


def dataset(mode: str = "hits", colour: str = "gray") -> Dataset:
    return Dataset.parse(SPEC.replace("MODE", mode).replace("COLOUR", colour))


def test_pictures_are_arrays() -> None:
    grey, colours = dataset(), dataset("patch3", "hsv")
    assert (len(grey), grey.categories, grey.instances, grey.size) == (70, 7, 10, 48)
    picture, category = grey[25]
    assert (picture.shape, picture.dtype, category) == ((48, 48), np.uint8, 2)
    assert picture.max() == 255 and picture.min() == 0
    picture, category = colours[-1]
    assert (picture.shape, category) == ((48, 48, 3), 6)
    assert set(np.unique(dataset("binary")[3][0])) == {0, 255}
    for wrong in [70, -71]:
        with pytest.raises(IndexError, match="no picture"):
            grey[wrong]


def test_sets_in_space_are_seen_from_around() -> None:
    spec = "{kind: dataset, categories: {systems: {random: {maps: 3, space: 3, sigma: uniform}, count: 2}}, \
instances: {count: 6, views: 3}, picture: {size: 32, points: 5k}, accept: {fill: 0.02}}"
    pictures = Dataset.parse(spec)
    labels = [pictures.label(number) for number in range(3)]
    assert [label["from"] for label in labels] == [[0, 30], [120, 30], [240, 30]]
    assert labels[0]["maps"] == labels[2]["maps"] and len(labels[0]["maps"][0]) == 13
    assert not np.array_equal(pictures[0][0], pictures[1][0])
    assert dataset().label(0)["from"] is None


def test_a_picture_is_its_png() -> None:
    for colour in ["gray", "hsv"]:
        pictures = dataset(colour=colour)
        for number in [0, 33, 69]:
            decoded = np.array(Image.open(io.BytesIO(pictures.png(number))))
            assert np.array_equal(decoded, pictures[number][0])


def test_labels_have_what_was_drawn() -> None:
    pictures = dataset()
    label = pictures.label(25)
    assert (label["category"], label["name"], label["instance"], label["flip"]) == (2, "00002", 5, 1)
    maps = np.array(label["maps"])
    assert maps.shape[1] == 7 and maps[:, 6].sum() == pytest.approx(1)
    angle = pictures.label(65)["parameters"]["angle"]
    assert 20 <= angle < 70
    # The picture can be made again from the label: by another iteration of the same maps.
    a, b, c, d, e, f, weights = maps.T
    random = np.random.default_rng(1)
    points = np.zeros((20_000, 2))
    for _ in range(60):
        chosen = random.choice(len(maps), len(points), p=weights / weights.sum())
        x, y = points.T
        points = np.stack([a[chosen] * x + b[chosen] * y + e[chosen], c[chosen] * x + d[chosen] * y + f[chosen]], axis=1)
    low, high = points.min(axis=0), points.max(axis=0)
    cells = np.clip(((points - low) / (high - low) * 12).astype(int), 0, 11)
    counted = np.zeros((12, 12))
    np.add.at(counted, (11 - cells[:, 1], cells[:, 0]), 1)
    counted = counted[::-1]  # The flip of the label.
    drawn = pictures[25][0].reshape(12, 4, 12, 4) > 0
    assert np.corrcoef(np.log1p(counted).ravel(), drawn.sum(axis=(1, 3)).ravel())[0, 1] > 0.8


def test_batches_are_the_pictures() -> None:
    pictures = dataset()
    everything, categories = pictures.render(0, 70, threads=3)
    assert (everything.shape, categories.dtype) == ((70, 48, 48), np.int64)
    for number in [0, 41, 69]:
        assert np.array_equal(everything[number], pictures[number][0])
        assert categories[number] == pictures[number][1]
    batches = Batches(pictures, 16)
    assert len(batches) == 5 and [len(batch[1]) for batch in batches] == [16, 16, 16, 16, 6]
    assert np.array_equal(np.concatenate([batch[0] for batch in batches]), everything)
    parts = [Batches(pictures, 8, shard=(number, 3)) for number in (1, 2, 3)]
    assert np.array_equal(np.concatenate([batch[0] for part in parts for batch in part]), everything)
    shuffled = np.concatenate([batch[1] for batch in Batches(pictures, 16, shuffle=1)])
    assert not np.array_equal(shuffled, categories) and np.array_equal(np.sort(shuffled), categories)
    drawn, _ = render(pictures, range(10, 20))
    assert np.array_equal(drawn, everything[10:20])
    with pytest.raises(ValueError, match="consecutive"):
        render(pictures, range(0, 10, 2))
    with pytest.raises(kfrac.KfracError):
        pictures.render(60, 71)


def one(pictures: Dataset, number: int) -> NDArray[np.uint8]:
    return pictures[number][0]


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_workers_draw_the_same_pictures() -> None:
    pictures = dataset()
    numbers = list(range(0, 70, 7))
    expected = [pictures[number][0] for number in numbers]
    with ThreadPoolExecutor(3) as pool:
        assert all(map(np.array_equal, pool.map(lambda number: pictures[number][0], numbers), expected))
    for method in multiprocessing.get_all_start_methods():
        with multiprocessing.get_context(method).Pool(2) as pool:
            found = pool.starmap(one, [(pictures, number) for number in numbers])
        assert all(map(np.array_equal, found, expected)), method
    again = pickle.loads(pickle.dumps(pictures))
    assert repr(again) == repr(pictures) and np.array_equal(again[7][0], expected[1])


def test_files_are_read(tmp_path: Path) -> None:
    folder = tmp_path / "tables"
    folder.mkdir()
    (folder / "gasket.csv").write_text("0.5,0,0,0.5,0,0,1\n0.5,0,0,0.5,1,0,1\n0.5,0,0,0.5,0,1,1\n")
    file = tmp_path / "set.yaml"
    file.write_text("{kind: dataset, categories: {systems: {csv: tables}}, picture: {size: 32, points: 5k}}")
    pictures = Dataset(file)
    assert pictures.category(0) == "00000-gasket"
    assert pictures.label(0)["dimension"] == pytest.approx(np.log(3) / np.log(2))
    assert np.array_equal(pickle.loads(pickle.dumps(pictures))[0][0], pictures[0][0])
    file.write_text("kind: dataset\ncategories: {systems: {csv: table}}\n")
    with pytest.raises(kfrac.KfracError, match="cannot be read") as caught:
        Dataset(file)
    assert caught.value.diagnostics[0].line == 2
    with pytest.raises(kfrac.KfracError):
        Dataset(tmp_path / "nothing.yaml")


def test_parquet_has_pictures_and_labels(tmp_path: Path) -> None:
    pictures = dataset()
    file = tmp_path / "part.parquet"
    write_parquet(pictures, file, shard=(2, 4), rows=7)
    table = pyarrow.parquet.read_table(file)
    start, stop = pictures.shard(2, 4)
    assert table.num_rows == stop - start
    assert table["image"][3].as_py()["bytes"] == pictures.png(start + 3)
    assert json.loads(table["label"][3].as_py()) == json.loads(json.dumps(pictures.label(start + 3)))
    other = tmp_path / "again.parquet"
    write_parquet(pictures, other, shard=(2, 4), rows=7)
    assert other.read_bytes() == file.read_bytes()


def test_the_docstring_is_true() -> None:
    result = doctest.testmod(kfrac.data)
    assert result.attempted > 4 and result.failed == 0
