"""Draws the Menger sponge of a level with Mitsuba: a mesh of cubes, instanced in an outer level by hand.

    python3 benches/peers/mitsuba_sponge.py LEVEL FILE.png

Mitsuba instances one level only, so that the mesh holds the faces of the inner 3 levels, and the others are its instances.
Lit by the cosine of the angle to the light, from azimuth 30 and elevation 25 in parallel projection, with 16 samples a pixel,
on one thread. Normals alone (`aov`) take longer.
"""

import itertools
import sys

import drjit
import mitsuba as mi
import numpy as np

INNER = 3


def corners(level):
    """Returns the corners of the cubes of a level nearest to the origin, in cubes."""
    parts = [part for part in itertools.product(range(3), repeat=3) if part.count(1) < 2]
    found = np.zeros((1, 3), dtype=np.int64)
    for _ in range(level):
        found = (3 * found[:, None, :] + np.array(parts)[None, :, :]).reshape(-1, 3)
    return found


def mesh(level):
    """Returns the mesh of the sponge of a level in the unit cube."""
    cube = np.array(list(itertools.product((0, 1), repeat=3)))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])
    at = corners(level)
    points = (at[:, None, :] + cube[None, :, :]).reshape(-1, 3) / 3**level
    all_faces = (8 * np.arange(len(at))[:, None, None] + faces[None, :, :]).reshape(-1, 3)
    made = mi.Mesh("sponge", len(points), len(all_faces))
    values = mi.traverse(made)
    values["vertex_positions"] = points.astype(np.float32).ravel()
    values["faces"] = all_faces.astype(np.uint32).ravel()
    values.update()
    return made


def main():
    level, file = int(sys.argv[1]), sys.argv[2]
    mi.set_variant("scalar_rgb")
    drjit.set_thread_count(1)
    outer = level - INNER
    side = 3**outer
    towards = np.array([0.453, -0.785, 0.4226])
    middle = np.full(3, 0.5)
    scene = {
        "type": "scene",
        "integrator": {"type": "direct"},
        "sponge": {"type": "shapegroup", "mesh": mesh(INNER)},
        "light": {"type": "directional", "direction": list(-towards), "irradiance": 3.14159},
        "sensor": {
            "type": "orthographic",
            "to_world": mi.ScalarTransform4f()
            .look_at(origin=list(middle + 10 * towards), target=list(middle), up=[0, 0, 1])
            .scale([0.875, 0.875, 1]),
            "film": {"type": "hdrfilm", "width": 1024, "height": 1024, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 16},
        },
    }
    for number, corner in enumerate(corners(outer)):
        place = mi.ScalarTransform4f().translate(list(corner / side)).scale(1 / side)
        scene[f"part{number}"] = {"type": "instance", "to_world": place, "group": {"type": "ref", "id": "sponge"}}
    mi.util.write_bitmap(file, mi.render(mi.load_dict(scene)), write_async=False)


main()
