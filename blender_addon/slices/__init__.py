# SPDX-License-Identifier: GPL-3.0-or-later
"""CT images as slices in the scene, with the surface's contour."""
