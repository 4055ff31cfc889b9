# %% [markdown]
# # A tour of kfrac
# Each cell can be run in a notebook; the file is also a program.

# %%
import math

import numpy as np

import kfrac

# %% A fractal of the library, and what is known about it
koch = kfrac.load("koch")
info = koch.info(5)
print(info["title"], info["elements"], info["dimension"])
assert info["elements"][-1] == 4**5

# %% Its length grows by 4/3 a step
growth = np.divide(info["length"][1:], info["length"][:-1])
assert np.allclose(growth, 4 / 3)

# %% Elements as arrays: the mean height of the curve
table = koch.elements(8)
middle = (table["y0"] + table["y1"]) / 2
print(f"{len(table)} elements, mean height {middle.mean():.4f}")

# %% A family: the height of the tree over its angle
trees = kfrac.sweep("pythagoras", angle=np.linspace(20, 70, 11))
heights = trees.map(lambda tree: tree.bounds(9).max[1])
for angle, height in zip(trees.parameters["angle"], heights):
    print(f"{angle:5.1f}° {height:.3f}")

# %% Box counting on a histogram, beside the exact dimension
gasket = kfrac.parse("kind: ifs\nvertices: {points: [[0, 0], [1, 0], [0.5, sqrt(3)/2]], shrink: 1/2}")
counts = gasket.histogram(4_000_000, size=(512, 512))
sides = 2 ** np.arange(2, 8)
boxes = [(counts.reshape(512 // side, side, 512 // side, side).sum(axis=(1, 3)) > 0).sum() for side in sides]
slope = -np.polyfit(np.log(sides), np.log(boxes), 1)[0]
print(f"counted {slope:.3f}, exact {gasket.dimension().closed_form}")
assert math.isclose(slope, math.log(3, 2), abs_tol=0.05)

# %% The picture itself, which a notebook shows
koch
