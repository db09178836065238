"""Common fixtures: simulated recordings, and one calibration of them."""

import os
import pathlib
import shutil

import pytest

import evical

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SIMULATED = pathlib.Path(os.environ["EVICAL_SIMULATED"])


@pytest.fixture(scope="session")
def source():
    return SOURCE


@pytest.fixture(scope="session")
def simulated():
    """Folder of the recordings that tests/system simulates."""
    return SIMULATED


@pytest.fixture(scope="session")
def bag():
    return SIMULATED / "short_bag" / "recording.bag"


@pytest.fixture
def session():
    session = evical.Session.load(SIMULATED / "short_bag" / "session.yaml")
    session.set("report.split_half_check", False)
    return session


@pytest.fixture(scope="session")
def calibrated(tmp_path_factory):
    """The result of the short recording, and its folder."""
    folder = tmp_path_factory.mktemp("calibrated") / "result"
    session = evical.Session.load(SIMULATED / "short_bag" / "session.yaml")
    session.set("report.split_half_check", False)
    return evical.calibrate(session, output=folder), folder


@pytest.fixture
def result_folder(calibrated, tmp_path):
    """A copy that a test may damage."""
    return pathlib.Path(shutil.copytree(calibrated[1], tmp_path / "result"))
