"""The programs that are timed: Bonemesh, and what is measured beside it."""

import array
import random
import sys
from dataclasses import dataclass
from pathlib import Path

from bench_process import Program

HERE = Path(__file__).parent
THREADS = 2

OURS = "Bonemesh"
ONE_THREAD = "Bonemesh, 1 thread"
CGAL = "CGAL's parallel Delaunay alone"
CGAL_SERIAL = "CGAL's serial Delaunay alone"
GEOGRAM = "Geogram's parallel Delaunay alone"
HXT = "gmsh HXT alone"
OPEN3D = "Open3D alone"
PUBLISHED = "the published method"
QHULL = "SciPy's Qhull alone"
READER = "SimpleITK"
DEFAULT = "Bonemesh, default"
SLICER = "3D Slicer's default by SimpleITK and VTK"

ENGINES = [CGAL, GEOGRAM, HXT, CGAL_SERIAL, QHULL, OPEN3D]
"""Those that only tetrahedralise."""


@dataclass(frozen=True)
class Tools:
    """Where the programs are."""

    bonemesh: str
    examples: Path
    peers: Path

    def render(
        self, folder: str, hu: str, mesh: Path, threads: int, *more: str
    ) -> list[str]:
        """From a folder to a mesh."""
        command = [self.bonemesh, "render", folder, "--hu", hu, *more]
        return [*command, "--threads", str(threads), "--json", "-o", str(mesh)]

    def alpha(self, folder: str, hu: str, mesh: Path, threads: int) -> list[str]:
        """From a folder to a mesh by the published method."""
        return self.render(folder, hu, mesh, threads, "--method", "alpha")

    def cgal(self, points: Path, mode: str, *alpha: str) -> list[str]:
        """Our program around CGAL."""
        binary = str(self.peers / "cgal_delaunay")
        return [binary, str(points), mode, str(THREADS), *alpha]

    def on_folder(self, folder: str, hu: str, meshes: Path) -> list[Program]:
        """Everything from a folder to a surface; `2.stl` and `1.stl` are ours of the published method."""
        ours = [self.alpha(folder, hu, meshes / f"{n}.stl", n) for n in (THREADS, 1)]
        default = self.render(folder, hu, meshes / "default.stl", THREADS)
        published = python("published_method.py", folder, hu, meshes / "published.stl")
        return [
            Program(OURS, ours[0], is_peer=False),
            Program(ONE_THREAD, ours[1], is_peer=False),
            Program(PUBLISHED, published),
            Program(READER, python("simpleitk_reading.py", folder)),
            Program(DEFAULT, default, is_peer=False),
            Program(SLICER, python("slicer_surface.py", folder, hu, meshes / "s.stl")),
        ]

    def on_points(self, points: Path) -> list[Program]:
        """Every engine that tetrahedralises points."""
        geogram = [str(self.peers / "geogram_delaunay"), str(points), str(THREADS)]

        def engine(name: str) -> list[str]:
            return python("peers/tetrahedralize.py", name, points, THREADS)

        return [
            Program(CGAL, self.cgal(points, "parallel")),
            Program(GEOGRAM, geogram),
            Program(HXT, engine("gmsh")),
            Program(CGAL_SERIAL, self.cgal(points, "serial")),
            Program(QHULL, engine("scipy"), once=True),
            Program(OPEN3D, engine("open3d"), once=True),
        ]

    def on_random_points(self, points: Path, alpha: str) -> list[Program]:
        """Ours and CGAL's whole triangulation, with the cells of an alpha complex counted."""
        ours = [str(self.examples / "tetrahedralize_points"), str(points)]
        ours += ["--threads", str(THREADS), "--alpha", alpha]
        cgal = self.cgal(points, "parallel", alpha)
        return [Program(OURS, ours, is_peer=False), Program(CGAL, cgal)]


def python(script: str, *arguments: object) -> list[str]:
    """The command of one of the scripts beside this one."""
    return [sys.executable, str(HERE / script), *(str(a) for a in arguments)]


def write_random_points(path: Path, count: int) -> None:
    """Points of the unit cube, the same each time, as float64 x, y, z."""
    source = random.Random(0)
    numbers = array.array("d", (source.random() for _ in range(3 * count)))
    with path.open("wb") as file:
        numbers.tofile(file)


def write_raw_points(cloud: Path, points: Path) -> None:
    """A cloud's `.npy` without its header: float64 x, y, z."""
    content = cloud.read_bytes()
    points.write_bytes(content[10 + int.from_bytes(content[8:10], "little") :])
