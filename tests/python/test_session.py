"""evical.Session: files, guesses, attributes."""

import copy
import logging
import os
import pathlib
import pickle

import pytest

import evical


def test_a_session_saved_is_the_session_loaded(session, tmp_path):
    file = tmp_path / "session.yaml"
    session.board.spacing_m = 0.06
    session.imus["left_imu"].gyroscope_noise_density = 2e-3
    session.cameras["left"].resolution_px = [346, 260]
    session.time_range_s = (0.5, 5)
    session.set("grid.min_circles", 9)
    session.save(file)
    loaded = evical.Session.load(file)
    assert loaded.to_yaml(tmp_path) == session.to_yaml(tmp_path)
    assert loaded.board.spacing_m == 0.06
    assert loaded.imus["left_imu"].gyroscope_noise_density == 2e-3
    assert list(loaded.time_range_s) == [0.5, 5]
    assert loaded.options["grid.min_circles"] == 9
    assert loaded.options["report.split_half_check"] is False
    assert pathlib.Path(loaded.source) == file


def test_an_imu_of_two_files_and_raw_counts_is_saved(session, tmp_path):
    imu = session.imus["left_imu"]
    assert imu.acceleration_factor == 1 and not str(imu.columns)
    imu.stream, imu.accelerometer_stream = "gyr.csv", "acc.csv"
    imu.recording, imu.accelerometer_recording = tmp_path / "gyr.csv", tmp_path / "acc.csv"
    imu.columns, imu.accelerometer_columns = "t_ns,gx,gy,gz", "t_ns,ax,ay,az"
    session.set("imus.left_imu.acceleration_unit", "0.0005 g")
    session.set("imus.left_imu.angular_rate_unit", "0.03 deg/s")
    assert (imu.acceleration_factor, imu.angular_rate_factor) == (0.0005, 0.03)
    for name in ("gyr.csv", "acc.csv"):
        (tmp_path / name).write_text("")
    session.save(tmp_path / "session.yaml")
    loaded = evical.Session.load(tmp_path / "session.yaml").imus["left_imu"]
    for key in ("columns", "accelerometer_columns", "acceleration_factor", "angular_rate_factor"):
        assert getattr(loaded, key) == getattr(imu, key)
    assert pathlib.Path(loaded.accelerometer_recording) == tmp_path / "acc.csv"


def test_intrinsics_are_taken_and_taken_away(session):
    lens = session.cameras["left"].intrinsics
    session.cameras["left"].intrinsics = None
    assert session.cameras["left"].intrinsics is None
    session.cameras["left"].intrinsics = lens
    assert session.cameras["left"].intrinsics == lens


def test_a_guess_names_what_the_recording_holds(bag, caplog):
    caplog.set_level(logging.INFO, logger="evical")
    guessed = evical.Session.guess(bag)
    assert list(guessed.cameras) and list(guessed.imus)
    assert any("board" in record.getMessage() for record in caplog.records)  # names of missing entries


def test_guesses_of_nothing_are_refused(tmp_path):
    with pytest.raises(evical.InputError, match="no path is given"):
        evical.Session.guess()
    with pytest.raises(evical.InputError, match="does not exist"):
        evical.Session.guess(tmp_path / "none.bag")
    with pytest.raises((TypeError, RuntimeError)):
        evical.Session.guess(3)


def test_a_refused_option_changes_nothing_and_is_named(session):
    before = session.to_yaml()
    with pytest.raises(evical.InputError, match="grid.min_circles"):
        session.set("grid.min_circles", -1)
    with pytest.raises(evical.InputError, match="no such option"):
        session.set("grid.min_circle", 9)
    assert session.to_yaml() == before


def test_a_faulty_file_is_named_with_its_line(tmp_path):
    file = tmp_path / "session.yaml"
    file.write_text("evical_session: 1\nbord: 3\n")
    with pytest.raises(evical.InputError, match=r"session.yaml: .*line 2"):
        evical.Session.load(file)


def test_copies_are_their_own(session):
    for other in (session.copy(), copy.copy(session), copy.deepcopy(session)):
        other.board.rows = 33
        other.cameras["left"].stream = "/elsewhere"
    assert session.board.rows != 33 and session.cameras["left"].stream != "/elsewhere"


def test_a_sensor_keeps_its_session(bag):
    camera = evical.Session.load(bag.parent / "session.yaml").cameras["left"]
    assert camera.name == "left" and camera.intrinsics.resolution_px == (346, 260)


def test_wrong_types_are_type_errors(session):
    for wrong in ("many", None, [1]):
        with pytest.raises(TypeError):
            session.board.rows = wrong
    with pytest.raises(TypeError):
        session.cameras["left"].intrinsics = {"model": "pinhole_radtan"}
    with pytest.raises(AttributeError):
        session.cameras["left"].name = "right"
    with pytest.raises(evical.InputError, match="Give one of: asymmetric_circles"):
        session.board.type = "circles"


def test_the_boards_points_are_in_metres(session):
    points = session.board.points_m
    assert points.shape == (session.board.rows * session.board.cols, 3)
    assert points[:, 1].max() == pytest.approx((session.board.rows - 1) * session.board.spacing_m)
    session.board.rows = -1
    with pytest.raises(evical.InputError):
        session.board.points_m


