# SPDX-License-Identifier: GPL-3.0-or-later
"""The chosen series read once: its histogram, and a coarse surface that follows the threshold."""
