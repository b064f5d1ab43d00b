# SPDX-License-Identifier: GPL-3.0-or-later
"""The window, and the patient's directions in it."""
