// evical.Camera: a lens with its parameters, projection, rays and undistorted events.
#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/interpreter.h"

#include <fmt/format.h>
#include <pybind11/operators.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace evical::python {
namespace {

namespace py = pybind11;

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

// A record of undistort_events.
struct UndistortedEvent {
  std::int64_t time_ns;
  float x_px, y_px;
  bool brighter;
};
using WholeNumbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

CameraIntrinsics checked(const CameraIntrinsics& camera) {
  validate(camera, "intrinsics");
  return camera;
}

// JSON is a subset of YAML, so the map is parsed like one in a session.
CameraIntrinsics readMap(const py::dict& map) {
  const auto text = py::module_::import("json").attr("dumps")(map).cast<std::string>();
  return readIntrinsics(YamlNode::parse(text, "intrinsics"));
}

CameraIntrinsics fromMap(const py::dict& map) {
  return checked(readMap(map));
}

py::dict toMap(const CameraIntrinsics& camera) {
  py::dict map;
  map["model"] = cameraModelName(camera.model);
  map["resolution_px"] = std::vector<int>{camera.resolution_px.width_px, camera.resolution_px.height_px};
  map["focal_length_px"] = std::vector<double>{camera.focal_length_px.x(), camera.focal_length_px.y()};
  map["principal_point_px"] =
      std::vector<double>{camera.principal_point_px.x(), camera.principal_point_px.y()};
  map["distortion"] = std::vector<double>(camera.distortion.begin(),
                                          camera.distortion.begin() + coefficientCount(camera.model));
  return map;
}

// Names that a file gives its cameras: a camchain, a result, or a camera_info; empty for other files.
std::vector<std::string> namedCameras(const YamlNode& root) {
  if (!root.isMap()) return {};
  if (root.has("evical_result")) return root["cameras"].keys();
  if (const auto name = root.find("camera_name"); name && name->isScalar()) return {name->text()};
  return camchainCameras(root);
}

// Unlike in a session, where the only camera of a file is meant, a name must be that of a camera.
CameraIntrinsics lensOf(const std::filesystem::path& file, const std::string& name) {
  const std::vector<std::string> known = namedCameras(loadIntrinsics(file));
  if (!name.empty() && !known.empty() && std::find(known.begin(), known.end(), name) == known.end())
    throw badInput(file.string(), fmt::format("has no camera '{}'", name), "Use one of: " + joined(known));
  return checked(readIntrinsicsFile(file, name, ""));
}

// Calls `apply(in, out)` for each point along the last axis.
template <class Apply>
Numbers forEachPoint(const Numbers& points, py::ssize_t columns_out, const Apply& apply) {
  Numbers out(shapeLike(points, 1, {columns_out}));
  const py::ssize_t columns_in = points.shape(points.ndim() - 1);
  const py::ssize_t count = columns_in == 0 ? 0 : points.size() / columns_in;
  const double* from = points.data();
  double* to = out.mutable_data();
  const OthersWork others_work;
  for (py::ssize_t i = 0; i < count; ++i) apply(from + i * columns_in, to + i * columns_out);
  return out;
}

template <int Size>
void write(const std::optional<Eigen::Matrix<double, Size, 1>>& point, double* to) {
  for (int i = 0; i < Size; ++i) to[i] = point ? (*point)[i] : kNowhere;
}

Numbers projectPoints(const CameraIntrinsics& camera, const py::object& points_in_camera) {
  return forEachPoint(pointsFrom(points_in_camera, 3, "points"), 2, [&](const double* from, double* to) {
    write(project(camera, Eigen::Vector3d(from[0], from[1], from[2])), to);
  });
}

Numbers unprojectPixels(const CameraIntrinsics& camera, const py::object& pixels) {
  return forEachPoint(pointsFrom(pixels, 2, "pixels"), 3, [&](const double* from, double* to) {
    write(unprojectRay(camera, Eigen::Vector2d(from[0], from[1])), to);
  });
}

Numbers idealPixels(const CameraIntrinsics& camera, const py::object& pixels) {
  return forEachPoint(pointsFrom(pixels, 2, "pixels"), 2, [&](const double* from, double* to) {
    write(idealPixel(camera, Eigen::Vector2d(from[0], from[1])), to);
  });
}

WholeNumbers fieldOf(const py::array& events, const char* name) {
  const py::object names = events.dtype().attr("names");
  if (names.is_none() || !names.contains(name))
    throw py::type_error(
        fmt::format("events must be an array of records with the fields t, x, y, p; {} is missing", name));
  const py::array values = events.attr("__getitem__")(name);
  if (values.ndim() != events.ndim())
    throw py::type_error(fmt::format("the field {} of the events must be one number per event", name));
  if (isMasked(values))
    throw py::type_error(fmt::format("the field {} of the events must not have masked values", name));
  const char kind = values.dtype().kind();
  if (kind != 'i' && kind != 'u' && kind != 'b')
    throw py::type_error(fmt::format("the field {} of the events must have an integer type", name));
  constexpr std::uint64_t kLargest = std::numeric_limits<std::int64_t>::max();
  if (kind == 'u' && values.itemsize() == sizeof(kLargest) && values.size() > 0 &&
      values.attr("max")().cast<std::uint64_t>() > kLargest)
    throw badInput("events", fmt::format("the field {} has a number above 2^63", name),
                   "Give times in ns as int64");
  return WholeNumbers(values);
}

py::dtype undistortedType() {
  return recordType({{"t", "<i8", offsetof(UndistortedEvent, time_ns)},
                     {"x", "<f4", offsetof(UndistortedEvent, x_px)},
                     {"y", "<f4", offsetof(UndistortedEvent, y_px)},
                     {"p", "?", offsetof(UndistortedEvent, brighter)}},
                    sizeof(UndistortedEvent));
}

// The table of all pixels pays off if there are more events than pixels.
template <class Visit>
void forEachIdealPixel(const CameraIntrinsics& camera, const WholeNumbers& x, const WholeNumbers& y,
                       const Visit& visit) {
  const Resolution size_px = camera.resolution_px;
  const bool many = x.size() > static_cast<std::int64_t>(size_px.width_px) * size_px.height_px;
  const UndistortionTable table = many ? UndistortionTable(camera) : UndistortionTable();
  for (py::ssize_t i = 0; i < x.size(); ++i) {
    const std::int64_t x_px = x.data()[i], y_px = y.data()[i];
    if (x_px < 0 || y_px < 0 || x_px >= size_px.width_px || y_px >= size_px.height_px)
      throw badInput(fmt::format("event {}", i),
                     fmt::format("({}, {}) is outside the camera's {} x {} pixels", x_px, y_px,
                                 size_px.width_px, size_px.height_px),
                     "Pass events of this camera");
    if (!table.empty()) {
      visit(i, table(static_cast<int>(x_px), static_cast<int>(y_px)));
      continue;
    }
    const auto ideal = idealPixel(camera, Eigen::Vector2d(x_px, y_px));
    visit(i, ideal ? Eigen::Vector2f(ideal->cast<float>()) : Eigen::Vector2f::Constant(kNowhere));
  }
}

py::array undistortEvents(const CameraIntrinsics& camera, const py::array& events) {
  const WholeNumbers t = fieldOf(events, "t"), x = fieldOf(events, "x"), y = fieldOf(events, "y"),
                     p = fieldOf(events, "p");
  if (events.ndim() != 1) throw py::value_error("events must have the shape (N,)");
  py::array undistorted(undistortedType(), std::vector<py::ssize_t>{t.size()});
  auto* out = static_cast<UndistortedEvent*>(undistorted.mutable_data());
  const OthersWork others_work;
  forEachIdealPixel(camera, x, y, [&](py::ssize_t i, const Eigen::Vector2f& ideal) {
    out[i] = {t.data()[i], ideal.x(), ideal.y(), p.data()[i] > 0};
  });
  return undistorted;
}

// A lens of a session may have its resolution from the recording.
py::tuple stateOfLens(const CameraIntrinsics& camera) {
  py::dict map = toMap(camera);
  if (!camera.resolution_px.known()) map.attr("pop")("resolution_px");
  return py::make_tuple(map);
}

CameraIntrinsics lensFromState(const py::tuple& state) {
  return restored(state, 1, "Camera", [](const py::tuple& s) { return readMap(s[0].cast<py::dict>()); });
}

void bindNumbers(py::class_<CameraIntrinsics>& camera) {
  camera.def_property_readonly("model", [](const CameraIntrinsics& c) { return cameraModelName(c.model); })
      .def_property_readonly(
          "resolution_px",
          [](const CameraIntrinsics& c) {
            return py::make_tuple(c.resolution_px.width_px, c.resolution_px.height_px);
          },
          "Tuple (width, height) in px.")
      .def_property_readonly(
          "focal_length_px",
          [](const CameraIntrinsics& c) { return arrayOf(Eigen::VectorXd(c.focal_length_px)); },
          "(2,): fx, fy.")
      .def_property_readonly(
          "principal_point_px",
          [](const CameraIntrinsics& c) { return arrayOf(Eigen::VectorXd(c.principal_point_px)); },
          "(2,): cx, cy; the centre of the top left pixel is (0, 0).")
      .def_property_readonly(
          "distortion",
          [](const CameraIntrinsics& c) {
            return arrayOf(Eigen::VectorXd(
                Eigen::Map<const Eigen::VectorXd>(c.distortion.data(), coefficientCount(c.model))));
          },
          "Values in the order of `coefficients`, which is OpenCV's order for models that OpenCV has.")
      .def_property_readonly(
          "coefficients",
          [](const CameraIntrinsics& c) {
            const auto names = distortionNames(c.model);
            return std::vector<std::string>(names.begin(), names.begin() + coefficientCount(c.model));
          },
          "Names of the distortion coefficients.")
      .def_property_readonly(
          "matrix",
          [](const CameraIntrinsics& c) {
            Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
            matrix.diagonal().head<2>() = idealFocalLength_px(c);
            matrix.col(2).head<2>() = c.principal_point_px;
            return arrayOf(Eigen::MatrixXd(matrix));
          },
          "(3, 3): camera matrix of undistorted pixels, which undistort and undistort_events return.")
      .def("to_dict", toMap, "The intrinsics as a map, with the keys of a session or a result.");
}

}  // namespace

