# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "Segment CT": its parts, their boxes, and text that fits."""
