"""evical.Camera: points, rays, undistorted events."""

import numpy as np
import pytest

import evical

PINHOLE = {"model": "pinhole_radtan", "resolution_px": [346, 260], "focal_length_px": [250, 252],
           "principal_point_px": [172, 131], "distortion": [-0.33, 0.11, 0.0006, -0.0004]}
FISHEYE = {"model": "pinhole_equidistant", "resolution_px": [640, 480], "focal_length_px": [300, 301],
           "principal_point_px": [320, 240], "distortion": [0.01, -0.002, 0.0003, 0]}
WIDE = {"model": "double_sphere", "resolution_px": [640, 480], "focal_length_px": [180, 180],
        "principal_point_px": [320, 240], "distortion": [-0.2, 0.59]}

EVENT = np.dtype([("t", "<i8"), ("x", "<u2"), ("y", "<u2"), ("p", "?")])


def events_at(*pixels):
    return np.array([(k, x, y, k % 2) for k, (x, y) in enumerate(pixels)], dtype=EVENT)


def radtan(points, map):
    """OpenCV's equations, implemented independently."""
    x, y = points[..., 0] / points[..., 2], points[..., 1] / points[..., 2]
    k1, k2, p1, p2 = map["distortion"]
    r2 = x * x + y * y
    radial = 1 + k1 * r2 + k2 * r2 * r2
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.stack([u, v], axis=-1) * map["focal_length_px"] + map["principal_point_px"]


def test_project_is_opencvs_model():
    points = np.random.default_rng(1).uniform([-0.4, -0.3, 0.9], [0.4, 0.3, 1.5], (4, 25, 3))
    np.testing.assert_allclose(evical.Camera(PINHOLE).project(points), radtan(points, PINHOLE), atol=1e-9)


@pytest.mark.parametrize("map", [PINHOLE, FISHEYE, WIDE])
def test_unproject_is_the_way_back(map):
    camera = evical.Camera(map)
    pixels = np.stack(np.meshgrid(np.arange(20, 300, 40), np.arange(20, 240, 40)), axis=-1).astype(float)
    rays = camera.unproject(pixels)
    assert rays.shape == pixels.shape[:-1] + (3,)
    np.testing.assert_allclose(np.linalg.norm(rays, axis=-1), 1)
    np.testing.assert_allclose(camera.project(rays), pixels, atol=1e-6)


def test_what_is_not_seen_is_nan():
    camera = evical.Camera(PINHOLE)
    assert np.isnan(camera.project([[0, 0, -1], [0, 0, 0]])).all()
    assert np.isfinite(camera.project([0, 0, 1])).all()


@pytest.mark.parametrize("map", [PINHOLE, WIDE])
def test_undistorted_pixels_are_those_of_the_matrix(map):
    camera = evical.Camera(map)
    pixels = np.array([[172.0, 131.0], [60, 40], [300, 200]])
    rays = camera.unproject(pixels)
    straight = (camera.matrix @ (rays / rays[:, 2:]).T).T[:, :2]
    np.testing.assert_allclose(camera.undistort(pixels), straight, atol=1e-6)
    events = events_at((172, 131), (60, 40), (300, 200))
    undistorted = camera.undistort_events(events)
    np.testing.assert_allclose(np.stack([undistorted["x"], undistorted["y"]], axis=1), straight, atol=1e-3)
    np.testing.assert_array_equal(undistorted["t"], events["t"])
    np.testing.assert_array_equal(undistorted["p"], events["p"])


def test_events_of_other_programs_are_taken():
    """Other orders, other types, parts of larger records, polarity as -1 and 1."""
    other = np.array([(-1, 5, 6, 9.5, 17), (1, 7, 8, 9.5, 18)],
                     dtype=[("p", "i1"), ("y", ">u4"), ("x", "i8"), ("temperature", "f4"), ("t", "u8")])
    camera = evical.Camera(PINHOLE)
    got = camera.undistort_events(other)
    expected = camera.undistort([[6, 5], [8, 7]])
    np.testing.assert_allclose(got["x"], expected[:, 0], atol=1e-3)
    assert list(got["p"]) == [False, True] and list(got["t"]) == [17, 18]
    np.testing.assert_array_equal(camera.undistort_events(other[::-1])["t"], [18, 17])
    assert len(camera.undistort_events(other[:0])) == 0


def test_events_outside_are_refused_and_named():
    with pytest.raises(evical.InputError, match=r"event 1: \(346, 3\) is outside the camera's 346 x 260 pixels"):
        evical.Camera(PINHOLE).undistort_events(events_at((345, 3), (346, 3)))


@pytest.mark.parametrize("wrong", [[1, 2], np.zeros((3, 4)), np.zeros(3, dtype=[("t", "i8"), ("x", "u2"), ("y", "u2")]),
                                   np.zeros(3, dtype=[("t", "i8"), ("x", "f4"), ("y", "f4"), ("p", "?")]), None])
def test_what_is_no_array_of_events_is_a_type_error(wrong):
    with pytest.raises(TypeError):
        evical.Camera(PINHOLE).undistort_events(wrong)


def test_wrong_shapes_are_named():
    camera = evical.Camera(PINHOLE)
    with pytest.raises(ValueError, match=r"points must have the shape \(..., 3\), not \(5, 2\)"):
        camera.project(np.zeros((5, 2)))
    with pytest.raises(ValueError, match="pixels must have the shape"):
        camera.unproject(7)
    for call in (camera.project, camera.unproject, camera.undistort):
        with pytest.raises(TypeError, match="must be numbers"):
            call("where")
    assert camera.project(np.zeros((0, 3))).shape == (0, 2)


