// evical.Result and its sensors.
#include "core/data/calibration_observer.h"
#include "core/numerics/angles.h"
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/report/shown_quantity.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/interpreter.h"
#include "python/result.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>
#include <utility>

namespace evical::python {
namespace {

namespace py = pybind11;

// A sensor of a result. It keeps the result alive.
struct CameraOfResult {
  std::shared_ptr<const Result> result;
  std::size_t index;

  const CameraState& state() const { return result->numbers().state.cameras.at(index); }
  const CameraUncertainty& sigma() const { return result->numbers().uncertainty.cameras.at(index); }
  const CameraFit& fit() const { return result->numbers().cameras.at(index); }
  const SensorDescription& known() const { return result->named.cameras.at(index); }
  static std::size_t count(const Result& of) { return of.named.cameras.size(); }
};
struct ImuOfResult {
  std::shared_ptr<const Result> result;
  std::size_t index;

  const ImuState& state() const { return result->numbers().state.imus.at(index); }
  const ImuUncertainty& sigma() const { return result->numbers().uncertainty.imus.at(index); }
  const ImuFit& fit() const { return result->numbers().imus.at(index); }
  const SensorDescription& known() const { return result->named.imus.at(index); }
  static std::size_t count(const Result& of) { return of.named.imus.size(); }
};

py::array_t<double> sigmas(const Result& result, Eigen::Vector3d numbers) {
  for (double& number : numbers) number = result.known(number);
  return arrayOf(numbers);
}

py::array_t<double> poseMatrix(const RigidTransform& pose) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(4, 4);
  matrix.topLeftCorner<3, 3>() = pose.rotation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.translation_m;
  return arrayOf(matrix);
}

Eigen::Vector3d inDegrees(const Eigen::Vector3d& angles_rad) {
  return kDegPerRad * angles_rad;
}

py::object windowsOf(const CameraFit& fit) {
  py::dict windows;
  windows["total"] = fit.windows_total;
  windows["complete"] = fit.windows_complete;
  windows["partial"] = fit.windows_partial;
  windows["used"] = fit.windows_used;
  return readOnly(windows);
}

// Properties that cameras and IMUs share.
template <class Sensor>
void bindSensor(py::class_<Sensor>& sensor) {
  sensor.def_property_readonly("name", [](const Sensor& s) { return identifierOf(s.known().name); })
      .def_property_readonly("stream", [](const Sensor& s) { return identifierOf(s.known().stream); })
      .def_property_readonly(
          "rotation_std_deg",
          [](const Sensor& s) { return sigmas(*s.result, inDegrees(s.sigma().rotation_std_rad)); },
          "(3,), deg, about the axes of the reference. Sigmas are 0 for what was not estimated, and NaN if "
          "the "
          "file has none.")
      .def_property_readonly(
          "translation_std_m", [](const Sensor& s) { return sigmas(*s.result, s.sigma().translation_std_m); },
          "(3,), m, in the frame of the reference.")
      .def_property_readonly(
          "time_offset_s", [](const Sensor& s) { return s.state().time_offset_s; },
          "Time on the reference's clock = time on the sensor's clock + time_offset_s.")
      .def_property_readonly("time_offset_std_s",
                             [](const Sensor& s) { return s.result->known(s.sigma().time_offset_std_s); })
      .def_property_readonly(
          "clock_drift_ppm", [](const Sensor& s) { return s.state().time_offset_drift_ppm; },
          "Growth of the offset, us per s; time_offset_s is valid at clock_drift_at_s.")
      .def_property_readonly(
          "clock_drift_std_ppm",
          [](const Sensor& s) { return s.result->known(s.sigma().time_offset_drift_std_ppm); })
      .def_property_readonly("clock_drift_at_s", [](const Sensor& s) { return s.state().time_offset_at_s; })
      .def(py::pickle(
          [](const Sensor& s) { return py::make_tuple(std::const_pointer_cast<Result>(s.result), s.index); },
          [](const py::tuple& state) {
            return restored(state, 2, "Result", [](const py::tuple& s) {
              const auto result = s[0].cast<std::shared_ptr<Result>>();
              const auto index = s[1].cast<std::size_t>();
              if (!result || index >= Sensor::count(*result)) throwBadState("Result");
              return Sensor{result, index};
            });
          }));
}

void bindCamera(py::module_& module) {
  py::class_<CameraOfResult> camera(module, "CameraResult", "A camera of a result.");
  bindSensor(camera);
  camera
      .def_property_readonly(
          "reference_from_camera",
          [](const CameraOfResult& c) { return poseMatrix(c.state().reference_from_camera); },
          "(4, 4) [m]: p_reference = reference_from_camera @ p_camera, in homogeneous coordinates.")
      .def_property_readonly(
          "intrinsics", [](const CameraOfResult& c) { return c.state().lens.inUse(); },
          "A Camera: the estimated lens, else the given one; None if the file has none.")
      .def_property_readonly(
          "intrinsics_std",
          [](const CameraOfResult& c) -> py::object {
            const auto& sigmas = c.sigma().intrinsics_std;
            if (!sigmas) return py::none();
            return arrayOf(Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(sigmas->data(), 9)));
          },
          "(9,): sigmas of fx, fy, cx, cy [px] and up to five coefficients; None if the lens was given.")
      .def_property_readonly(
          "line_delay_us", [](const CameraOfResult& c) { return c.state().line_delay_us; },
          "Rolling shutter of a frame camera: time between the exposures of consecutive rows.")
      .def_property_readonly(
          "reprojection_rms_px",
          [](const CameraOfResult& c) { return c.result->known(c.fit().reprojection_rms_px); })
      .def_property_readonly(
          "windows", [](const CameraOfResult& c) { return windowsOf(c.fit()); },
          "Numbers of event windows: total, complete, partial, used.")
      .def("__repr__", [](const CameraOfResult& c) {
        return textOf(fmt::format("<evical.CameraResult '{}'>", c.known().name));
      });
}

