"""Objects that outlive what they came from: sessions that change, threads, the interpreter's end, forks, pickles, made-up states.

CI also runs this file with AddressSanitizer (python_asan)."""

import copy
import gc
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import evical

PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)
TYPES = [each for each in vars(evical._evical).values() if isinstance(each, type)]


# Sessions


def test_sensors_stay_valid_when_a_value_is_set(session):
    for imu in session.imus.values():
        session.set(f"imus.{imu.name}.acceleration_unit", "m/s^2")
        assert imu.name == "left_imu"
    camera, imu, board = session.cameras["left"], session.imus["left_imu"], session.board
    for k in range(50):
        session.set("grid.min_circles", 7 + k % 3)
        imu.gyroscope_noise_density = 1e-4 * (k + 1)
        camera.stream = f"/a/longer/name/than/a/short/string/{k}"
        board.rows = 3 + k
        gc.collect()
        assert session.imus["left_imu"].gyroscope_noise_density == imu.gyroscope_noise_density == 1e-4 * (k + 1)
        assert session.cameras["left"].stream == camera.stream == f"/a/longer/name/than/a/short/string/{k}"
        assert session.board.rows == board.rows == 3 + k
    with pytest.raises(evical.InputError):
        session.set("grid.min_circles", -1)
    del session
    gc.collect()
    assert camera.name == "left" and imu.name == "left_imu" and board.rows == 52


def test_a_lens_is_not_changed_by_the_session_it_came_from(session):
    camera = session.cameras["left"]
    before = camera.intrinsics
    kept = before.to_dict()
    camera.intrinsics = evical.Camera({**kept, "focal_length_px": [111, 112]})
    assert before.to_dict() == kept and camera.intrinsics.focal_length_px[0] == 111
    camera.intrinsics = None
    del session, camera
    gc.collect()
    assert before.to_dict() == kept


