"""Work on the workers of a Ray cluster: pictures of a data set, and numbers of a family."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import ray

import kfrac
from kfrac.data import Batch, Dataset, render


def mapped(function: Callable[[Any], Any], values: Sequence[Any], parts: int) -> list[Any]:
    """Returns the results of a function for all values. A part is done again if its worker is lost."""

    @ray.remote(num_cpus=1, max_retries=3)
    def work(some: Sequence[Any]) -> list[Any]:
        return [function(value) for value in some]

    size = -(-len(values) // parts)
    tasks = [work.remote(values[start : start + size]) for start in range(0, len(values), size)]
    try:
        results: list[list[Any]] = ray.get(tasks)
    except BaseException:  # A failure, or Ctrl-C. Ray may abort if tasks are cancelled that have just ended.
        for task in tasks:
            ray.cancel(task)
        raise
    return [result for part in results for result in part]


def pictures(dataset: Dataset | str, numbers: range, parts: int) -> Batch:
    """Draws a range of a data set: the arrays of `kfrac.data.render`."""
    size = -(-len(numbers) // parts)
    ranges = [numbers[start : start + size] for start in range(0, len(numbers), size)]
    drawn, categories = zip(*mapped(lambda some: render(dataset, some, threads=1), ranges, parts))
    return np.concatenate(drawn), np.concatenate(categories)


if __name__ == "__main__":
    # A cluster elsewhere: ray.init("ray://head:10001").
    ray.init(num_cpus=2, include_dashboard=False)
    spec = "{kind: dataset, categories: {systems: {random: {maps: [2, 5], sigma: anderson}, count: 20}}, instances: {count: 10}}"
    dataset = Dataset.parse(spec)
    print("pictures", pictures(dataset, range(100), parts=8)[0].shape)
    family = kfrac.sweep("pythagoras", angle=np.linspace(10, 80, 71))
    heights = mapped(lambda tree: tree.bounds(9).max[1], family, parts=8)
    print("height", max(heights), "at an angle of", family.parameters["angle"][np.argmax(heights)])
    ray.shutdown()
