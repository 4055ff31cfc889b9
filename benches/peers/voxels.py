"""Counts the cubes of a Menger sponge of unit cubes with trimesh's voxelizer, and prints the seconds.

The surface of the approximant of a number of steps, as a mesh (.stl), is divided into voxels of 1 / side.
"""

import sys
import time

import trimesh


def main():
    path, side = sys.argv[1], int(sys.argv[2])
    start = time.perf_counter()
    mesh = trimesh.load(path)
    # Subdivision leaves faces as small as voxels; the other methods count fewer.
    grid = mesh.voxelized(pitch=mesh.extents.max() / side, method="subdivide")
    print(time.perf_counter() - start, grid.filled_count)


main()
