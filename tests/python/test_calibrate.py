"""evical.calibrate and evical.intrinsics: outcome, progress, interruption, errors."""

import concurrent.futures
import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import evical
from program import program_output


def test_the_result_is_the_command_lines(session, tmp_path):
    """Equal in every digit, except for computing times."""
    session.save(tmp_path / "session.yaml")
    program_output("calibrate", tmp_path / "session.yaml", "-o", tmp_path / "told", "--quiet")
    evical.calibrate(session, output=tmp_path / "result")

    def numbers(folder):
        lines = (folder / "result.yaml").read_text().splitlines()
        text = "\n".join(lines)
        return text[text.index("cameras:"):text.index("timing_s:")]

    assert numbers(tmp_path / "result") == numbers(tmp_path / "told")
    assert {f.name for f in (tmp_path / "result").iterdir()} == {f.name for f in (tmp_path / "told").iterdir()}


def test_the_simulated_rig_is_found(calibrated):
    result, folder = calibrated
    truth = evical.Result.load(pathlib.Path(os.environ["EVICAL_SIMULATED"]) / "short_bag" / "truth.yaml")
    left, true = result.cameras["left"], truth.cameras["left"]
    assert abs(left.time_offset_s - true.time_offset_s) < 5 * left.time_offset_std_s
    translation = left.reference_from_camera[:3, 3] - true.reference_from_camera[:3, 3]
    assert (np.abs(translation) < 5 * left.translation_std_m).all()
    turn = left.reference_from_camera[:3, :3] @ true.reference_from_camera[:3, :3].T
    angle_deg = np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1)))
    assert angle_deg < 5 * np.linalg.norm(left.rotation_std_deg)


def test_progress_is_told_in_the_callers_thread(session):
    told = []
    evical.calibrate(session, progress=lambda stage, fraction: told.append((stage, fraction, threading.get_ident())))
    stages = list(dict.fromkeys(stage for stage, _, _ in told))
    assert stages == [stage for stage in ("detect", "initialise", "optimise") if stage in stages] and "detect" in stages
    assert all(0 <= fraction <= 1 for _, fraction, _ in told)
    assert {ident for _, _, ident in told} == {threading.get_ident()}


