"""Data sets of pictures of fractals, with labels, for the training of networks.

A file of the kind `dataset` describes categories, the variation of their pictures and how these are drawn; `kfrac dataset`
writes it as a folder, as archives or as tables in Parquet. Here its pictures are arrays, drawn when they are asked for:

>>> from kfrac.data import Batches, Dataset
>>> dataset = Dataset.parse('''
... kind: dataset
... categories: {systems: {random: {maps: [2, 4], sigma: anderson}, count: 10}}
... instances: {count: 100, weights: jitter(0.1), flips: true}
... picture: {size: 64, points: 10k}
... ''')
>>> picture, category = dataset[123]
>>> picture.shape, category
((64, 64), 1)
>>> pictures, categories = Batches(dataset, 32)[0]
>>> pictures.shape, categories.dtype
((32, 64, 64), dtype('int64'))

torch is not imported. Its DataLoader takes a `Dataset`, `DataLoader(dataset, batch_size=64, shuffle=True, num_workers=2)`, and,
which is faster, `Batches`: `DataLoader(Batches(dataset, 64), batch_size=None, num_workers=2)`.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from os import PathLike
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from ._kfrac import Dataset

__all__ = ["Batches", "Dataset", "render", "write_parquet"]

Batch = tuple[NDArray[np.uint8], NDArray[np.int64]]


class Batches(Sequence[Batch]):
    """Batches of consecutive pictures, in an order that a seed shuffles.

    Parameters
    ----------
    dataset : Dataset
    size : int
        Number of pictures of a batch; the last one may have fewer.
    shard : (int, int), optional
        Part of the data set and number of parts: (3, 64) is the third of 64.
    shuffle : int, optional
        Seed by which pictures are shuffled within the part; by default they stay in order.
    threads : int
        Number of threads that draw a batch; with several worker processes, one each.
    """

    def __init__(
        self,
        dataset: Dataset,
        size: int,
        *,
        shard: tuple[int, int] = (1, 1),
        shuffle: int | None = None,
        threads: int = 1,
    ) -> None:
        if size < 1:
            raise ValueError("a batch has at least one picture")
        self._dataset = dataset
        self._size = size
        self._start, self._stop = dataset.shard(*shard)
        self._order: NDArray[np.int64] | None = None
        if shuffle is not None:
            order = np.arange(self._start, self._stop, dtype=np.int64)
            self._order = np.random.default_rng(shuffle).permutation(order)
        self._threads = threads

    def __len__(self) -> int:
        return -((self._start - self._stop) // self._size)

    @overload
    def __getitem__(self, index: int) -> Batch: ...
    @overload
    def __getitem__(self, index: slice) -> list[Batch]: ...
    def __getitem__(self, index: int | slice) -> Batch | list[Batch]:
        if isinstance(index, slice):
            return [self[number] for number in range(len(self))[index]]
        first = range(len(self))[index] * self._size
        if self._order is None:
            start = self._start + first
            return self._dataset.render(start, min(start + self._size, self._stop), threads=self._threads)
        picked: list[int] = self._order[first : first + self._size].tolist()
        examples = self._dataset.__getitems__(picked)
        pictures = np.stack([picture for picture, _ in examples])
        return pictures, np.array([category for _, category in examples], dtype=np.int64)

    def __iter__(self) -> Iterator[Batch]:
        return (self[number] for number in range(len(self)))


def render(
    dataset: Dataset | str | PathLike[str], numbers: range, *, threads: int | None = None
) -> Batch:
    """Draws consecutive pictures of a data set, or of its file.

    Parameters
    ----------
    dataset : Dataset, str or path
    numbers : range
        Numbers of the pictures, with a step of 1.
    threads : int, optional
        Number of threads; by default that of the machine's cores.

    Returns
    -------
    pictures : array of uint8, shape (n, size, size) or (n, size, size, 3)
    categories : array of int64, shape (n,)
    """
    if numbers.step != 1:
        raise ValueError("pictures are consecutive: range(start, stop)")
    if not isinstance(dataset, Dataset):
        dataset = Dataset(dataset)
    return dataset.render(numbers.start, max(numbers.start, numbers.stop), threads=threads)


def write_parquet(
    dataset: Dataset, path: str | PathLike[str], *, shard: tuple[int, int] = (1, 1), rows: int = 1000
) -> None:
    """Writes a part of a data set as a Parquet file, with pyarrow.

    Columns are `image` (a struct of `bytes`, a PNG, and `path`, as the library `datasets` has it), `category` (int64), `name`
    (string) and `label` (string: the label as JSON). The file is a pure function of the data set and the part.

    Parameters
    ----------
    dataset : Dataset
    path : str or path
    shard : (int, int)
        Part of the data set and number of parts.
    rows : int
        Number of pictures of a row group, which are held in memory.
    """
    import pyarrow as typeless  # pyright: ignore[reportMissingTypeStubs]
    import pyarrow.parquet as parquet_typeless  # pyright: ignore[reportMissingTypeStubs]

    # The types of pyarrow are not known.
    pyarrow: Any = typeless
    parquet: Any = parquet_typeless
    image = pyarrow.struct([("bytes", pyarrow.binary()), ("path", pyarrow.string())])
    columns = [("image", image), ("category", pyarrow.int64()), ("name", pyarrow.string()), ("label", pyarrow.string())]
    features = {name: {"dtype": str(kind), "_type": "Value"} for name, kind in columns[1:]}
    features["image"] = {"_type": "Image"}
    # `datasets` decodes the pictures of a column that is named here.
    schema = pyarrow.schema(columns, metadata={"huggingface": json.dumps({"info": {"features": features}})})
    start, stop = dataset.shard(*shard)
    with parquet.ParquetWriter(path, schema, compression="none") as writer:
        for first in range(start, stop, rows):
            written: list[dict[str, object]] = []
            for number in range(first, min(first + rows, stop)):
                label = dataset.label(number)
                name: str = label["name"]
                written.append(
                    {
                        "image": {"bytes": dataset.png(number), "path": f"{name}/{label['instance']:06}.png"},
                        "category": label["category"],
                        "name": name,
                        "label": json.dumps(label),
                    }
                )
            writer.write_table(pyarrow.Table.from_pylist(written, schema=schema))
