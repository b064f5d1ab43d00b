# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel asks for: checked, completed, and what is still missing."""
