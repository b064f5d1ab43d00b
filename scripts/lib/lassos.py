"""Random lassos on meshes, as people draw them, and what becomes of them.

Each looks at the mesh from a random side and draws a random polygon around a random place. Every other one
takes only vertices that can be seen, as a lasso in solid view does, the rest all in the polygon, as with
X-ray. Areas of 20 to 2,000 mm2, thicknesses of 1 to 15 mm; one in three is cut along the view.
"""

import argparse
import collections
import pathlib
import statistics
import sys
import time

import bonemesh
import numpy as np

# Width of the cells (mm) in which it is looked up what lies before what, and how far behind still counts.
CELL_MM = 1.0
BEHIND_MM = 2.0
# Corners of a polygon, and how much their distances from its middle differ.
CORNERS = 24
UNEVEN = 0.35


class Body:
    def __init__(self, path):
        self.name = pathlib.Path(path).stem
        self.mesh = bonemesh.read_mesh(path)
        self.vertices = self.mesh.vertices.astype(np.float64)
        corners = self.vertices[self.mesh.triangles]
        facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.normals = np.zeros_like(self.vertices)
        for corner in range(3):
            np.add.at(self.normals, self.mesh.triangles[:, corner], facing)

    def lasso(self, random):
        """The selected vertices, and the direction of the view."""
        view = random.normal(size=3)
        view /= np.linalg.norm(view)
        right = np.cross(view, np.eye(3)[np.argmin(np.abs(view))])
        right /= np.linalg.norm(right)
        seen = self.vertices @ np.stack([right, np.cross(view, right), view], axis=1)
        is_front = self.visible(seen, view)
        middle = seen[random.choice(np.flatnonzero(is_front)), :2]
        area = 20 * 100 ** random.random()
        radii = np.sqrt(area / np.pi) * (1 + UNEVEN * random.uniform(-1, 1, CORNERS))
        is_in = in_star(seen[:, :2] - middle, radii)
        if random.random() < 0.5:
            is_in &= is_front
        return np.flatnonzero(is_in), view

    def visible(self, seen, view):
        cells = np.floor(seen[:, :2] / CELL_MM).astype(np.int64)
        cells -= cells.min(axis=0)
        width = cells[:, 1].max() + 1
        flat = cells[:, 0] * width + cells[:, 1]
        nearest = np.full(flat.max() + 1, np.inf)
        np.minimum.at(nearest, flat, seen[:, 2])
        return (seen[:, 2] < nearest[flat] + BEHIND_MM) & (self.normals @ view < 0)


def in_star(places, radii):
    """Which places lie in a polygon whose corners are so far from the origin, at equal angles."""
    turn = (
        np.arctan2(places[:, 1], places[:, 0]) / (2 * np.pi) * len(radii) % len(radii)
    )
    first = np.floor(turn).astype(int) % len(radii)
    part = turn - np.floor(turn)
    second = (first + 1) % len(radii)
    edge = radii[first] * (1 - part) + radii[second] * part
    return np.hypot(places[:, 0], places[:, 1]) < edge


def cut(body, random):
    """One lasso: its outcome, its seconds, and the solid."""
    selected, view = body.lasso(random)
    thickness = random.uniform(1, 15)
    direction = view if random.random() < 1 / 3 else "normal"
    begun = time.perf_counter()
    try:
        solid = bonemesh.select_roi(
            body.mesh, selected, thickness_mm=thickness, direction=direction
        )
    except bonemesh.BonemeshError as error:
        return f"error: {error}", time.perf_counter() - begun, None
    seconds = time.perf_counter() - begun
    check = bonemesh.check(solid)
    faults = [name for name in ("watertight", "manifold") if not check[name]]
    if check["self_intersections"]:
        faults.append("self-intersecting")
    return ", ".join(faults) or "sound", seconds, solid


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--count", type=int, default=100, help="lassos on each mesh")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--save", type=pathlib.Path, help="folder for the solids")
    arguments = parser.parse_args()
    for path in arguments.meshes:
        body = Body(path)
        outcomes, times = collections.Counter(), []
        for number in range(arguments.count):
            random = np.random.default_rng([arguments.seed, number])
            outcome, seconds, solid = cut(body, random)
            outcomes[outcome] += 1
            times.append(seconds)
            if outcome != "sound" or seconds > 2:
                print(
                    f"  {body.name} {number}: {outcome}, {seconds:.2f} s",
                    file=sys.stderr,
                )
            if arguments.save and solid:
                arguments.save.mkdir(parents=True, exist_ok=True)
                solid.save(arguments.save / f"{body.name}-{number}.stl")
        print(
            f"{body.name}: {len(body.mesh.triangles)} triangles, {arguments.count} lassos, "
            f"{outcomes['sound']} sound, median {statistics.median(times):.2f} s, "
            f"worst {max(times):.2f} s"
        )
        for outcome, count in outcomes.most_common():
            if outcome != "sound":
                print(f"  {count} x {outcome}")


if __name__ == "__main__":
    main()
