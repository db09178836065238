"""Exceptions of Evical, with the text of the command line and its parts as attributes."""

from __future__ import annotations

from typing import Optional, Tuple

__all__ = ["Error", "InputError", "ClosedError", "CalibrationFailed"]


class Error(Exception):
    """What happened, where, and what to do; str(error) is the message of the command line.

    Attributes:
        place: a file, a key, a stream or a time; may be empty.
        problem: the fault found there.
        advice: what to do; may be empty.
        repair: (key, value) for Session.set if that certainly fixes the cause; else None.
    """

    def __init__(self, message: str, place: str = "", problem: str = "", advice: str = "",
                 repair: Optional[Tuple[str, str]] = None) -> None:
        super().__init__(message)
        self.place = place
        self.problem = problem or message
        self.advice = advice
        self.repair = repair


class InputError(Error):
    """A session, a recording, a result or an argument cannot be used; nothing was written (exit code 2)."""


class ClosedError(InputError, ValueError):
    """A recording was used after it was closed."""


class CalibrationFailed(Error):
    """A calibration stage failed with this recording (exit code 1)."""
