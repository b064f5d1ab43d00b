"""The thesis's study of sampling on one cloud: tables 3.4 to 3.8 and the regression, with our samplers beside."""

import itertools
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import bonemesh
import numpy as np
import statsmodels.api
from study_report import Cell, Table
from study_values import (
    FACTORS,
    REGRESSION,
    TABLE_3_4,
    TABLE_3_5,
    TABLE_3_6,
    TABLE_3_8,
    Fit,
)

Array = np.ndarray[Any, Any]

# The comparison's own samples do not matter here: the published measure looks at every edge.
SAMPLES = 20_000
SIGNIFICANT = 0.05


@dataclass(frozen=True)
class Sampled:
    """A sample of the cloud, its mesh, and how far that is from the mesh of all points."""

    kept: Array
    mesh: bonemesh.Mesh
    percent: float
    sampling_s: float
    meshing_s: float
    overall_mm: float
    midpoint_mm: float
    mean_mm: float
    p95_mm: float


@dataclass
class Study:
    """A cloud in the image frame, the mesh of all its points, and the samples that were tried."""

    points: Array
    full: bonemesh.Mesh
    meshing_s: float
    tried: dict[tuple[Any, ...], Sampled] = field(default_factory=dict)

    @classmethod
    def of(cls, volume: bonemesh.Volume, threshold_hu: float) -> "Study":
        """The study of a volume's bone."""
        points = bonemesh.point_cloud(volume, threshold_hu=threshold_hu, frame="image")
        full, seconds = meshed(points)
        return cls(points, full, seconds)

    def sampled(self, sampler: str, percent: float) -> Sampled:
        """By a sampler that takes a percentage."""
        return self._tried((sampler, percent), sampler=sampler, percent=percent)

    def experiment(self, number: int) -> Sampled:
        """By the published targeted sampling, with the grid, percentages and cut-offs of that experiment."""
        chosen = TABLE_3_5[number]
        return self._tried(
            ("experiment", number),
            sampler="thesis-targeted",
            grid_px=chosen.grid_px,
            percentages=chosen.percentages,
            cutoffs=chosen.cutoffs,
        )

    def _tried(self, key: tuple[Any, ...], **options: Any) -> Sampled:
        if key not in self.tried:
            self.tried[key] = self._try(options)
        return self.tried[key]

    def _try(self, options: Mapping[str, Any]) -> Sampled:
        begun = time.perf_counter()
        kept = bonemesh.sample(self.points, **options)
        sampling_s = time.perf_counter() - begun
        mesh, meshing_s = meshed(self.points[kept])
        found = bonemesh.compare(mesh, self.full, samples=SAMPLES, residual=False)
        midpoints = found["edge_midpoints"] or {}
        nan = float("nan")
        return Sampled(
            kept,
            mesh,
            100.0 * len(kept) / len(self.points),
            sampling_s,
            meshing_s,
            midpoints.get("overall_mm", nan),
            midpoints.get("midpoint_mm", nan),
            found["mean_mm"],
            found["p95_mm"],
        )


def meshed(points: Array) -> tuple[bonemesh.Mesh, float]:
    """The alpha surface with the cloud's own alpha, and its seconds."""
    begun = time.perf_counter()
    alpha_mm = bonemesh.mean_neighbour_distance(points)
    mesh = bonemesh.alpha_surface(points, alpha_mm)
    return mesh, time.perf_counter() - begun


def distances(sampled: Sampled) -> list[Cell]:
    """In the order of `DISTANCES`."""
    return [
        sampled.overall_mm,
        sampled.midpoint_mm,
        sampled.mean_mm,
        sampled.p95_mm,
    ]


DISTANCES = [
    "overall (mm)",
    "midpoint (mm)",
    "mean between surfaces (mm)",
    "95 % below (mm)",
]


def falls(values: list[float]) -> bool:
    """Whether each value is below the one before it."""
    return all(b < a for a, b in itertools.pairwise(values))


