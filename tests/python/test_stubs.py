"""Type hints: they match the module, and mypy checks a program with them."""

import ast
import os
import pathlib
import re
import subprocess
import sys

import pytest

import evical

PROGRAM = """
import evical

with evical.open("recording.bag", streams="events") as recording:
    for packet in recording:
        count: int = packet.events["t"].size
session = evical.Session.load("session.yaml")
result = evical.calibrate(session, progress=lambda stage, fraction: print(stage, fraction))
offset_s: float = result.cameras["left"].time_offset_s
sigma: float = result.covariance["left.time_offset"] ** 0.5
"""


def run(tmp_path, *arguments):
    environment = {**os.environ, "MYPYPATH": os.environ["PYTHONPATH"], "MYPY_CACHE_DIR": str(tmp_path / "cache")}
    return subprocess.run([sys.executable, "-m", *map(str, arguments)], capture_output=True, text=True, cwd=tmp_path,
                          env=environment)


NOT_MADE = ["CameraResult", "Fault", "Frame", "ImuResult", "IntrinsicsResult", "Packet", "Recording", "Result", "Session", "SessionCamera",
            "SessionImu", "Stream", "Trajectory"]

MEMBERS = """
import pathlib
import evical

session = evical.Session.load("session.yaml")
recording: pathlib.Path = session.recording
name: str = session.source.name + session.recording.name
session.recording = "recording.bag"
session.recording = pathlib.Path("recording.bag")
session.time_range_s = [0.5, 5]
session.time_range_s = None
camera = session.cameras["left"]
camera.resolution_px = [346, 260]
camera.rejected_windows_s = [1.0]
camera.recording = "other.bag"
"""


def test_hints_are_of_what_is_there():
    stub = pathlib.Path(evical.__file__).with_name("_evical.pyi")
    classes = {node.name: node for node in ast.parse(stub.read_text()).body if isinstance(node, ast.ClassDef)}

    def hinted(name):
        members = set()
        for node in classes[name].body:
            if isinstance(node, ast.FunctionDef):
                members.add(node.name)
            elif isinstance(node, ast.AnnAssign):
                members.add(node.target.id)
        for base in classes[name].bases:
            members |= hinted(base.id)
        return members

    for name in evical.__all__:
        thing = getattr(evical, name)
        if isinstance(thing, type) and thing.__module__ == "evical._evical":
            assert {each for each in vars(thing) if not each.startswith("_")} == {
                each for each in hinted(name) if not each.startswith("_")}, name


def test_the_package_fits_its_own_hints(tmp_path):
    checked = run(tmp_path, "mypy", "--strict", "-p", "evical")
    assert checked.returncode == 0, checked.stdout


def test_a_program_is_checked(tmp_path):
    (tmp_path / "program.py").write_text(PROGRAM)
    checked = run(tmp_path, "mypy", "--strict", "program.py")
    assert checked.returncode == 0, checked.stdout
    (tmp_path / "program.py").write_text(PROGRAM.replace("time_offset_s", "time_offset_ms").replace('"session.yaml"', "3"))
    checked = run(tmp_path, "mypy", "--strict", "program.py")
    assert 'has no attribute "time_offset_ms"' in checked.stdout and 'incompatible type "int"' in checked.stdout


def test_the_pages_examples_are_typed(source, tmp_path):
    blocks = re.findall(r"^```python\n(.*?)^```$", (source / "docs" / "python.md").read_text(), re.MULTILINE | re.DOTALL)
    (tmp_path / "examples.py").write_text("\n".join(blocks))
    (tmp_path / "members.py").write_text(MEMBERS)
    for program in ("examples.py", "members.py"):
        checked = run(tmp_path, "mypy", "--strict", program)
        assert checked.returncode == 0, checked.stdout


def test_what_cannot_be_made_is_an_error_for_mypy_too(tmp_path):
    (tmp_path / "program.py").write_text("import evical\n" + "".join(f"evical.{name}()\n" for name in NOT_MADE) + "evical.Board()\n")
    checked = run(tmp_path, "mypy", "--strict", "program.py")
    assert checked.stdout.count("Missing named argument") == len(NOT_MADE) == checked.stdout.count("error:"), checked.stdout
    for name in NOT_MADE:
        with pytest.raises(TypeError):
            getattr(evical, name)()
    evical.Board()


@pytest.mark.parametrize("name", ["open", "inspect", "calibrate", "intrinsics", "undistort_events", "Recording", "Session", "Result",
                                  "Camera", "Trajectory", "Covariance"])
def test_everything_is_explained(name):
    thing = getattr(evical, name)
    assert thing.__doc__ and len(thing.__doc__) > 30
    if isinstance(thing, type):
        for member, value in vars(thing).items():
            if not member.startswith("_") and callable(getattr(value, "__func__", value)) and not isinstance(value, property):
                assert value.__doc__ or member in ("copy",), f"{name}.{member}"
