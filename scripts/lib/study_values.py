"""What the thesis measured, to stand beside what is measured here.

E. Rier, Generation and segmentation of 3D models of bone from CT images based on 3D point clouds, MASc
thesis, McMaster University. Lengths in mm, volumes in cm3, times in seconds.
"""

from typing import NamedTuple


class Volumes(NamedTuple):
    """A row of table 3.2."""

    theory: float
    pyvista: float
    meshmixer: float
    preform: float


# The theory of the cube with a hole is printed as 21.73; three quarters of the cube are 32.59.
TABLE_3_2 = {
    "1 cube": Volumes(43.45, 43.02, 43.02, 43.51),
    "2 cubes": Volumes(86.90, 86.03, 86.03, 87.02),
    "cube with a hole": Volumes(32.59, 28.25, 28.34, 32.50),
    "1 cube, slices of 0.703 mm": Volumes(86.90, 86.03, 86.03, 87.02),
    "1 cube, 50 slices of 0.703 mm": Volumes(43.45, 42.58, 42.58, 43.07),
}

# Percent kept: overall and midpoint distance.
TABLE_3_4 = {
    10: (0.437, 0.340),
    20: (0.334, 0.230),
    30: (0.283, 0.177),
    50: (0.220, 0.126),
    70: (0.189, 0.102),
    90: (0.160, 0.083),
}


class Experiment(NamedTuple):
    """One of the targeted experiments, its result and its level of each factor (-1, 0, +1)."""

    grid_px: int
    percentages: tuple[float, float, float, float]
    cutoffs: tuple[float, float, float, float]
    levels: tuple[int, int, int]
    kept_percent: float
    overall_mm: float
    midpoint_mm: float
    points_a_cell: float
    in_ranges_percent: tuple[float, float, float, float]


LOW, HIGH = (10.0, 25.0, 50.0, 75.0), (50.0, 65.0, 80.0, 95.0)
MIDDLE = (30.0, 45.0, 65.0, 85.0)
WIDE, NARROW = (0.0, 0.4, 0.6, 0.8), (0.0, 0.5, 0.7, 0.9)
BETWEEN = (0.0, 0.45, 0.65, 0.85)

# Tables 3.5 and 3.7.
OF_10_WIDE = (52.85, (0.418, 0.919, 1.79, 96.87))
OF_30_WIDE = (271.67, (0.163, 30.99, 13.82, 55.02))
OF_10_NARROW = (52.85, (0.817, 1.44, 1.38, 96.36))
OF_30_NARROW = (271.67, (8.86, 30.83, 8.41, 51.90))
TABLE_3_5 = {
    1: Experiment(10, LOW, WIDE, (-1, -1, -1), 8.04, 0.501, 0.403, *OF_10_WIDE),
    2: Experiment(30, LOW, WIDE, (1, -1, -1), 31.87, 0.292, 0.177, *OF_30_WIDE),
    3: Experiment(10, HIGH, WIDE, (-1, 1, -1), 49.46, 0.221, 0.128, *OF_10_WIDE),
    4: Experiment(30, HIGH, WIDE, (1, 1, -1), 66.93, 0.192, 0.108, *OF_30_WIDE),
    5: Experiment(10, LOW, NARROW, (-1, -1, 1), 8.58, 0.492, 0.393, *OF_10_NARROW),
    6: Experiment(30, LOW, NARROW, (1, -1, 1), 38.49, 0.267, 0.156, *OF_30_NARROW),
    7: Experiment(10, HIGH, NARROW, (-1, 1, 1), 49.84, 0.220, 0.128, *OF_10_NARROW),
    8: Experiment(30, HIGH, NARROW, (1, 1, 1), 70.98, 0.186, 0.104, *OF_30_NARROW),
    9: Experiment(
        20,
        MIDDLE,
        BETWEEN,
        (0, 0, 0),
        44.59,
        0.237,
        0.143,
        154.19,
        (0.240, 28.30, 6.33, 65.13),
    ),
}

# Experiment and the percentage of pseudo-uniform sampling that it is set against: overall, midpoint.
TABLE_3_6 = {
    (5, 10): (0.055, 0.053),
    (2, 30): (0.009, 0.0),
    (7, 50): (0.0, 0.002),
    (8, 70): (-0.003, 0.002),
}

# Percent kept: sampling, meshing, both.
TABLE_3_8 = {
    100: (None, 1216.2, 1216.2),
    90: (9590.6, 888.5, 10479.1),
    50: (9325.2, 310.9, 9636.1),
    10: (9424.9, 32.3, 9457.1),
}

FACTORS = ("grid", "percentages", "cut-offs")


class Fit(NamedTuple):
    """A regression on coded factors: intercept and one coefficient a factor, p of each factor, R2."""

    coefficients: tuple[float, float, float, float]
    p_values: tuple[float, float, float] | None
    r_squared: float


REGRESSION = {
    "midpoint distance (mm)": Fit(
        (0.193, -0.063, -0.083, -0.005), (0.051, 0.021, 0.86), 0.78
    ),
    "kept (%)": Fit((40.98, 11.54, 18.78, 1.45), None, 0.986),
}

SIMILARITY = {"line": 0.89, "parabola": 0.52}

# What the thesis saw of each method on its line and cylinder models.
METHODS = {
    "ball-pivoting": "few or no connections between slices 5 mm apart, none across the line",
    "poisson": "a plane in the middle, layers unconnected",
    "planar": "flat",
    "tetrahedra": "right on the line; connects across the cylinder's bore",
    "alpha": "right; joins slices once alpha reaches their distance, walls once it reaches 4.5 mm, "
    "chords across the bore at 10 and 20 mm",
}
