"""Type hints: they match the module, and mypy checks a program with them."""

import ast
import os
import pathlib
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


@pytest.mark.parametrize("name", ["open", "inspect", "calibrate", "intrinsics", "undistort_events", "Recording", "Session", "Result",
                                  "Camera", "Trajectory", "Covariance"])
def test_everything_is_explained(name):
    thing = getattr(evical, name)
    assert thing.__doc__ and len(thing.__doc__) > 30
    if isinstance(thing, type):
        for member, value in vars(thing).items():
            if not member.startswith("_") and callable(getattr(value, "__func__", value)) and not isinstance(value, property):
                assert value.__doc__ or member in ("copy",), f"{name}.{member}"