void bindLens(py::module_& module) {
  py::class_<CameraIntrinsics> camera(module, "Camera",
                                      "A lens. Camera frame: x right, y down, z forward. The centre of the "
                                      "top left pixel is (0, 0).");
  camera
      .def(py::init(&fromMap), py::arg("intrinsics"),
           "From a map with the keys of a session: model, resolution_px, focal_length_px, "
           "principal_point_px, distortion. Raises InputError.")
      .def_static(
          "load", lensOf, py::arg("path"), py::arg("name") = "",
          "From a file: such a map, a result, a Kalibr camchain or a ROS camera_info. `name` selects one of "
          "several cameras. Raises InputError, also if the file names its cameras and none has this name.");
  bindNumbers(camera);
  camera
      .def("project", projectPoints, py::arg("points"),
           "Pixels (..., 2) of points (..., 3) [m, or any unit] in the camera frame; NaN for points that the "
           "lens cannot project. Pixels may be outside the image.")
      .def("unproject", unprojectPixels, py::arg("pixels"),
           "Rays through pixels (..., 2), as unit vectors (..., 3) in the camera frame; NaN for pixels "
           "without a ray.")
      .def("undistort", idealPixels, py::arg("pixels"),
           "Undistorted pixels (..., 2), of a pinhole camera with `matrix`; NaN for rays at more than 85 "
           "degrees from the optical axis.")
      .def("undistort_events", undistortEvents, py::arg("events"),
           "Undistorts (N,) records t, x, y, p of integer types. Returns (N,) records t [unchanged], x, y "
           "[undistorted px, float32, see `undistort`], p [bool]. Raises InputError for events outside the "
           "image.")
      .def(py::self == py::self)
      .def("__hash__", [](const CameraIntrinsics& c) { return py::hash(py::repr(stateOfLens(c))); })
      .def(py::pickle(&stateOfLens, &lensFromState))
      .def("__repr__", [](const CameraIntrinsics& c) {
        return fmt::format("<evical.Camera {}, {} x {} px>", cameraModelName(c.model),
                           c.resolution_px.width_px, c.resolution_px.height_px);
      });
}

}  // namespace evical::python
