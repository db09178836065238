"""What Evical raises: the command line's words, and their parts as attributes."""

from __future__ import annotations

from typing import Optional, Tuple

__all__ = ["Error", "InputError", "ClosedError", "CalibrationFailed"]


class Error(Exception):
    """What went wrong, where, and what to do; str(error) is what the command line prints.

    Attributes:
        place: a file, a key, a stream or a time; may be empty.
        problem: what is wrong there.
        advice: what to do; may be empty.
        repair: (key, value) for Session.set, where that mends a cause that is certain; else None.
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
    """A recording is used after it was closed."""


class CalibrationFailed(Error):
    """A stage could not do its work with this recording (exit code 1)."""
