"""Work on the workers of a Spark cluster: pictures of a data set, and numbers of a family."""

import pickle
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
from pyspark.sql import SparkSession

import kfrac
from kfrac.data import Batch, Dataset, render


def mapped(function: Callable[[Any], Any], values: Sequence[Any], parts: int) -> list[Any]:
    """Returns the results of a function for all values. A part is done again if its worker is lost."""

    def work(frames: Iterator[pd.DataFrame]) -> Iterator[pd.DataFrame]:
        for frame in frames:
            for number in frame["id"]:
                try:
                    result = function(values[number])
                except kfrac.KfracError as error:  # Spark itself passes on only its text.
                    result = error
                yield pd.DataFrame({"id": [number], "result": [pickle.dumps(result)]})

    numbers = SparkSession.active().range(0, len(values), numPartitions=parts)
    rows = numbers.mapInPandas(work, "id long, result binary").collect()
    results = [pickle.loads(row.result) for row in sorted(rows, key=lambda row: row.id)]
    for error in (result for result in results if isinstance(result, kfrac.KfracError)):
        raise error
    return results


def pictures(dataset: Dataset | str, numbers: range, parts: int) -> Batch:
    """Draws a range of a data set: the arrays of `kfrac.data.render`."""
    size = -(-len(numbers) // parts)
    ranges = [numbers[start : start + size] for start in range(0, len(numbers), size)]
    drawn, categories = zip(*mapped(lambda some: render(dataset, some, threads=1), ranges, parts))
    return np.concatenate(drawn), np.concatenate(categories)


if __name__ == "__main__":
    # A cluster elsewhere: .master("spark://host:7077"). Here two workers, and four attempts.
    spark = SparkSession.builder.master("local[2,4]").getOrCreate()
    spec = "{kind: dataset, categories: {systems: {random: {maps: [2, 5], sigma: anderson}, count: 20}}, instances: {count: 10}}"
    dataset = Dataset.parse(spec)
    print("pictures", pictures(dataset, range(100), parts=8)[0].shape)
    family = kfrac.sweep("pythagoras", angle=np.linspace(10, 80, 71))
    heights = mapped(lambda tree: tree.bounds(9).max[1], family, parts=8)
    print("height", max(heights), "at an angle of", family.parameters["angle"][np.argmax(heights)])
    spark.stop()