void bindImu(py::module_& module) {
  py::class_<ImuOfResult> imu(module, "ImuResult", "An IMU of a result. measured = mapping @ true + bias.");
  bindSensor(imu);
  imu.def_property_readonly(
         "accelerometer_stream",
         [](const ImuOfResult& i) { return identifierOf(i.known().accelerometer_stream); },
         "Stream of the accelerometer, if it is separate; `stream` is then the gyroscope's.")
      .def_property_readonly(
          "reference_from_imu", [](const ImuOfResult& i) { return poseMatrix(i.state().reference_from_imu); },
          "(4, 4) [m]: p_reference = reference_from_imu @ p_imu; the identity for the reference.")
      .def_property_readonly(
          "gyroscope_bias_rad_s",
          [](const ImuOfResult& i) { return arrayOf(i.state().gyroscope_bias_rad_s); },
          "(3,); where it drifts, its mean.")
      .def_property_readonly(
          "gyroscope_bias_std_rad_s",
          [](const ImuOfResult& i) { return sigmas(*i.result, i.sigma().gyroscope_bias_std_rad_s); })
      .def_property_readonly(
          "gyroscope_scale_misalignment",
          [](const ImuOfResult& i) { return arrayOf(Eigen::MatrixXd(i.state().gyroscopeMatrix())); },
          "(3, 3): from true rates in the IMU's frame to measured ones.")
      .def_property_readonly(
          "gyroscope_rms_rad_s",
          [](const ImuOfResult& i) { return i.result->known(i.fit().gyroscope_rms_rad_s); })
      .def_property_readonly(
          "accelerometer_bias_m_s2",
          [](const ImuOfResult& i) { return arrayOf(i.state().accelerometer_bias_m_s2); },
          "(3,); where it drifts, its mean.")
      .def_property_readonly(
          "accelerometer_bias_std_m_s2",
          [](const ImuOfResult& i) { return sigmas(*i.result, i.sigma().accelerometer_bias_std_m_s2); })
      .def_property_readonly(
          "accelerometer_scale_misalignment",
          [](const ImuOfResult& i) {
            return arrayOf(Eigen::MatrixXd(i.state().accelerometer_scale_misalignment));
          },
          "(3, 3), upper triangular.")
      .def_property_readonly(
          "accelerometer_delay_s", [](const ImuOfResult& i) { return i.state().accelerometer_delay_s; },
          "Delay relative to the gyroscope, whose clock is the IMU's.")
      .def_property_readonly(
          "accelerometer_rms_m_s2",
          [](const ImuOfResult& i) { return i.result->known(i.fit().accelerometer_rms_m_s2); })
      .def("__repr__", [](const ImuOfResult& i) {
        return textOf(fmt::format("<evical.ImuResult '{}'>", i.known().name));
      });
}

template <class Sensor>
py::object byName(const std::shared_ptr<const Result>& result, const std::vector<SensorDescription>& known) {
  py::dict sensors;
  for (std::size_t i = 0; i < known.size(); ++i) sensors[identifierOf(known[i].name)] = Sensor{result, i};
  return readOnly(sensors);
}

py::object covarianceOf(const Result& result) {
  return py::module_::import("evical.covariance")
      .attr("Covariance")(columnNames(result.named), arrayOf(result.numbers().uncertainty.covariance()));
}

