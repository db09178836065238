"""evical.Result: from a run, from its folder, from older and damaged ones."""

import copy
import pickle
import re

import numpy as np
import pytest

import evical


def test_a_folder_gives_the_run_again(calibrated):
    result, folder = calibrated
    for path in (folder, folder / "result.yaml", str(folder)):
        loaded = evical.Result.load(path)
        assert loaded.missing == [] and loaded.status == result.status and loaded.start_ns == result.start_ns
        np.testing.assert_array_equal(loaded.covariance.matrix, result.covariance.matrix)
        times = np.linspace(0.5, 5, 20)
        np.testing.assert_array_equal(loaded.trajectory.at(times), result.trajectory.at(times))
        assert loaded.to_yaml() == (folder / "result.yaml").read_text()


def test_members_have_the_shapes_that_are_promised(calibrated):
    result, _ = calibrated
    left, imu = result.cameras["left"], result.imus["left_imu"]
    assert left.reference_from_camera.shape == (4, 4) and left.rotation_std_deg.shape == (3,)
    np.testing.assert_allclose(left.reference_from_camera[:3, :3] @ left.reference_from_camera[:3, :3].T, np.eye(3), atol=1e-12)
    np.testing.assert_array_equal(imu.reference_from_imu, np.eye(4))
    assert imu.gyroscope_scale_misalignment.shape == (3, 3) and imu.accelerometer_bias_m_s2.shape == (3,)
    assert np.linalg.norm(result.gravity_m_s2) == pytest.approx(9.81, abs=0.1)
    assert result.reference == "left_imu" and result.version == evical.__version__
    assert left.windows["used"] > 100 and result.timing_s["total"] > 0


def test_covariances_go_by_name(calibrated):
    result, _ = calibrated
    left, covariance = result.cameras["left"], result.covariance
    assert covariance["left.time_offset"] ** 0.5 == pytest.approx(left.time_offset_std_s)
    sigmas = [covariance[f"left.translation.{axis} [m]"] ** 0.5 for axis in "xyz"]
    np.testing.assert_allclose(sigmas, left.translation_std_m)
    names = ["left.rotation.x", "left.time_offset"]
    np.testing.assert_array_equal(covariance.of(names)[0, 1], covariance["left.rotation.x", "left.time_offset"])
    np.testing.assert_allclose(np.diagonal(covariance.correlation)[covariance.std > 0], 1.0)
    assert len(covariance) == len(covariance.names) == len(covariance.std)
    with pytest.raises(evical.InputError, match="was not estimated. Use one of: left.rotation.x"):
        covariance["left.rotation.w"]


def test_trajectory_agrees_with_its_file(calibrated):
    result, folder = calibrated
    rows = np.genfromtxt(folder / "trajectory.csv", delimiter=",", skip_header=1)
    poses = result.trajectory.at(rows[:, 0])
    inside = np.isfinite(poses[:, 0, 0])
    assert inside.sum() > 0.99 * len(rows)
    np.testing.assert_allclose(poses[inside, :3, 3], rows[inside, 1:4], atol=1e-6)
    x, y, z, w = rows[inside, 4:8].T
    np.testing.assert_allclose(poses[inside, 0, 1], 2 * (x * y - z * w), atol=1e-6)


def test_a_camera_is_where_its_clock_and_pose_say(calibrated):
    result, _ = calibrated
    left = result.cameras["left"]
    pose = result.trajectory.camera_at("left", 2.0)
    offset_s = left.time_offset_s + 1e-6 * left.clock_drift_ppm * (2.0 - left.clock_drift_at_s)
    np.testing.assert_allclose(pose, result.trajectory.at(2.0 + offset_s) @ left.reference_from_camera, atol=1e-12)
    with pytest.raises(evical.InputError, match="Use one of: left"):
        result.trajectory.camera_at("right", 2.0)


def test_times_have_any_shape_and_are_nan_outside(calibrated):
    trajectory = calibrated[0].trajectory
    assert trajectory.at(1).shape == (4, 4)
    assert trajectory.at([[1, 2, 3], [1, 2, 3]]).shape == (2, 3, 4, 4)
    assert trajectory.at([]).shape == (0, 4, 4)
    outside = trajectory.at([trajectory.begin_s - 0.01, trajectory.end_s + 0.01, np.nan])
    assert np.isnan(outside).all()
    assert np.isfinite(trajectory.at([trajectory.begin_s, trajectory.end_s])).all()
    for wrong in ("soon", None, [[1, 2], [3]]):
        with pytest.raises((TypeError, ValueError)):
            trajectory.at(wrong)


