"""The textbook loop of the chaos game in space, compiled by numba: one point, and a depth buffer.

    python3 menger.py POINTS

Draws the Menger sponge (Jones & Campa 1992: a third of the way to one of 20 vertices) in parallel projection from
azimuth 30 and elevation 25 into a buffer of 1024² depths, and prints the seconds of the loop, without numba's start,
compilation and a picture.
"""

import math
import sys
import time

import numba
import numpy as np

SIDE = 1024

VERTICES = np.array(
    [
        [x, y, z]
        for x in (0.0, 0.5, 1.0)
        for y in (0.0, 0.5, 1.0)
        for z in (0.0, 0.5, 1.0)
        if (x, y, z).count(0.5) < 2
    ]
)

AZIMUTH, ELEVATION = math.radians(30), math.radians(25)
RIGHT = np.array([math.cos(AZIMUTH), 0.0, -math.sin(AZIMUTH)])
TOWARDS = np.array(
    [
        math.sin(AZIMUTH) * math.cos(ELEVATION),
        math.sin(ELEVATION),
        math.cos(AZIMUTH) * math.cos(ELEVATION),
    ]
)
UP = np.cross(TOWARDS, RIGHT)


@numba.njit
def play(vertices, right, up, towards, points, depths):
    scale = SIDE / 1.75
    x, y, z = 0.0, 0.0, 0.0
    for _ in range(points):
        vertex = np.random.randint(0, len(vertices))
        x = (x + 2.0 * vertices[vertex, 0]) / 3.0
        y = (y + 2.0 * vertices[vertex, 1]) / 3.0
        z = (z + 2.0 * vertices[vertex, 2]) / 3.0
        a, b, c = x - 0.5, y - 0.5, z - 0.5
        column = int(SIDE / 2 + scale * (a * right[0] + b * right[1] + c * right[2]))
        row = int(SIDE / 2 - scale * (a * up[0] + b * up[1] + c * up[2]))
        depth = a * towards[0] + b * towards[1] + c * towards[2]
        if 0 <= column < SIDE and 0 <= row < SIDE and depth > depths[row, column]:
            depths[row, column] = depth


depths = np.full((SIDE, SIDE), -np.inf, dtype=np.float32)
play(VERTICES, RIGHT, UP, TOWARDS, 1000, depths)
start = time.perf_counter()
play(VERTICES, RIGHT, UP, TOWARDS, int(sys.argv[1]), depths)
print(time.perf_counter() - start)