def test_an_assignment_that_would_be_lost_is_refused(session):
    with pytest.raises(TypeError, match="does not support item assignment"):
        session.options["report.split_half_check"] = False
    with pytest.raises(TypeError):
        session.cameras["right"] = session.cameras["left"]
    with pytest.raises(AttributeError):
        session.cameras.pop("left")
    with pytest.raises(TypeError):
        del session.imus["left_imu"]


def test_a_session_goes_to_another_process(session):
    session.board.spacing_m = 0.06
    session.set("grid.min_circles", 9)
    again = pickle.loads(pickle.dumps(session))
    assert again.to_yaml() == session.to_yaml()
    assert again.source == session.source
    lens = session.cameras["left"].intrinsics
    for copied in (pickle.loads(pickle.dumps(lens)), copy.copy(lens), copy.deepcopy(lens)):
        assert copied == lens and hash(copied) == hash(lens)
    board = copy.deepcopy(session.board)
    assert board.spacing_m == 0.06 and board.rows == session.board.rows and board.type == session.board.type


def test_log_lines_that_are_not_utf8_do_not_end_anything(tmp_path, caplog):
    caplog.set_level(logging.INFO, logger="evical")
    folder = os.fsencode(tmp_path)
    events = os.path.join(folder, b"l\xf6g.txt")
    with open(events, "w") as file:
        file.writelines(f"{0.001 * i:.6f} {i % 346} {i % 260} 1\n" for i in range(2000))
        file.write("not a line\n")
    guessed = evical.Session.guess(os.fsdecode(events))
    assert list(guessed.cameras)
    assert caplog.records


def test_an_option_has_the_same_type_for_each_value(session):
    for name, values in {"detection.window_travel_px": (3, 2.5), "grid.min_partial": (1, 0.5),
                         "initialisation.gravity_m_s2": (10, 9.81)}.items():
        for value in values:
            session.set(name, value)
            assert isinstance(session.options[name], float) and session.options[name] == value
    for value in (7, 9):
        session.set("grid.min_circles", value)
        assert type(session.options["grid.min_circles"]) is int
    assert type(session.options["report.split_half_check"]) is bool
    assert type(session.options["intrinsics.model"]) is str


def test_a_guess_is_not_calibrated_until_its_board_and_noise_are_given(bag, session):
    guessed = evical.Session.guess(bag)
    [imu] = guessed.imus.values()

    def refused(key):
        for call in (evical.calibrate, evical.intrinsics):
            with pytest.raises(evical.InputError, match=key):
                call(guessed)

    with pytest.raises(evical.InputError):
        guessed.board.points_m
    for name in ("accelerometer_noise_density", "gyroscope_noise_density"):
        refused(name)
        setattr(imu, name, getattr(session.imus["left_imu"], name))
    for name in ("cols", "rows", "spacing_m", "radius_m"):
        refused("board")
        setattr(guessed.board, name, getattr(session.board, name))
    [camera] = guessed.cameras.values()
    camera.intrinsics = session.cameras["left"].intrinsics
    guessed.set("report.split_half_check", False)
    assert evical.calibrate(guessed).status in ("ok", "doubtful")


def test_a_new_board_has_no_dimensions(session):
    session.board = evical.Board()
    with pytest.raises(evical.InputError, match="board"):
        evical.calibrate(session)


def test_the_current_folder_may_change(bag, session, monkeypatch, tmp_path):
    monkeypatch.chdir(bag.parent)
    guessed = evical.Session.guess(bag.name)
    session.recording = bag.name
    pickled = pickle.dumps(session)
    monkeypatch.chdir(tmp_path)
    for other in (guessed, pickle.loads(pickled)):
        assert os.path.samefile(other.recording, bag)
    (tmp_path / "own").mkdir()
    monkeypatch.chdir(tmp_path / "own")
    session.recording = os.path.relpath(bag)
    evical.calibrate(session, output="result", progress=lambda stage, fraction: os.chdir(tmp_path))
    assert (tmp_path / "own" / "result" / "result.yaml").exists() and not (tmp_path / "result").exists()


def test_values_that_would_be_lost_cannot_be_changed(session):
    session.time_range_s = [0.5, 5]
    camera = session.cameras["left"]
    camera.resolution_px = [346, 260]
    camera.rejected_windows_s = [1.0, 2.0]
    assert (session.time_range_s, camera.resolution_px, camera.rejected_windows_s) == ((0.5, 5), (346, 260), (1.0, 2.0))
    for values in (session.time_range_s, camera.resolution_px, camera.rejected_windows_s):
        with pytest.raises(TypeError):
            values[0] = 3


@pytest.mark.parametrize("call", [lambda: evical.Session.guess(3), lambda: evical.Session.guess(None),
                                  lambda: evical.Session.load(3), lambda: evical.Board(3), lambda: evical.Camera(3)])
def test_wrong_types_are_never_runtime_errors(call):
    with pytest.raises(TypeError):
        call()
