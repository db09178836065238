"""Evical: calibrates event cameras and IMUs.

Times of events and samples are ns of the recording's clock; times of trajectories are seconds since Result.start_ns. Poses are 4 x 4
matrices named target_from_source; translations are in metres. Errors are raised as evical.Error, with the text of the command line.
Log lines go to the logger "evical" of Python's logging.
"""

from __future__ import annotations

import os
import sys
from typing import Callable, Iterable, Optional, Union

import numpy as np
import numpy.typing as npt

from ._evical import (Board, Camera, CameraResult, Fault, Frame, ImuResult, IntrinsicsResult, Packet, Recording, Result, Session,
                      SessionCamera, SessionImu, Stream, Trajectory, __version__, inspect)
from ._evical import _calibrate, _intrinsics, _open, _set_recording_server
from .covariance import Covariance
from .errors import CalibrationFailed, ClosedError, Error, InputError

__all__ = [
    "Board", "Camera", "CameraResult", "Covariance", "Fault", "Frame", "ImuResult", "IntrinsicsResult", "Packet", "Recording",
    "Result", "Session", "SessionCamera", "SessionImu", "Stream", "Trajectory", "CalibrationFailed", "ClosedError", "Error",
    "InputError", "__version__", "calibrate", "inspect", "intrinsics", "open", "undistort_events"
]

Path = Union[str, "os.PathLike[str]"]
Progress = Callable[[str, float], object]


def open(path: Path, streams: Union[None, str, Iterable[str]] = None) -> Recording:
    """Opens a recording of any supported format, for one pass over its packets.

    Args:
        path: a file or folder.
        streams: names of streams, or "events", "imu", "frames", "points"; None: all streams of these types; an empty list: none.

    Raises:
        InputError: the recording is missing or cannot be read, or has no such stream.

    >>> with evical.open("recording.bag", streams="events") as recording:
    ...     for packet in recording:
    ...         print(packet.stream.name, packet.events["t"], packet.events["x"])
    """
    if isinstance(streams, str):
        streams = [streams]
    return _open(os.fspath(path), None if streams is None else list(streams))


def calibrate(session: Union[Session, Path], output: Optional[Path] = None, progress: Optional[Progress] = None) -> Result:
    """Calibrates a session's cameras and IMUs. Other Python threads can run meanwhile.

    Args:
        session: a Session or a session file. The Session is copied, so it may be changed during the call.
        output: the folder for the files of `evical calibrate -o`; None: nothing is written.
        progress: called with a stage's name and the fraction of it that is done, 0..1. An exception in it ends the calibration.

    Raises:
        InputError: the session or its recording cannot be used.
        CalibrationFailed: the recording does not determine the requested quantities.
        KeyboardInterrupt: Ctrl-C was pressed; the calibration has stopped.
    """
    return _calibrate(_session(session), None if output is None else os.fspath(output), progress)


def intrinsics(session: Union[Session, Path], camera: Optional[str] = None, progress: Optional[Progress] = None) -> IntrinsicsResult:
    """Calibrates the lens of one camera of a session, without its IMUs. Raises the same errors as `calibrate`.

    Args:
        camera: its name; None if the session has only one camera.
    """
    return _intrinsics(_session(session), camera, progress)


def undistort_events(events: npt.NDArray[np.void], camera: Union[Camera, CameraResult]) -> npt.NDArray[np.void]:
    """Camera.undistort_events, also for a camera of a result."""
    if not isinstance(camera, CameraResult):
        return camera.undistort_events(events)
    if camera.intrinsics is None:
        problem = "the result has no intrinsics of this camera"
        raise InputError(f"{camera.name}: {problem}", camera.name, problem)
    return camera.intrinsics.undistort_events(events)


def _session(session: Union[Session, Path]) -> Session:
    return session if isinstance(session, Session) else Session.load(os.fspath(session))


# A separate interpreter reads HDF5 files, because this one may have threads and must not be forked. It gets this one's path
# and nothing else (-I): a file in the current folder must not replace a module. A frozen program has no interpreter.
if sys.executable and not getattr(sys, "frozen", False):
    _here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    _set_recording_server([
        sys.executable, "-I", "-c",
        "import sys; sys.path[:] = sys.argv[1].split('\\n'); from evical import _evical; _evical._serve_recording(*sys.argv[2:])",
        "\n".join([os.path.abspath(folder) for folder in sys.path if folder] + [_here])
    ])
