# SPDX-License-Identifier: GPL-3.0-or-later
"""Long calculations beside the window: progress, time left, cancelling, and what is said at their end."""
