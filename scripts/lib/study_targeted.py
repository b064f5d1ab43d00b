"""Whether it pays to keep more points where contours bend, at the same number of points."""

from typing import Any

import bonemesh
import numpy as np
from study_report import Cell, Table
from study_sampling import DISTANCES, Study, distances

Array = np.ndarray[Any, Any]

SAMPLERS = ("uniform", "targeted")
CURVED_PERCENTS = (20.0, 10.0, 5.0, 2.5)
FEMUR_PERCENTS = (50.0, 20.0, 10.0, 5.0)
FEMUR_HU = 350.0


def off_polygon(contour: Array, kept: Array) -> Array:
    """How far each point of a closed contour is from the polygon through those kept, in pixels.

    The contour has to go once around its middle.
    """
    middle = (contour.min(axis=0) + contour.max(axis=0)) / 2
    x, y = (kept - middle).T
    corners = kept[np.argsort(np.arctan2(y, x))]
    ends = np.roll(corners, -1, axis=0)
    along = ends - corners
    squared = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
    away = contour[:, None] - corners
    part = np.clip((away * along).sum(axis=2) / squared, 0.0, 1.0)
    apart = away - part[..., None] * along
    nearest: Array = np.linalg.norm(apart, axis=2).min(axis=1)
    return nearest


def table_curved(points: Array) -> Table:
    """The curved shape: its contour beside the polygon through the points that are kept."""
    rows: list[list[Cell]] = []
    means: dict[str, list[float]] = {name: [] for name in SAMPLERS}
    for percent in CURVED_PERCENTS:
        for sampler in SAMPLERS:
            kept = bonemesh.sample(points, percent=percent, sampler=sampler)
            off = off_polygon(points[:, :2], points[kept][:, :2])
            means[sampler].append(float(off.mean()))
            rows.append(
                [percent, sampler, len(kept), float(off.mean()), float(off.max())]
            )
    return Table(
        "curved_targeted",
        "The curved shape: distance of its points to the polygon through those kept",
        ["kept (%)", "sampler", "points", "mean (pixels)", "largest (pixels)"],
        rows,
        f"{verdict(means, CURVED_PERCENTS)} With steps shorter than the bends both follow them, and what is left are the "
        "stairs of the pixels; with longer ones an even sample cuts the sharp corner off.",
    )


def table_femur() -> Table:
    """The femur phantom: its mesh of all points beside that of those kept."""
    study = Study.of(bonemesh.phantom("femur"), FEMUR_HU)
    rows: list[list[Cell]] = []
    means: dict[str, list[float]] = {name: [] for name in SAMPLERS}
    for percent in FEMUR_PERCENTS:
        for sampler in SAMPLERS:
            found = study.sampled(sampler, percent)
            means[sampler].append(found.mean_mm)
            rows.append([percent, sampler, *distances(found)])
    return Table(
        "femur_targeted",
        f"The femur phantom, {len(study.points):,} points above {FEMUR_HU:g} HU",
        ["kept (%)", "sampler", *DISTANCES],
        rows,
        f"{verdict(means, FEMUR_PERCENTS)} The slices of a femur bend gently: what a mesh of few points loses there are "
        "narrow gaps and thin walls, which the growing alpha webs over, and a point more in a bend costs one on a straight wall.",
    )


def verdict(means: dict[str, list[float]], percents: tuple[float, ...]) -> str:
    """At which percentages which sampler is nearer."""
    pairs = list(zip(percents, means["uniform"], means["targeted"], strict=True))
    nearer = [f"{p:g}" for p, even, aimed in pairs if aimed < even]
    ratios = [aimed / even for _, even, aimed in pairs]
    at = f"at {', '.join(nearer)} per cent" if nearer else "nowhere"
    return (
        f"`targeted` is nearer than `uniform` {at}: its mean distance is {min(ratios):.2f} to {max(ratios):.2f} "
        "times that of `uniform`."
    )
