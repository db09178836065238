"""Evical: calibrates event cameras and IMUs.

Times of events and samples are ns of the recording's clock; times of trajectories are seconds since Result.start_ns. Poses are 4 x 4
matrices named target_from_source; translations are in metres. What goes wrong raises evical.Error in the command line's words; log
lines go to the logger "evical" of Python's logging.
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
    """Opens a recording of any format for one pass of packets.

    Args:
        path: a file or folder.
        streams: names of streams, or "events", "imu", "frames", "points"; None: all of these types.

    Raises:
        InputError: nothing that can be read is there.

    >>> with evical.open("recording.bag", streams="events") as recording:
    ...     for packet in recording:
    ...         print(packet.stream.name, packet.events["t"], packet.events["x"])
    """
    if isinstance(streams, str):
        streams = [streams]
    return _open(os.fspath(path), [] if streams is None else list(streams))


def calibrate(session: Union[Session, Path], output: Optional[Path] = None, progress: Optional[Progress] = None) -> Result:
    """Calibrates a session's cameras and IMUs; Python's other threads run meanwhile.

    Args:
        session: a Session, which may be changed while this runs, or its file.
        output: the folder for what `evical calibrate -o` writes; None: nothing is written.
        progress: called with a stage's name and the fraction of it that is done, 0..1. What it raises ends the calibration.

    Raises:
        InputError: the session or its recording cannot be used.
        CalibrationFailed: the recording does not tell what is asked.
        KeyboardInterrupt: after Ctrl-C; the calibration has ended then.
    """
    return _calibrate(_session(session), None if output is None else os.fspath(output), progress)


def intrinsics(session: Union[Session, Path], camera: Optional[str] = None, progress: Optional[Progress] = None) -> IntrinsicsResult:
    """Calibrates the lens of one of a session's cameras alone; its IMUs are left aside. Raises as `calibrate` does.

    Args:
        camera: its name; None where the session has one camera only.
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


# HDF5 files are read by a separate interpreter, because this one may have threads and must not be forked. It gets this one's path
# and nothing else (-I): a file in the current folder must not replace a module. A frozen program has no interpreter.
if sys.executable and not getattr(sys, "frozen", False):
    _here = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    _set_recording_server([
        sys.executable, "-I", "-c",
        "import sys; sys.path[:] = sys.argv[1].split('\\n'); from evical import _evical; _evical._serve_recording(sys.argv[2])",
        "\n".join([os.path.abspath(folder) for folder in sys.path if folder] + [_here])
    ])
