# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of a mesh: how it was made, whether it can be printed, how far it is from another."""
