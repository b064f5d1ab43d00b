# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels ask for, kept in the scene."""