def table_3_4(study: Study) -> Table:
    """Pseudo-uniform sampling, and ours at the same percentages."""
    rows: list[list[Cell]] = []
    for percent, theirs in TABLE_3_4.items():
        rows.append([percent, "thesis, on Skull2", None, *theirs, None, None])
        for sampler in ("thesis-uniform", "uniform", "targeted", "random"):
            found = study.sampled(sampler, percent)
            rows.append([percent, sampler, found.percent, *distances(found)])
    published = [study.sampled("thesis-uniform", p).midpoint_mm for p in TABLE_3_4]
    better = [
        percent
        for percent in TABLE_3_4
        if study.sampled("uniform", percent).midpoint_mm
        < study.sampled("thesis-uniform", percent).midpoint_mm
    ]
    agrees = "Agrees" if falls(published) else "Does not agree"
    return Table(
        "table_3_4",
        "Table 3.4: even sampling",
        ["asked for (%)", "sampler", "kept (%)", *DISTANCES],
        rows,
        f"{agrees}: the more points are kept, the nearer the mesh is to that of all points. Values differ with the scan. "
        f"`uniform` is nearer than the published sampler at the middles of edges at {listed(better)} per cent.",
    )


def table_3_5(study: Study) -> Table:
    """The nine targeted experiments, and our targeted sampling at the same percentages."""
    rows: list[list[Cell]] = []
    for number, theirs in TABLE_3_5.items():
        setting = f"{theirs.grid_px} px, {theirs.percentages}, {theirs.cutoffs}"
        found = study.experiment(number)
        ours = study.sampled("targeted", found.percent)
        even = study.sampled("uniform", found.percent)
        published = [
            theirs.kept_percent,
            theirs.overall_mm,
            theirs.midpoint_mm,
            None,
            None,
        ]
        rows += [
            [number, setting, "thesis, on Skull2", *published],
            [number, "", "thesis-targeted", found.percent, *distances(found)],
            [number, "", "targeted", ours.percent, *distances(ours)],
            [number, "", "uniform", even.percent, *distances(even)],
        ]
    here = [study.experiment(n).percent for n in TABLE_3_5]
    there = [e.kept_percent for e in TABLE_3_5.values()]
    rank = float(
        np.corrcoef(np.argsort(np.argsort(here)), np.argsort(np.argsort(there)))[0, 1]
    )
    nearer = [
        n
        for n in TABLE_3_5
        if study.sampled("targeted", study.experiment(n).percent).midpoint_mm
        < study.experiment(n).midpoint_mm
    ]
    return Table(
        "table_3_5",
        "Table 3.5: targeted experiments",
        [
            "experiment",
            "grid, percentages, cut-offs",
            "sampler",
            "kept (%)",
            *DISTANCES,
        ],
        rows,
        f"The order of the experiments by what they keep agrees to a rank correlation of {rank:.2f}. Of the same number of "
        f"points our `targeted` makes the nearer mesh in experiments {listed(nearer)}.",
    )


def table_3_6(study: Study) -> Table:
    """Targeted less even sampling."""
    rows: list[list[Cell]] = []
    for (number, percent), theirs in TABLE_3_6.items():
        found = study.experiment(number)
        even = study.sampled("thesis-uniform", percent)
        rows.append(
            [
                f"experiment {number} ({found.percent:.1f} %) less {percent} %",
                *theirs,
                found.overall_mm - even.overall_mm,
                found.midpoint_mm - even.midpoint_mm,
            ]
        )
    gains = [row[4] for row in rows if isinstance(row[4], float) and row[4] < -0.005]
    said = (
        "Agrees: the published targeted sampling gains nothing"
        if not gains
        else (
            f"Differs: it gains in {len(gains)} of {len(rows)} comparisons, where it also kept another number of points"
        )
    )
    return Table(
        "table_3_6",
        "Table 3.6: targeted less even sampling (mm)",
        [
            "pair",
            "overall (thesis)",
            "midpoint (thesis)",
            "overall (here)",
            "midpoint (here)",
        ],
        rows,
        f"{said}. Normals in space say up or down of a slice, not where a contour bends.",
    )


