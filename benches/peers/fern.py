"""The textbook loop of the chaos game, compiled by numba: one point, mapped repeatedly.

    python3 fern.py POINTS

Counts Barnsley's fern of four maps in a histogram of 1024² and prints the seconds of the loop, without
numba's start, compilation and a picture.
"""

import sys
import time

import numba
import numpy as np

SIDE = 1024

# a, b, c, d, e, f of the map x → ax + by + e, y → cx + dy + f, and the cumulative weight.
MAPS = np.array(
    [
        [0.0, 0.0, 0.0, 0.16, 0.0, 0.0, 0.01],
        [0.85, 0.04, -0.04, 0.85, 0.0, 1.6, 0.86],
        [0.2, -0.26, 0.23, 0.22, 0.0, 1.6, 0.93],
        [-0.15, 0.28, 0.26, 0.24, 0.0, 0.44, 1.0],
    ]
)


@numba.njit
def play(maps, points, hits):
    scale = SIDE / 10.2
    x, y = 0.0, 0.0
    for _ in range(points):
        choice = np.random.random()
        number = 0
        while number < len(maps) - 1 and choice >= maps[number, 6]:
            number += 1
        a, b, c, d, e, f = maps[number, :6]
        x, y = a * x + b * y + e, c * x + d * y + f
        column, row = int((x + 5.1) * scale), int((10.1 - y) * scale)
        if 0 <= column < SIDE and 0 <= row < SIDE:
            hits[row, column] += 1


hits = np.zeros((SIDE, SIDE), dtype=np.uint32)
play(MAPS, 1000, hits)
start = time.perf_counter()
play(MAPS, int(sys.argv[1]), hits)
print(time.perf_counter() - start)
