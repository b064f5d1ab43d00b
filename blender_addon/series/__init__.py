# SPDX-License-Identifier: GPL-3.0-or-later
"""Which series a folder or file of CT images holds."""