def test_parts_keep_their_result(calibrated):
    left = evical.Result.load(calibrated[1]).cameras["left"]
    trajectory = evical.Result.load(calibrated[1]).trajectory
    assert left.time_offset_s == calibrated[0].cameras["left"].time_offset_s and np.isfinite(trajectory.at(1.0)).all()


def test_nothing_of_a_result_can_be_changed(calibrated):
    with pytest.raises(AttributeError):
        calibrated[0].status = "ok"
    result = calibrated[0]
    left, imu = result.cameras["left"], result.imus["left_imu"]
    arrays = [result.gravity_m_s2, left.reference_from_camera, left.rotation_std_deg, left.translation_std_m,
              imu.gyroscope_bias_rad_s, imu.gyroscope_scale_misalignment, imu.accelerometer_bias_std_m_s2, result.covariance.matrix,
              result.covariance.std, result.covariance.correlation, left.intrinsics.matrix]
    for array in arrays:
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    for mapping in (result.timing_s, left.windows):
        with pytest.raises(TypeError):
            mapping["total"] = 0
    own = left.reference_from_camera.copy()
    own[0, 3] = 99  # as can be done with what a method returns
    result.trajectory.at([1.0, 2.0])[0, 0, 3] = 99


def test_a_result_of_an_older_program_has_what_it_has(result_folder):
    """run.data of another version, and a result.yaml without later keys."""
    file = result_folder / "run.data"
    data = bytearray(file.read_bytes())
    data[len(data) // 2:] = b""
    file.write_bytes(data)
    text = (result_folder / "result.yaml").read_text()
    text = text[:text.index("uncertainty:")] + text[text.index("notes:"):] if "notes:" in text[text.index("uncertainty:"):] else \
        text[:text.index("uncertainty:")]
    text = re.sub(r"^ *clock_drift\w*:.*\n", "", text, flags=re.MULTILINE)
    (result_folder / "result.yaml").write_text(text)
    old = evical.Result.load(result_folder)
    assert old.missing and all(isinstance(each, str) for each in old.missing)
    assert old.cameras["left"].time_offset_s == pytest.approx(0.007, abs=0.001)


def test_without_run_data_there_is_no_trajectory_and_it_says_why(result_folder):
    (result_folder / "run.data").unlink()
    old = evical.Result.load(result_folder)
    assert old.missing == ["the trajectory: there is no run.data next to result.yaml"]
    assert np.isfinite(old.cameras["left"].reference_from_camera).all() and len(old.covariance) > 10
    with pytest.raises(evical.InputError, match="trajectory: the result has none .*no run.data.*calibrate again"):
        old.trajectory


def test_a_file_by_itself_is_a_result(result_folder, tmp_path):
    alone = tmp_path / "my_rig.yaml"
    alone.write_text((result_folder / "result.yaml").read_text())
    assert list(evical.Result.load(alone).cameras) == ["left"]


def test_a_result_of_a_newer_program_is_refused(result_folder):
    file = result_folder / "result.yaml"
    file.write_text(file.read_text().replace("evical_result: 1", "evical_result: 2"))
    with pytest.raises(evical.InputError, match="result.yaml: evical_result"):
        evical.Result.load(result_folder)


def test_run_data_of_another_run_is_not_mixed_in(result_folder):
    file = result_folder / "result.yaml"
    text = file.read_text()
    begin, end = text.index("\nuncertainty:\n"), text.index("\nnotes:")
    text = text[:begin] + text[end:]  # its columns are of the IMU, too
    imus = text.index("imus:\n")
    file.write_text(text[:imus] + text[text.index("\n", text.index("gravity_m_s2") - 2) + 1:])
    other = evical.Result.load(result_folder)
    assert any("another run" in each for each in other.missing)


@pytest.mark.parametrize("content", [b"", b"evical_session: 1\n", b"\0\1\2", b"evical_result: 1\ncameras: 3\n"])
def test_what_is_no_result_is_refused(tmp_path, content):
    file = tmp_path / "result.yaml"
    file.write_bytes(content)
    with pytest.raises(evical.InputError, match="result.yaml"):
        evical.Result.load(file)
    with pytest.raises(evical.InputError):
        evical.Result.load(tmp_path / "nothing")
    with pytest.raises(TypeError):
        evical.Result.load(3)


def test_a_result_goes_to_another_process(calibrated):
    result, _ = calibrated
    times = np.linspace(0.5, 5, 20)
    for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
        assert again.to_yaml() == result.to_yaml() and again.missing == result.missing
        np.testing.assert_array_equal(again.covariance.matrix, result.covariance.matrix)
        np.testing.assert_array_equal(again.trajectory.at(times), result.trajectory.at(times))
    trajectory = pickle.loads(pickle.dumps(result.trajectory))
    np.testing.assert_array_equal(trajectory.at(times), result.trajectory.at(times))
    left = pickle.loads(pickle.dumps(result.cameras["left"]))
    np.testing.assert_array_equal(left.reference_from_camera, result.cameras["left"].reference_from_camera)
    assert pickle.loads(pickle.dumps(result.imus["left_imu"])).name == "left_imu"


def test_a_damaged_pickle_is_refused(calibrated):
    result, _ = calibrated
    yaml, data, missing = result.__getstate__()
    with pytest.raises(evical.InputError, match="another version"):
        evical.Result.__new__(evical.Result).__setstate__((yaml, data[:100], missing))


def test_sensors_of_a_result_are_not_assigned(calibrated):
    with pytest.raises(TypeError):
        calibrated[0].cameras["left"] = None


def test_result_yaml_is_the_truth(result_folder, calibrated, caplog):
    """run.data is its cache: an edited result.yaml counts, with what it does not contain missing."""
    file = result_folder / "result.yaml"
    text = file.read_text()
    file.write_text(re.sub(r"time_offset_s: \S+", "time_offset_s: 0.5", text, count=1))  # the camera's comes first
    changed = evical.Result.load(result_folder)
    assert changed.cameras["left"].time_offset_s == 0.5
    assert any("result.yaml was changed later" in each for each in changed.missing)
    assert any("result.yaml was changed later" in record.getMessage() for record in caplog.records)
    with pytest.raises(evical.InputError, match="trajectory: the result has none .*changed later"):
        changed.trajectory
    file.write_text(text)
    assert evical.Result.load(result_folder).missing == []


def test_run_data_of_a_run_with_the_same_sensors_is_not_mixed_in(result_folder, session, tmp_path):
    session.time_range_s = (0, 4)
    other = evical.calibrate(session, output=tmp_path / "other")
    (result_folder / "result.yaml").write_bytes((tmp_path / "other" / "result.yaml").read_bytes())
    mixed = evical.Result.load(result_folder)
    assert mixed.cameras["left"].time_offset_s == pytest.approx(other.cameras["left"].time_offset_s, rel=1e-12)
    assert any("another run" in each for each in mixed.missing)


def test_a_truth_has_no_sigmas_and_no_status(simulated):
    truth = evical.Result.load(simulated / "short_bag" / "truth.yaml")
    for again in (truth, pickle.loads(pickle.dumps(truth))):
        left, imu = again.cameras["left"], again.imus["left_imu"]
        assert again.status == "truth" and "truth" in repr(again)
        for numbers in (left.rotation_std_deg, left.translation_std_m, left.time_offset_std_s, left.clock_drift_std_ppm,
                        left.reprojection_rms_px, imu.gyroscope_bias_std_rad_s, imu.accelerometer_bias_std_m_s2,
                        imu.gyroscope_rms_rad_s, imu.accelerometer_rms_m_s2):
            assert np.isnan(numbers).all()
        assert np.isfinite(left.reference_from_camera).all() and np.isfinite(left.time_offset_s)
        assert again.to_yaml().startswith("evical_truth: 1")


def test_what_was_not_estimated_has_the_sigma_0(calibrated):
    np.testing.assert_array_equal(calibrated[0].imus["left_imu"].rotation_std_deg, 0)  # the reference


@pytest.mark.parametrize("kind", ["datetime64[ns]", "timedelta64[ns]", "complex128", "str"])
def test_times_of_other_types_are_refused(calibrated, kind):
    times = np.array([1, 2]).astype(kind)
    for call in (calibrated[0].trajectory.at, lambda t: calibrated[0].trajectory.camera_at("left", t)):
        with pytest.raises(TypeError, match="times_s must be numbers: seconds since Result.start_ns"):
            call(times)


def test_times_in_nanoseconds_are_refused(calibrated):
    result = calibrated[0]
    absolute = result.start_ns + np.array([10**9, 2 * 10**9])
    for times in (absolute, absolute - result.start_ns, absolute * 1e-9 + 1.7e9, absolute[0]):
        with pytest.raises(evical.InputError, match="is not a time of this recording, whose trajectory is from"):
            result.trajectory.at(times)
    seconds = 1e-9 * (absolute - result.start_ns)
    assert np.isfinite(result.trajectory.at(seconds)).all()


def test_poses_that_are_all_nan_are_a_warning(calibrated, caplog):
    trajectory = calibrated[0].trajectory
    trajectory.at([trajectory.end_s + 1, 1.0])
    assert caplog.records == []
    assert np.isnan(trajectory.at([1500.0, 2500.0])).all()
    assert "all poses are NaN" in caplog.records[0].getMessage()
