// evical.Trajectory: poses of the reference and of the cameras over time.
#include "core/geometry/trajectory.h"

#include "core/base/error.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/result.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace evical::python {
namespace {

namespace py = pybind11;

const CalibrationState& stateOf(const Trajectory& trajectory) {
  return trajectory.result->numbers().state;
}

// NumPy would convert None to NaN.
Numbers timesFrom(const py::object& times) {
  try {
    if (!times.is_none()) return Numbers(times);
  } catch (py::error_already_set&) {
    // Reported below.
  }
  throw py::type_error("times must be a number or an array of numbers, in seconds");
}

std::optional<RigidTransform> poseAt(const CalibrationState& state, double time_s) {
  if (!state.world_from_imu_rotation.contains(time_s) || !state.imu_in_world_m.contains(time_s))
    return std::nullopt;
  return worldFromImu(state.world_from_imu_rotation, state.imu_in_world_m, time_s);
}

// 4 x 4, row-major; NaN if there is no pose.
void writeTrajectory(const std::optional<RigidTransform>& pose, double* to) {
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(to);
  if (!pose) {
    matrix.setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  matrix.setIdentity();
  matrix.topLeftCorner<3, 3>() = pose->rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose->translation_m;
}

template <class PoseAt>
Numbers posesAt(const py::object& times_s, const PoseAt& pose_at) {
  const Numbers times = timesFrom(times_s);
  Numbers poses(shapeLike(times, 0, {4, 4}));
  const double* from = times.data();
  double* to = poses.mutable_data();
  const py::ssize_t count = times.size();
  const py::gil_scoped_release others_work;
  for (py::ssize_t i = 0; i < count; ++i) writeTrajectory(pose_at(from[i]), to + 16 * i);
  return poses;
}

std::size_t cameraNamed(const Result& result, const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < result.named.cameras.size(); ++i) {
    if (result.named.cameras[i].name == name) return i;
    known += (known.empty() ? "" : ", ") + result.named.cameras[i].name;
  }
  throw badInput(name, "is not a camera of the result", "Use one of: " + known);
}

Numbers at(const Trajectory& trajectory, const py::object& times_s) {
  const CalibrationState& state = stateOf(trajectory);
  return posesAt(times_s, [&](double time_s) { return poseAt(state, time_s); });
}

Numbers cameraAt(const Trajectory& trajectory, const std::string& name, const py::object& times_s) {
  const CalibrationState& state = stateOf(trajectory);
  const CameraState& camera = state.cameras.at(cameraNamed(*trajectory.result, name));
  return posesAt(times_s, [&](double time_s) {
    std::optional<RigidTransform> pose = poseAt(state, referenceTime_s(camera, time_s));
    if (pose) pose = *pose * camera.reference_from_camera;
    return pose;
  });
}

}  // namespace

void bindTrajectory(py::module_& module) {
  py::class_<Trajectory>(
      module, "Trajectory",
      "Motion of the rig. World = the board's frame: x along a row, y down the columns, z into the board. "
      "Times are seconds since the recording's start (Result.start_ns).")
      .def_property_readonly(
          "begin_s",
          [](const Trajectory& t) {
            return std::max(stateOf(t).world_from_imu_rotation.start_s, stateOf(t).imu_in_world_m.start_s);
          },
          "First time, on the reference's clock.")
      .def_property_readonly("end_s",
                             [](const Trajectory& t) {
                               return std::min(stateOf(t).world_from_imu_rotation.endTime_s(),
                                               stateOf(t).imu_in_world_m.endTime_s());
                             })
      .def("at", at, py::arg("times_s"),
           "world_from_reference, (..., 4, 4) [m], at times (...) on the reference's clock; NaN before "
           "begin_s and after end_s.")
      .def("camera_at", cameraAt, py::arg("name"), py::arg("times_s"),
           "world_from_camera, (..., 4, 4) [m], at times (...) on that camera's clock; its time offset is "
           "applied.")
      .def(py::pickle(
          [](const Trajectory& t) { return py::make_tuple(std::const_pointer_cast<Result>(t.result)); },
          [](const py::tuple& state) { return trajectoryOf(state[0].cast<std::shared_ptr<Result>>()); }))
      .def("__repr__", [](const Trajectory& t) {
        return fmt::format("<evical.Trajectory of {:.1f} s>", stateOf(t).world_from_imu_rotation.endTime_s() -
                                                                  stateOf(t).world_from_imu_rotation.start_s);
      });
}

}  // namespace evical::python
