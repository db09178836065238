"""evical.open and evical.inspect."""

import gc
import json
import os
import subprocess
import sys
import threading

import numpy as np
import pytest

import evical
from program import program_output


def read_all(path, streams=None):
    with evical.open(path, streams=streams) as recording:
        return list(recording)


def test_events_are_those_the_command_line_counts(bag):
    told = {each["name"]: each for each in json.loads(program_output("inspect", "--json", "--checksum", bag))["streams"]}
    packets = read_all(bag, "events")
    events = np.concatenate([packet.events for packet in packets])
    expected = told[packets[0].stream.name]
    assert events.dtype.names == ("t", "x", "y", "p")
    assert len(events) == expected["count"]
    assert events["p"].sum() == expected["on"]
    assert events["x"].sum(dtype=np.uint64) == expected["sum_x"]
    assert events["y"].sum(dtype=np.uint64) == expected["sum_y"]
    assert events["t"][0] == expected["first_ns"] and events["t"][-1] == expected["last_ns"]


def test_imu_samples_are_those_the_command_line_averages(bag):
    told = {each["name"]: each for each in json.loads(program_output("inspect", "--json", bag))["streams"]}
    packets = read_all(bag, "imu")
    samples = np.concatenate([packet.imu for packet in packets])
    expected = told[packets[0].stream.name]
    assert len(samples) == expected["count"]
    np.testing.assert_allclose(samples["acceleration"].mean(axis=0), expected["mean_acceleration"], atol=1e-6)
    np.testing.assert_allclose(samples["angular_rate"].mean(axis=0), expected["mean_angular_rate"], atol=1e-6)
    assert packets[0].stream.acceleration_to_m_s2 == 1.0


def test_inspect_says_what_the_command_line_says(bag):
    assert evical.inspect(bag) == json.loads(program_output("inspect", "--json", "--checksum", bag))


@pytest.mark.parametrize("name", ["evlib_event.txt", "metavision_ecf.hdf5", "ros1_evt3_with_triggers.bag", "rosbag_python_bz2.bag"])
def test_every_format_gives_as_many_events_as_inspect_counts(source, name):
    path = source / "tests" / "data" / "recordings" / name
    counts = {each["name"]: each["count"] for each in evical.inspect(path)["streams"] if each["type"] == "events"}
    read = dict.fromkeys(counts, 0)
    for packet in read_all(path):
        if packet.stream.type == "events":
            read[packet.stream.name] += len(packet.events)
    assert read == counts and sum(read.values()) > 0


def test_events_are_the_packets_own_memory_and_outlive_it(bag):
    with evical.open(bag, streams="events") as recording:
        packet = next(recording)
        events = packet.events
    before = events.copy()
    assert not events.flags.owndata and np.shares_memory(events, packet.events)
    del packet, recording
    gc.collect()
    np.testing.assert_array_equal(events, before)


def test_memory_does_not_grow_with_the_recording(bag):
    """Reading the whole recording needs little more memory than reading one packet."""

    def peak_kb(packets):
        text = ("import evical, itertools, resource, sys\n"
                "with evical.open(sys.argv[1]) as recording:\n"
                f"    n = sum(len(p) for p in itertools.islice(recording, {packets}))\n"
                "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)")
        return int(subprocess.run([sys.executable, "-c", text, str(bag)], check=True, capture_output=True).stdout)

    size_kb = bag.stat().st_size / 1024
    assert peak_kb(None) - peak_kb(1) < 0.25 * size_kb


def test_frames_are_arrays_of_the_pictures_size(source, tmp_path):
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    pixels = (np.arange(40 * 30) % 251).astype(np.uint8).reshape(30, 40)
    for number in range(3):
        (pictures / f"{number:03}.pgm").write_bytes(b"P5 40 30 255\n" + (pixels + number).tobytes())
    frames = [frame for packet in read_all(pictures) for frame in packet.frames]
    assert [frame.format for frame in frames] == ["encoded"] * 3
    np.testing.assert_array_equal(frames[2].image, pixels + 2)


