// evical.Trajectory: poses of the reference and of the cameras over time.
#include "core/geometry/trajectory.h"

#include "core/base/error.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/interpreter.h"
#include "python/result.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace evical::python {
namespace {

namespace py = pybind11;

const CalibrationState& stateOf(const Trajectory& trajectory) {
  return trajectory.result->numbers().state;
}

// Farther from the trajectory than this are ns or times since 1970, instead of seconds of its recording.
constexpr double kFarthest_s = 86'400.0;

double beginOf(const CalibrationState& state) {
  return std::max(state.world_from_imu_rotation.start_s, state.imu_in_world_m.start_s);
}

double endOf(const CalibrationState& state) {
  return std::min(state.world_from_imu_rotation.endTime_s(), state.imu_in_world_m.endTime_s());
}

Numbers timesFrom(const py::object& given, const CalibrationState& state) {
  const Numbers times_s = numbersFrom(given, "times_s must be numbers: seconds since Result.start_ns");
  const double begin_s = beginOf(state), end_s = endOf(state);
  bool some_inside = times_s.size() == 0, some_finite = false;
  for (py::ssize_t i = 0; i < times_s.size(); ++i) {
    const double time_s = times_s.data()[i];
    if (time_s < begin_s - kFarthest_s || time_s > end_s + kFarthest_s)
      throw badInput("times_s",
                     fmt::format("{:g} s is not a time of this recording, whose trajectory is from {:.3f} to "
                                 "{:.3f} s since its start",
                                 time_s, begin_s, end_s),
                     "Give seconds since the recording's start; for ns of its clock 1e-9 * (t - "
                     "Result.start_ns)");
    some_inside = some_inside || (time_s >= begin_s && time_s <= end_s);
    some_finite = some_finite || std::isfinite(time_s);
  }
  if (some_finite && !some_inside)
    py::module_::import("logging").attr("getLogger")("evical").attr("warning")(
        fmt::format("times_s: all poses are NaN, since no time is within the trajectory, {:.3f} to {:.3f} s "
                    "since the recording's start",
                    begin_s, end_s));
  return times_s;
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
Numbers posesAt(const py::object& times_s, const CalibrationState& state, const PoseAt& pose_at) {
  const Numbers times = timesFrom(times_s, state);
  Numbers poses(shapeLike(times, 0, {4, 4}));
  const double* from = times.data();
  double* to = poses.mutable_data();
  const py::ssize_t count = times.size();
  const OthersWork others_work;
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
  return posesAt(times_s, state, [&](double time_s) { return poseAt(state, time_s); });
}

Numbers cameraAt(const Trajectory& trajectory, const std::string& name, const py::object& times_s) {
  const CalibrationState& state = stateOf(trajectory);
  const CameraState& camera = state.cameras.at(cameraNamed(*trajectory.result, name));
  return posesAt(times_s, state, [&](double time_s) {
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
          "begin_s", [](const Trajectory& t) { return beginOf(stateOf(t)); },
          "First time, on the reference's clock.")
      .def_property_readonly("end_s", [](const Trajectory& t) { return endOf(stateOf(t)); })
      .def("at", at, py::arg("times_s"),
           "world_from_reference, (..., 4, 4) [m], at times (...) on the reference's clock; NaN before "
           "begin_s and after end_s. Raises InputError for times more than a day outside.")
      .def("camera_at", cameraAt, py::arg("name"), py::arg("times_s"),
           "world_from_camera, (..., 4, 4) [m], at times (...) on that camera's clock; its time offset is "
           "applied.")
      .def(py::pickle(
          [](const Trajectory& t) { return py::make_tuple(std::const_pointer_cast<Result>(t.result)); },
          [](const py::tuple& state) {
            return restored(state, 1, "Trajectory", [](const py::tuple& s) {
              const auto result = s[0].cast<std::shared_ptr<Result>>();
              if (!result) throwBadState("Trajectory");
              return trajectoryOf(result);
            });
          }))
      .def("__repr__", [](const Trajectory& t) {
        return fmt::format("<evical.Trajectory of {:.1f} s>", stateOf(t).world_from_imu_rotation.endTime_s() -
                                                                  stateOf(t).world_from_imu_rotation.start_s);
      });
}

}  // namespace evical::python