py::object timingOf(const Result& result) {
  py::dict timing;
  forEachTiming(result.numbers().timing, [&](const char* key, double seconds) { timing[key] = seconds; });
  return readOnly(timing);
}

using Shared = std::shared_ptr<Result>;

void warnIfForeign(const std::filesystem::path& path) {
  const std::filesystem::path file = resultFileOf(path);
  const std::optional<std::string> why =
      file.filename() == kResultFile ? whyRunDataIsForeign(file) : std::nullopt;
  if (!why) return;
  const py::object logger = py::module_::import("logging").attr("getLogger")("evical");
  called(logger.attr("warning"), py::make_tuple("%s: %s", textOf(file.string()), textOf(*why)));
}

void bindVerdict(py::class_<Result, Shared>& result) {
  result.def_property_readonly("status", &Result::status, "ok, doubtful or failed; truth: of a simulation.")
      .def_property_readonly(
          "reason", [](const Result& r) { return textOf(r.numbers().reason); },
          "Why the status is not ok, as text.")
      .def_property_readonly(
          "repair",
          [](const Result& r) -> py::object {
            const auto& repair = r.numbers().repair;
            if (!repair) return py::none();
            return py::make_tuple(textOf(repair->key), textOf(repair->value));
          },
          "(key, value) for Session.set if that would fix the cause; else None.")
      .def_property_readonly(
          "weakest", [](const Result& r) { return textOf(r.numbers().uncertainty.weakest); },
          "The direction that this recording determines least, as text.")
      .def_property_readonly("notes", [](const Result& r) { return textsOf(r.numbers().notes); })
      .def_property_readonly(
          "version", [](const Result& r) { return textOf(r.named.version); },
          "Version of Evical that wrote it.")
      .def_property_readonly(
          "missing", [](const Result& r) { return textsOf(r.missing); },
          "List of str: each missing part of an older or damaged folder, with the reason; empty if complete.")
      .def_property_readonly("timing_s", timingOf);
}

}  // namespace

void bindResult(py::module_& module) {
  bindCamera(module);
  bindImu(module);
  py::class_<Result, Shared> result(module, "Result", "Result of a calibration. All of it is read-only.");
  result.def_static(
      "load",
      [](const std::filesystem::path& path) {
        std::shared_ptr<Result> loaded;
        {
          const OthersWork others_work;
          loaded = std::const_pointer_cast<Result>(loadResult(path));
        }
        warnIfForeign(path);
        return loaded;
      },
      py::arg("path"),
      "From the folder that a calibration wrote, or its result.yaml; also from truth.yaml of a simulation. "
      "`missing` lists what an older folder lacks. result.yaml is the truth: if it was changed, run.data "
      "with "
      "the trajectory is not used, and the logger \"evical\" warns. Raises InputError.");
  bindVerdict(result);
  result
      .def_property_readonly(
          "reference", [](const Result& r) { return identifierOf(r.named.reference); },
          "Name of the reference sensor.")
      .def_property_readonly(
          "cameras", [](const Shared& r) { return byName<CameraOfResult>(r, r->named.cameras); },
          "CameraResult by name.")
      .def_property_readonly(
          "imus", [](const Shared& r) { return byName<ImuOfResult>(r, r->named.imus); }, "ImuResult by name.")
      .def_property_readonly(
          "gravity_m_s2", [](const Result& r) { return arrayOf(r.numbers().state.gravity_in_world_m_s2); },
          "(3,), in the board's frame; points down.")
      .def_property_readonly(
          "start_ns", [](const Result& r) { return r.numbers().start_ns; },
          "Origin of times in seconds, on the recording's clock; None if unknown.")
      .def_property_readonly("covariance", covarianceOf, "A Covariance of all estimated quantities.")
      .def_property_readonly(
          "trajectory", [](const Shared& r) { return trajectoryOf(r); },
          "A Trajectory. Raises InputError if the folder has none.")
      .def(py::pickle(
          [](const Result& r) {
            const ResultState state = stateOf(r);
            return py::make_tuple(identifierOf(state.yaml), py::bytes(state.data), textsOf(state.missing));
          },
          [](const py::tuple& state) {
            return restored(state, 3, "Result", [](const py::tuple& s) {
              return resultFrom({bytesOf(s[0].cast<py::str>()), s[1].cast<py::bytes>(),
                                 s[2].cast<std::vector<std::string>>()});
            });
          }))
      .def(
          "to_yaml", [](const Result& r) { return textOf(r.yaml()); }, "The content of result.yaml.")
      .def("__repr__", [](const Result& r) {
        return fmt::format("<evical.Result {}: {} cameras, {} IMUs>", r.status(), r.named.cameras.size(),
                           r.named.imus.size());
      });
}

}  // namespace evical::python