def test_a_damaged_picture_is_an_error_of_its_own(tmp_path):
    pictures = tmp_path / "pictures"
    pictures.mkdir()
    for number in range(2):
        (pictures / f"{number}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + b"\0" * 40)
    try:
        frames = [frame for packet in read_all(pictures) for frame in packet.frames]
    except evical.InputError:
        return  # refused completely, which is also correct
    for frame in frames:
        with pytest.raises(evical.InputError):
            frame.image


def test_a_closed_recording_says_so(bag):
    recording = evical.open(bag)
    next(recording)
    recording.close()
    recording.close()
    assert recording.closed and recording.format == "rosbag" and len(recording.streams) >= 2
    for use in (lambda: next(recording), lambda: iter(recording), recording.__enter__):
        with pytest.raises(evical.ClosedError, match="recording.bag: the recording is closed. Open it again"):
            use()
    assert issubclass(evical.ClosedError, ValueError)


def test_a_recording_that_was_read_to_its_end_gives_nothing_more(bag):
    with evical.open(bag, streams="imu") as recording:
        assert len(list(recording)) > 0
        assert list(recording) == []
        assert recording.fraction_read == pytest.approx(1.0, abs=0.01)


def test_what_is_not_there_is_said_in_the_command_lines_words(tmp_path):
    missing = tmp_path / "none.bag"
    with pytest.raises(evical.InputError) as caught:
        evical.open(missing)
    told = subprocess.run([program_output.path, "inspect", missing], capture_output=True, text=True)
    assert told.returncode == 2
    assert str(caught.value) == told.stderr.strip()
    assert caught.value.place == str(missing) and caught.value.advice == "Check the path"


def test_unknown_streams_are_listed(bag):
    with pytest.raises(evical.InputError, match="Its streams of this type: .*events"):
        evical.open(bag, streams=["nothing"])


@pytest.mark.parametrize("path, streams", [(3, None), (None, None), ("x.bag", 3), ("x.bag", [3])])
def test_wrong_types_are_type_errors(path, streams):
    with pytest.raises(TypeError):
        evical.open(path, streams=streams)


def test_two_threads_share_a_recording(bag):
    """Each packet goes to one of them, none is lost."""
    expected = sum(len(packet) for packet in read_all(bag))
    counts = []
    with evical.open(bag) as recording:
        threads = [threading.Thread(target=lambda: counts.append(sum(len(packet) for packet in recording))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert sum(counts) == expected


def test_closing_under_a_reading_thread_ends_it(bag):
    recording = evical.open(bag)
    ended = []
    started = threading.Event()

    def read():
        try:
            for _ in recording:
                started.set()
            ended.append("end")
        except evical.ClosedError:
            ended.append("closed")

    thread = threading.Thread(target=read)
    thread.start()
    started.wait()
    recording.close()
    thread.join()
    assert ended in (["closed"], ["end"])


@pytest.mark.parametrize("rows, steps, largest_ms", [([1, 2, 5, 3, 4, 6], "1 time", "0.002"), ([1, 50_000, 2, 60_000, 3], "2 times", "59.997")])
def test_times_that_run_backwards_are_a_fault(tmp_path, rows, steps, largest_ms):
    file = tmp_path / "events.txt"
    file.write_text("t_us,x,y,p\n" + "".join(f"{t},1,2,1\n" for t in rows))
    with evical.open(file) as recording:
        packets = [packet.events["t"] for packet in recording]
        assert sorted(np.concatenate(packets)) == [1000 * t for t in sorted(rows)]
        assert all((np.diff(times) >= 0).all() for times in packets)
        [fault] = [fault for fault in recording.faults if fault.kind == "backward_time"]
    assert f"runs backwards {steps} between packets, by {largest_ms} ms at most" in fault.text
    assert fault.stream == "events.txt"


def test_imu_times_that_run_backwards_are_a_fault(tmp_path):
    file = tmp_path / "imu.csv"
    file.write_text("t_us,ax,ay,az,gx,gy,gz\n" + "".join(f"{t},0,0,9.81,0,0,0\n" for t in (1000, 3000, 2000, 4000)))
    with evical.open(file) as recording:
        assert len(list(recording)) > 0 and "backward_time" in [fault.kind for fault in recording.faults]


def test_sorted_times_are_no_fault(bag):
    with evical.open(bag) as recording:
        assert len(list(recording)) > 0 and "backward_time" not in [fault.kind for fault in recording.faults]


@pytest.mark.parametrize("name", ["evlib_event.txt", "metavision_ecf.hdf5", "ros1_evt3_with_triggers.bag"])
def test_no_streams_are_no_packets(source, name):
    with evical.open(source / "tests" / "data" / "recordings" / name, streams=[]) as recording:
        assert len(recording.streams) > 0 and list(recording) == []


def test_own_records_are_read_again_with_their_times(bag, tmp_path):
    """NumPy's files state no unit, and pandas' tables neither."""
    with evical.open(bag, streams="events") as recording:
        events = np.concatenate([next(recording).events for _ in range(20)])
    events["t"] -= events["t"][0]  # times since 1970 show their unit
    packed = np.empty(len(events), dtype=[("t", "<i8"), ("x", "<u2"), ("y", "<u2"), ("p", "?")])
    for name in packed.dtype.names:
        packed[name] = events[name]
    np.save(tmp_path / "events.npy", events)
    np.save(tmp_path / "packed.npy", packed)
    np.savez(tmp_path / "events.npz", events=events)
    rows = [f"{event['t']},{event['x']},{event['y']},{event['p']}\n" for event in events]
    (tmp_path / "table.csv").write_text("t,x,y,p\n" + "".join(rows))
    (tmp_path / "with_index.csv").write_text(",t,x,y,p\n" + "".join(f"{k},{row}" for k, row in enumerate(rows)))
    for name in ("events.npy", "packed.npy", "events.npz", "table.csv", "with_index.csv"):
        with evical.open(tmp_path / name) as recording:
            again = np.concatenate([packet.events for packet in recording])
            assert "guess" in [fault.kind for fault in recording.faults]
        np.testing.assert_array_equal(again, events, name)


def test_times_in_us_with_the_same_names_stay_in_us(tmp_path):
    """Rates that no sensor has in ns."""
    times_us = 5_000_000 + 10 * np.arange(3000)
    other = np.zeros(3000, dtype=[("t", "<i8"), ("x", "<u2"), ("y", "<u2"), ("p", "?")])
    other["t"] = times_us
    np.save(tmp_path / "other.npy", other)
    (tmp_path / "other.csv").write_text("t,x,y,p\n" + "".join(f"{t},1,2,True\n" for t in times_us))
    for name in ("other.npy", "other.csv"):
        with evical.open(tmp_path / name) as recording:
            np.testing.assert_array_equal(np.concatenate([packet.events["t"] for packet in recording]), 1000 * times_us)


def test_the_current_folder_may_change_while_a_folder_is_read(tmp_path, monkeypatch):
    (tmp_path / "pictures").mkdir()
    for number in range(40):
        (tmp_path / "pictures" / f"{number:03}.pgm").write_bytes(b"P5 4 3 255\n" + bytes(12))
    monkeypatch.chdir(tmp_path)
    with evical.open("pictures") as recording:
        monkeypatch.chdir("/")
        assert sum(len(packet.frames) for packet in recording) == 40


def test_names_that_are_not_utf8_are_names(tmp_path):
    file = os.path.join(os.fsencode(tmp_path), b"l\xf6g.txt")
    with open(file, "w") as text:
        text.write("t_us,x,y,p\n" + "".join(f"{t},1,2,1\n" for t in (3, 1, 2)))
    with evical.open(os.fsdecode(file)) as recording:
        [stream] = recording.streams
        assert os.fsencode(stream.name) == b"l\xf6g.txt" and stream.message
        repr(stream).encode(), repr(recording).encode()
        assert len(list(recording)) > 0
        [repr(fault) + fault.stream + fault.text for fault in recording.faults]
    with evical.open(os.fsdecode(file), streams=[stream.name]) as recording:
        assert len(list(recording)) > 0
    assert evical.inspect(os.fsdecode(file))["streams"]
    session = evical.Session.guess(os.fsdecode(file))
    [camera] = session.cameras.values()
    assert camera.stream == stream.name
    camera.stream = stream.name
    for use in (lambda: repr(session), lambda: session.to_yaml(), lambda: str(session.recording)):
        assert use()
    for wrong in (lambda: evical.open(os.fsdecode(file + b"2")), lambda: evical.Session.load(os.fsdecode(file)),
                  lambda: evical.Camera.load(os.fsdecode(file)), lambda: evical.Result.load(os.fsdecode(file)),
                  lambda: evical.calibrate(os.fsdecode(file)), lambda: evical.open(os.fsdecode(file), streams=["\udcf6"])):
        with pytest.raises(evical.InputError) as caught:
            wrong()
        assert str(caught.value).encode() and caught.value.place.encode()
