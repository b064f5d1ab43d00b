# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes into Blender's scene and out of it again: with the modules named scene_ the only writers of Blender's data."""
