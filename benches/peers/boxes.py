"""Counts cubes of nine sizes about points of a PLY file (float x, y, z) with numpy, and prints the seconds.

With `--write N FILE`, writes N points of the Sierpinski tetrahedron first.
"""

import sys
import time

import numpy as np


def write(count, path):
    random = np.random.default_rng(1)
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=float)
    at = np.zeros((1000, 3))
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n"
    header += "property float x\nproperty float y\nproperty float z\nend_header\n"
    with open(path, "wb") as file:
        file.write(header.encode())
        for first in range(0, count, 1000):
            at = (at + corners[random.integers(0, 4, 1000)]) / 2
            at[: count - first].astype("<f4").tofile(file)


def main():
    if sys.argv[1] == "--write":
        write(int(sys.argv[2]), sys.argv[3])
        return
    data = open(sys.argv[1], "rb").read().split(b"end_header\n", 1)[1]
    points = np.frombuffer(data, dtype="<f4").reshape(-1, 3).astype(float)
    start = time.perf_counter()
    lowest = points.min(axis=0)
    extent = (points.max(axis=0) - lowest).max()
    for level in range(1, 10):
        boxes = np.floor((points - lowest) / (extent / 2**level)).astype(np.int64)
        np.unique(boxes, axis=0)
    print(time.perf_counter() - start)


main()
