# SPDX-License-Identifier: GPL-3.0-or-later
"""The box around the part of the images that is rendered."""