def test_other_threads_run_meanwhile(session):
    """Both run at the same time: each waits for the other in its progress callback."""
    meeting = threading.Barrier(2, timeout=120)
    met = []

    def once(stage, fraction):
        if threading.get_ident() not in met:
            met.append(threading.get_ident())
            meeting.wait()

    results = []
    threads = [threading.Thread(target=lambda: results.append(evical.calibrate(session, progress=once))) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(results) == 2
    np.testing.assert_array_equal(results[0].cameras["left"].reference_from_camera,
                                  results[1].cameras["left"].reference_from_camera)


def test_a_session_may_be_changed_while_it_is_calibrated(session, calibrated):
    def spoil(stage, fraction):
        session.board.rows = 3
        session.cameras["left"].stream = "/none"

    result = evical.calibrate(session, progress=spoil)
    np.testing.assert_array_equal(result.cameras["left"].reference_from_camera,
                                  calibrated[0].cameras["left"].reference_from_camera)


def test_what_progress_raises_ends_it_and_leaves_nothing(session, tmp_path):
    class Enough(Exception):
        pass

    def stop(stage, fraction):
        raise Enough(stage)

    with pytest.raises(Enough):
        evical.calibrate(session, output=tmp_path / "result", progress=stop)
    assert not (tmp_path / "result").exists()


@pytest.mark.parametrize("stage", ["detect", "optimise"])
def test_ctrl_c_raises_keyboard_interrupt_and_leaves_nothing(session, tmp_path, stage):
    sent = []

    def interrupt(at, fraction):
        if not sent and at == stage:
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        evical.calibrate(session, output=tmp_path / "result", progress=interrupt)
    print(f"{stage}: interrupted within {time.monotonic() - sent[0]:.3f} s")
    assert not (tmp_path / "result").exists()
    assert evical.Session.load(session.source).cameras  # the calibration continues


def test_ctrl_c_keeps_an_earlier_result(session, result_folder):
    before = (result_folder / "result.yaml").read_bytes()

    def interrupt(stage, fraction):
        signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        evical.calibrate(session, output=result_folder, progress=interrupt)
    assert (result_folder / "result.yaml").read_bytes() == before


def test_ctrl_c_ends_a_script_as_any_other(bag):
    """Signal from outside, without a handler of the test: Python's own traceback, and exit by the signal."""
    script = ("import evical, sys\n"
              "session = evical.Session.load(sys.argv[1])\n"
              "evical.calibrate(session, progress=lambda s, f: print(s, flush=True))\n")
    process = subprocess.Popen([sys.executable, "-c", script, str(bag.parent / "session.yaml")], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == -signal.SIGINT
    assert errors.rstrip().endswith("KeyboardInterrupt")


def test_reading_to_inspect_is_interrupted_too(bag):
    def interrupt(stage, fraction):
        signal.raise_signal(signal.SIGINT)

    try:
        evical.Session.guess(bag, progress=interrupt)
    except KeyboardInterrupt:
        return
    pytest.fail("KeyboardInterrupt was lost")


def test_a_bad_session_is_refused_in_the_command_lines_words(session, tmp_path):
    session.recording = tmp_path / "none.bag"
    file = tmp_path / "session.yaml"
    session.save(file)
    told = subprocess.run([program_output.path, "calibrate", file, "-o", tmp_path / "told", "--quiet"],
                          capture_output=True, text=True)
    assert told.returncode == 2
    with pytest.raises(evical.InputError) as caught:
        evical.calibrate(file, output=tmp_path / "result")
    assert str(caught.value) == told.stderr.strip().splitlines()[-1]
    assert not (tmp_path / "result").exists()


def spoil_board(session):
    session.board.rows = 1


def spoil_noise(session):
    session.imus["left_imu"].gyroscope_noise_density = -1


def spoil_size(session):
    session.cameras["left"].resolution_px = [0, -5]


def spoil_range(session):
    session.time_range_s = (5, 1)


def spoil_reference(session):
    session.reference = "right"


@pytest.mark.parametrize("spoil, key", [(spoil_board, "board"), (spoil_noise, "gyroscope_noise_density"), (spoil_size, "resolution_px"),
                                        (spoil_range, "time_range_s"), (spoil_reference, "reference")])
def test_attributes_that_make_no_session_are_refused(session, spoil, key):
    with pytest.raises(evical.InputError, match=key):
        spoil(session)
        evical.calibrate(session)


def test_a_recording_without_the_board_fails_with_the_reason_in_the_folder(session, tmp_path):
    session.board.cols, session.board.rows = 9, 13
    session.time_range_s = (0, 2)
    output = tmp_path / "result"
    output.mkdir()
    with pytest.raises(evical.CalibrationFailed) as caught:
        evical.calibrate(session, output=output)
    assert caught.value.problem and caught.value.advice
    failed = evical.Result.load(output)
    assert failed.status == "failed" and failed.reason == str(caught.value)
    with pytest.raises(evical.InputError, match="the result has none"):
        failed.trajectory


@pytest.mark.parametrize("arguments", [{"session": 3}, {"output": 3}, {"progress": 3}])
def test_wrong_types_are_type_errors(session, arguments):
    with pytest.raises(TypeError):
        evical.calibrate(**{"session": session, **arguments})


def test_a_lens_alone(simulated):
    folder = simulated / "intrinsics"
    session = evical.Session.load(folder / "session.yaml")
    found = evical.intrinsics(session)
    truth = evical.Result.load(folder / "truth.yaml").cameras
    true = next(iter(truth.values())).intrinsics
    assert found.std.shape == (9,) and found.covariance.shape == (9, 9) and found.views_used > 10
    assert (np.abs(found.intrinsics.focal_length_px - true.focal_length_px) < 6 * found.std[:2]).all()
    with pytest.raises(evical.InputError, match="is not a camera of the session. Use one of:"):
        evical.intrinsics(session, camera="none")


def test_processes_return_results(session):
    """The example of docs/python.md, with the start method spawn."""
    spawn = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(max_workers=1, mp_context=spawn) as pool:
        lens = pool.submit(evical.intrinsics, session)
        result = pool.submit(evical.calibrate, session).result(timeout=300)
    assert result.status in ("ok", "doubtful") and result.trajectory.end_s > result.trajectory.begin_s
    assert lens.result().intrinsics.model
