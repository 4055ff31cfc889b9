"""Work on the workers of a Dask cluster: pictures of a data set, and numbers of a family."""

from collections.abc import Callable, Sequence
from typing import Any

import dask.bag
import numpy as np
from dask.distributed import Client

import kfrac
from kfrac.data import Batch, Dataset, render


def mapped(function: Callable[[Any], Any], values: Sequence[Any], parts: int) -> list[Any]:
    """Returns the results of a function for all values. A part is done again if its worker is lost."""
    bag = dask.bag.from_sequence(values, npartitions=parts)
    return list(bag.map_partitions(lambda some: [function(value) for value in some]).compute())


def pictures(dataset: Dataset | str, numbers: range, parts: int) -> Batch:
    """Draws a range of a data set: the arrays of `kfrac.data.render`."""
    size = -(-len(numbers) // parts)
    ranges = [numbers[start : start + size] for start in range(0, len(numbers), size)]
    drawn, categories = zip(*mapped(lambda some: render(dataset, some, threads=1), ranges, parts))
    return np.concatenate(drawn), np.concatenate(categories)


if __name__ == "__main__":
    # A cluster elsewhere: Client("tcp://scheduler:8786").
    with Client(n_workers=2, threads_per_worker=1, dashboard_address=None) as client:
        spec = "{kind: dataset, categories: {systems: {random: {maps: [2, 5], sigma: anderson}, count: 20}}, instances: {count: 10}}"
        dataset = Dataset.parse(spec)
        print("pictures", pictures(dataset, range(100), parts=8)[0].shape)
        family = kfrac.sweep("pythagoras", angle=np.linspace(10, 80, 71))
        heights = mapped(lambda tree: tree.bounds(9).max[1], family, parts=8)
        print("height", max(heights), "at an angle of", family.parameters["angle"][np.argmax(heights)])