def test_threads_change_and_use_one_session(session):
    failures = []

    def use(number):
        try:
            for k in range(100):
                session.set("grid.min_circles", 7 + (number + k) % 5)
                session.imus["left_imu"].stream = f"/a/stream/with/a/long/name/{number}/{k}"
                session.copy().to_yaml()
                assert session.cameras["left"].name == "left"
        except BaseException as error:  # the thread's failure is the test's
            failures.append(error)

    threads = [threading.Thread(target=use, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []


# Pickles and made-up states


@pytest.fixture
def things(session, calibrated, bag):
    result, _ = calibrated
    return {"Session": session, "Board": session.board, "Camera": session.cameras["left"].intrinsics, "Result": result,
            "CameraResult": result.cameras["left"], "ImuResult": result.imus["left_imu"], "Trajectory": result.trajectory}


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_every_protocol_pickles_what_can_be_pickled(things, protocol):
    for name, thing in things.items():
        again = pickle.loads(pickle.dumps(thing, protocol))
        assert type(again).__name__ == name and repr(again) == repr(thing)


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_every_protocol_refuses_the_rest(session, bag, protocol):
    with evical.open(bag) as recording:
        packet = next(recording)
        for thing in (recording, packet, packet.stream, session.cameras["left"], session.imus["left_imu"]):
            with pytest.raises(TypeError, match="cannot pickle"):
                pickle.dumps(thing, protocol)
            with pytest.raises(TypeError, match="cannot pickle"):
                copy.copy(thing)


def uses_of(thing):
    yield lambda: repr(thing)
    yield lambda: pickle.dumps(thing)
    yield lambda: hash(thing) if type(thing).__hash__ is not object.__hash__ else repr(thing)
    for name in vars(type(thing)):
        if not name.startswith("__"):
            yield lambda name=name: getattr(thing, name)


@pytest.mark.parametrize("kind", TYPES, ids=lambda kind: kind.__name__)
def test_an_object_without_content_is_refused(kind):
    for use in uses_of(kind.__new__(kind)):
        try:
            use()
        except (TypeError, evical.InputError):
            pass


@pytest.mark.parametrize("state", [(), (None,), (None, 0), (None, None, None), ({},), ("",), (b"",), ("", ""), ("", b"", []),
                                   ("evical_result: 1\n", b"evical run data\n", []), ([],) * 8, (1, 2, 3, 4, 5, 6, 7, 8)])
@pytest.mark.parametrize("name", ["Session", "Board", "Camera", "Result", "CameraResult", "ImuResult", "Trajectory", "IntrinsicsResult"])
def test_a_state_that_nobody_made_is_refused(name, state):
    kind = getattr(evical, name)
    thing = kind.__new__(kind)
    with pytest.raises((TypeError, evical.InputError)):
        thing.__setstate__(state)
        pytest.fail("accepted")


def test_a_state_with_parts_of_others_is_refused(calibrated):
    result, _ = calibrated
    for kind, state in ((evical.CameraResult, (result, 7)), (evical.ImuResult, (result, 2**40))):
        with pytest.raises(evical.InputError, match="is damaged, or comes from another version"):
            kind.__new__(kind).__setstate__(state)
    lens = result.cameras["left"].intrinsics.to_dict()
    for key, value in (("resolution_px", [2**31 - 1, 2**31 - 1]), ("focal_length_px", [float("nan"), 1.0]), ("model", "none")):
        with pytest.raises(evical.InputError):
            evical.Camera.__new__(evical.Camera).__setstate__(({**lens, key: value},))


def test_a_second_state_changes_nothing(session):
    before = session.to_yaml()
    camera = session.cameras["left"]
    session.__setstate__(session.__getstate__())
    session.board.__init__()
    assert session.to_yaml() == before and camera.name == "left"


# Threads


def in_a_program(text, *arguments, timeout_s=60):
    return subprocess.run([sys.executable, "-c", text, *map(str, arguments)], capture_output=True, text=True, timeout=timeout_s)


DAEMON = """
import evical, os, sys, threading, time
folder, hdf5 = sys.argv[1:3]
session = evical.Session.load(folder + "/session.yaml")
started = threading.Event()

def note(stage, fraction):
    started.set()

def sleep(stage, fraction):
    started.set()
    time.sleep(0.7)

def calibrate():
    evical.calibrate(session, progress=note)

def sleep_in_progress():
    evical.calibrate(session, progress=sleep)

def guess():
    evical.Session.guess(folder + "/recording.bag", progress=note)

def read():
    while True:
        with evical.open(folder + "/recording.bag") as recording:
            for packet in recording:
                started.set()

def read_hdf5():
    while True:
        with evical.open(hdf5) as recording:
            for packet in recording:
                started.set()

def load():
    while True:
        evical.Session.load(folder + "/session.yaml")
        started.set()

threads = [threading.Thread(target=globals()[name], daemon=True) for name in sys.argv[3:]]
for thread in threads:
    thread.start()
started.wait(30)
time.sleep(0.1)
"""


@pytest.mark.parametrize("calls", [["calibrate"], ["sleep_in_progress"], ["guess"], ["read"], ["read_hdf5"], ["load"],
                                   ["calibrate", "read", "load", "read", "sleep_in_progress"]], ids="+".join)
def test_daemon_threads_do_not_disturb_the_end(simulated, source, calls):
    hdf5 = source / "tests" / "data" / "recordings" / "metavision_ecf.hdf5"
    ran = in_a_program(DAEMON, simulated / "short_bag", hdf5, *calls)
    assert (ran.returncode, ran.stderr) == (0, "")


def test_a_call_at_the_end_still_works(simulated):
    """A function that was registered before the module is called after it."""
    text = ("import atexit, sys\n"
            "def last():\n"
            "    import evical\n"
            "    print(evical.inspect(sys.argv[1])['format'], evical.Session.guess(sys.argv[1]).cameras.keys())\n"
            "atexit.register(last)\n"
            "import evical\n")
    ran = in_a_program(text, simulated / "short_bag" / "recording.bag")
    assert ran.returncode == 0 and ran.stdout.startswith("rosbag"), ran.stderr


def children_of(parent):
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat") as file:
                fields = file.read().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(fields[1]) == parent and fields[0] != "Z":
            found.append(int(name))
    return found


@pytest.fixture
def hung(source):
    """A recording whose reader does not answer while a thread waits for a packet."""
    before = set(children_of(os.getpid()))
    recording = evical.open(source / "tests" / "data" / "recordings" / "metavision_ecf.hdf5")
    [server] = set(children_of(os.getpid())) - before
    os.kill(server, signal.SIGSTOP)
    counts = []
    thread = threading.Thread(target=lambda: counts.append(sum(len(packet) for packet in recording)))
    thread.start()
    time.sleep(0.2)
    yield recording
    os.kill(server, signal.SIGCONT)
    thread.join()
    assert counts and counts[0] > 0


def test_what_is_known_of_a_recording_does_not_wait_for_a_reader(hung):
    begin = time.monotonic()
    assert hung.fraction_read < 1 and hung.faults is not None and len(hung.streams) > 0 and not hung.closed
    assert "metavision_ecf.hdf5" in repr(hung)
    assert time.monotonic() - begin < 2


@pytest.mark.parametrize("call", [next, evical.Recording.close], ids=["next", "close"])
def test_signals_end_the_wait_for_another_reader(hung, call):
    class Alarm(Exception):
        pass

    def ring(*_):
        raise Alarm

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    begin = time.monotonic()
    try:
        with pytest.raises(Alarm):
            call(hung)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert time.monotonic() - begin < 5


# Forks


def in_a_fork(work):
    """What `work` returns, or the error that it raises, in a forked process."""
    fork = multiprocessing.get_context("fork")
    receiver, sender = fork.Pipe(duplex=False)

    def run():
        try:
            sender.send(work())
        except BaseException as error:  # handed to the parent
            sender.send(error)

    process = fork.Process(target=run)
    process.start()
    assert receiver.poll(60), "the child does not answer"
    answer = receiver.recv()
    process.join(60)
    assert process.exitcode == 0
    return answer


@pytest.mark.parametrize("name", ["recording.bag", "metavision_ecf.hdf5", "pictures"])
def test_a_fork_does_not_take_the_parents_data(source, bag, tmp_path, name):
    path = bag if name == bag.name else source / "tests" / "data" / "recordings" / name
    if name == "pictures":
        path = tmp_path / name
        path.mkdir()
        for number in range(40):
            (path / f"{number:03}.pgm").write_bytes(b"P5 4 3 255\n" + bytes(12))
    with evical.open(path) as recording:
        expected = sum(len(packet) for packet in recording)
    recording = evical.open(path)
    count = len(next(recording))

    def use():
        texts = []
        for call in (lambda: next(recording), lambda: iter(recording), lambda: recording.streams, lambda: recording.faults,
                     lambda: recording.fraction_read, recording.__enter__):
            try:
                call()
            except evical.InputError as error:
                texts.append(str(error))
        recording.close()
        return texts, recording.closed, repr(recording), sum(len(packet) for packet in evical.open(path))

    texts, closed, shown, own = in_a_fork(use)
    assert len(texts) == 6 and all("opened by another process" in text and path.name in text for text in texts)
    assert closed and "of another process" in shown and own == expected
    assert count + sum(len(packet) for packet in recording) == expected
    recording.close()


def test_a_fork_may_calibrate(session, calibrated):
    """The start method of multiprocessing, while this process has threads in the module."""
    stop = threading.Event()

    def read():
        while not stop.is_set():
            session.copy().to_yaml()

    thread = threading.Thread(target=read)
    thread.start()
    try:
        result = in_a_fork(lambda: evical.calibrate(session))
    finally:
        stop.set()
        thread.join()
    np.testing.assert_array_equal(result.cameras["left"].reference_from_camera, calibrated[0].cameras["left"].reference_from_camera)
