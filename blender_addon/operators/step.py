# SPDX-License-Identifier: GPL-3.0-or-later
"""What all operators share whose button is grey as long as something is missing."""

from bpy.types import Context


class Step:
    """Mixed into an operator; what is missing is said where the mouse rests on the grey button."""

    @classmethod
    def missing(cls, _context: Context) -> str | None:
        """What is missing, with the remedy; None when the button can be pressed."""
        return None

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Whether nothing is missing."""
        missing = cls.missing(context)
        if missing is not None:
            cls.poll_message_set(missing)
        return missing is None
