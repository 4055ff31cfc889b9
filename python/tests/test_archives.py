"""Files that `kfrac dataset` writes, read by other programs. The variable KFRAC names the program."""

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet
import pytest
import webdataset
from PIL import Image

from kfrac.data import Dataset, write_parquet

PROGRAM = os.environ.get("KFRAC")

SPEC = """
kind: dataset
categories: {systems: {random: {maps: [2, 5]}, count: 5}}
instances: {count: 8, weights: fractaldb}
picture: {size: 32, points: 5k, colour: hsv}
"""

pytestmark = [
    pytest.mark.skipif(PROGRAM is None, reason="there is no program"),
    # The reader leaves archives open.
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


def write(folder: Path, *arguments: str) -> None:
    """Runs `kfrac dataset` in a folder."""
    (folder / "set.yaml").write_text(SPEC)
    subprocess.run([str(PROGRAM), "dataset", "set.yaml", "--quiet", *arguments], cwd=folder, check=True)


def test_webdataset_reads_the_archives(tmp_path: Path) -> None:
    for part in ["1/2", "2/2"]:
        write(tmp_path, "-o", "out/%06d.tar", "--archive", "15", "--shard", part)
    archives = sorted(str(path) for path in (tmp_path / "out").glob("*.tar"))
    assert [Path(path).name for path in archives] == ["000000.tar", "000001.tar", "000002.tar"]
    reader: Any = webdataset.WebDataset(archives, shardshuffle=False)  # pyright: ignore
    samples: list[dict[str, Any]] = list(reader.decode("rgb8"))
    pictures = Dataset.parse(SPEC)
    assert len(samples) == len(pictures) == 40
    for number, sample in enumerate(samples):
        picture, category = pictures[number]
        assert np.array_equal(sample["png"], picture)
        assert sample["cls"] == category
        label = pictures.label(number)
        assert {key: sample["json"][key] for key in ("instance", "maps", "flip")} == {
            key: label[key] for key in ("instance", "maps", "flip")
        }


def test_tables_are_those_of_pyarrow(tmp_path: Path) -> None:
    write(tmp_path, "-o", "out/%06d.parquet", "--archive", "40")
    own = tmp_path / "out" / "000000.parquet"
    pictures = Dataset.parse(SPEC)
    other = tmp_path / "other.parquet"
    write_parquet(pictures, other)
    schemas: list[Any] = [pyarrow.parquet.read_schema(path) for path in (own, other)]
    assert schemas[0].equals(schemas[1])
    features = [json.loads(schema.metadata[b"huggingface"]) for schema in schemas]
    assert features[0] == features[1]
    tables: list[Any] = [pyarrow.parquet.read_table(path) for path in (own, other)]
    for name in ("image", "category", "name"):
        assert tables[0][name].to_pylist() == tables[1][name].to_pylist()


def test_folders_are_those_of_image_folder(tmp_path: Path) -> None:
    write(tmp_path, "-o", "out")
    folders = sorted(path.name for path in (tmp_path / "out").iterdir() if path.is_dir())
    pictures = Dataset.parse(SPEC)
    assert folders == [pictures.category(number) for number in range(5)]
    for number in range(40):
        path = tmp_path / "out" / folders[number // 8] / f"{number % 8:06}.png"
        assert np.array_equal(np.array(Image.open(path)), pictures[number][0])
    labels = [json.loads(line) for line in (tmp_path / "out" / "labels.jsonl").read_text().splitlines()]
    assert [label["maps"] for label in labels] == [pictures.label(number)["maps"] for number in range(40)]