def table_3_7(study: Study) -> Table:
    """In which range of similarity the cells are."""
    rows: list[list[Cell]] = []
    for number, theirs in TABLE_3_5.items():
        counts = bonemesh.similarity_ranges(
            study.points, grid_px=theirs.grid_px, cutoffs=theirs.cutoffs
        )
        cells = sum(counts)
        shares = [100.0 * count / cells for count in counts]
        here = len(study.points) / cells
        rows.append([number, theirs.points_a_cell, *theirs.in_ranges_percent])
        rows.append(["here (points a cell and slice)", here, *shares])
    ranges = [f"range {n} (%)" for n in range(1, 5)]
    return Table(
        "table_3_7",
        "Table 3.7: cells by similarity of their normals",
        ["experiment", "points a cell", *ranges],
        rows,
        "The thesis counts points a cell, ours are those of a cell and a slice. Agrees where small cells lie in the highest range almost all: "
        "neighbours in so small a cell share the sign of the slice's normal more often.",
    )


def table_3_8(study: Study) -> Table:
    """How long it takes."""
    rows: list[list[Cell]] = []
    for percent, theirs in TABLE_3_8.items():
        rows.append([percent, "thesis, 282,938 points", *theirs])
        if percent == 100:
            rows.append(
                [percent, "here, all points", None, study.meshing_s, study.meshing_s]
            )
            continue
        for sampler in ("thesis-uniform", "uniform", "targeted"):
            found = study.sampled(sampler, percent)
            total = found.sampling_s + found.meshing_s
            rows.append([percent, sampler, found.sampling_s, found.meshing_s, total])
    ten = study.sampled("uniform", 10)
    total = ten.sampling_s + ten.meshing_s
    return Table(
        "table_3_8",
        f"Table 3.8: seconds, {len(study.points):,} points here",
        ["kept (%)", "sampler", "sampling", "meshing", "both"],
        rows,
        "Agrees that fewer points are meshed sooner; does not agree that sampling costs more than it saves: "
        f"to keep 10 per cent and mesh them takes {total / study.meshing_s:.2f} of the time of meshing all.",
    )


def regression(study: Study) -> Table:
    """Ordinary least squares of distance and kept part on the coded factors of the nine experiments."""
    levels = np.array([e.levels for e in TABLE_3_5.values()], dtype=float)
    factors = statsmodels.api.add_constant(levels)
    found = [study.experiment(number) for number in TABLE_3_5]
    measured = {
        "midpoint distance (mm)": [f.midpoint_mm for f in found],
        "kept (%)": [f.percent for f in found],
    }
    rows: list[list[Cell]] = []
    agreed = []
    for name, values in measured.items():
        fit = statsmodels.api.OLS(np.array(values), factors).fit()
        theirs: Fit = REGRESSION[name]
        p_values = theirs.p_values or (None, None, None)
        rows.append([name, "thesis", *theirs.coefficients, *p_values, theirs.r_squared])
        coefficients = [float(c) for c in fit.params]
        rows.append(
            [
                name,
                "here",
                *coefficients,
                *map(float, fit.pvalues[1:]),
                float(fit.rsquared),
            ]
        )
        same = np.sign(coefficients[1:3]) == np.sign(theirs.coefficients[1:3])
        agreed.append(bool(same.all()))
    said = "Agrees" if all(agreed) else "Does not agree everywhere"
    heads = [*(f"{f}" for f in FACTORS), *(f"p of {f}" for f in FACTORS)]
    return Table(
        "regression",
        "Regression on coded factors",
        ["of", "where", "intercept", *heads, "R2"],
        rows,
        f"{said} in which way grid and percentages work: larger cells and higher percentages keep more points and lie nearer. "
        f"Factors with p below {SIGNIFICANT:g} count as more than chance; of nine experiments little can be said of the third.",
    )


def listed(items: list[int]) -> str:
    """Numbers with commas, or none."""
    return ", ".join(map(str, items)) or "none"