@pytest.mark.parametrize("key, value, said", [("focal_length_px", [0, 1], "focal_length_px"), ("model", "pinhole", "model"),
                                              ("distortion", [1, 2, 3, 4, 5, 6], "distortion"), ("resolution_px", [0, 0], "resolution_px")])
def test_numbers_that_make_no_camera_are_refused(key, value, said):
    with pytest.raises(evical.InputError, match=said):
        evical.Camera({**PINHOLE, key: value})


def test_maps_and_files_give_the_same(calibrated):
    result, folder = calibrated
    lens = result.cameras["left"].intrinsics
    assert evical.Camera(lens.to_dict()) == lens
    read = evical.Camera.load(folder / "result.yaml", "left")
    np.testing.assert_allclose(read.focal_length_px, lens.focal_length_px, rtol=1e-9)
    assert lens.coefficients[:4] == ["k1", "k2", "p1", "p2"] and len(lens.distortion) == len(lens.coefficients)
    with pytest.raises(evical.InputError):
        evical.Camera.load(folder / "none.yaml")


def test_undistort_events_takes_a_camera_of_a_result(calibrated):
    left = calibrated[0].cameras["left"]
    events = events_at((10, 20), (30, 40))
    np.testing.assert_array_equal(evical.undistort_events(events, left), left.intrinsics.undistort_events(events))


def test_a_name_is_that_of_a_camera_of_the_file(calibrated, tmp_path):
    _, folder = calibrated
    camchain = tmp_path / "camchain.yaml"
    camchain.write_text("cam0: {camera_model: pinhole, intrinsics: [250, 252, 172, 131], distortion_model: radtan, "
                        "distortion_coeffs: [0, 0, 0, 0], resolution: [346, 260]}\n")
    info = tmp_path / "info.yaml"
    info.write_text("image_width: 346\nimage_height: 260\ncamera_name: davis\ndistortion_model: plumb_bob\n"
                    "camera_matrix: {rows: 3, cols: 3, data: [250, 0, 172, 0, 252, 131, 0, 0, 1]}\n"
                    "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n")
    for file, name in ((folder / "result.yaml", "left"), (camchain, "cam0"), (info, "davis")):
        assert evical.Camera.load(file) == evical.Camera.load(file, name)
        with pytest.raises(evical.InputError, match=f"has no camera 'right'. Use one of: {name}"):
            evical.Camera.load(file, "right")
    alone = tmp_path / "alone.yaml"  # has no name
    alone.write_text(str(PINHOLE))
    assert evical.Camera.load(alone, "right") == evical.Camera(PINHOLE)


def test_fields_of_several_numbers_are_no_events():
    for name in ("t", "x", "y", "p"):
        fields = [(each, "i8", (3,)) if each == name else (each, "i8") for each in ("t", "x", "y", "p")]
        with pytest.raises(TypeError, match=f"the field {name} of the events must be one number per event"):
            evical.Camera(PINHOLE).undistort_events(np.zeros(5, dtype=fields))
    with pytest.raises(ValueError, match="events must have the shape"):
        evical.Camera(PINHOLE).undistort_events(np.zeros((2, 3), dtype=EVENT))


def test_masked_values_are_no_numbers():
    camera = evical.Camera(PINHOLE)
    events = np.ma.array(events_at((1, 2), (3, 4)))
    assert len(camera.undistort_events(events)) == 2
    events["x"][1] = np.ma.masked
    with pytest.raises(TypeError, match="must not have masked values"):
        camera.undistort_events(events)
    pixels = np.ma.array([[1.0, 2.0], [3.0, 4.0]], mask=[[False, False], [True, False]])
    for call in (camera.unproject, camera.undistort):
        with pytest.raises(TypeError, match="masked"):
            call(pixels)
        assert np.isfinite(call(pixels[:1])).all()


@pytest.mark.parametrize("name", ["t", "x", "y", "p"])
def test_numbers_that_int64_does_not_have_are_refused(name):
    events = np.zeros(3, dtype=[(each, "u8") for each in ("t", "x", "y", "p")])
    events[name][1] = 2**63
    with pytest.raises(evical.InputError, match=f"the field {name} has a number above 2\\^63"):
        evical.Camera(PINHOLE).undistort_events(events)


@pytest.mark.parametrize("wrong", [np.zeros((2, 3), dtype="datetime64[ns]"), np.zeros((2, 3), dtype=complex), [[1, 2, None]],
                                   np.array([["1", "2", "3"]])])
def test_what_numpy_would_convert_is_no_number(wrong):
    with pytest.raises(TypeError, match="points must be numbers"):
        evical.Camera(PINHOLE).project(wrong)


def test_many_and_few_events_are_undistorted_alike():
    camera = evical.Camera({**PINHOLE, "resolution_px": [40, 30], "principal_point_px": [20, 15]})
    few = events_at(*[(x, y) for x in range(40) for y in range(30)])
    many = np.concatenate([few, few])
    np.testing.assert_array_equal(camera.undistort_events(many)[:len(few)], camera.undistort_events(few))
    large = evical.Camera({**PINHOLE, "resolution_px": [30000, 30000], "principal_point_px": [15000, 15000]})
    assert len(large.undistort_events(events_at((15000, 15000)))) == 1  # without a table of all its pixels


def test_numbers_of_a_lens_are_read_only():
    camera = evical.Camera(PINHOLE)
    for name in ("focal_length_px", "principal_point_px", "distortion", "matrix"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(camera, name)[0] = 99
