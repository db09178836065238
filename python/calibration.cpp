// evical.calibrate and evical.intrinsics.
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/geometry/camera_model.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/report/result_yaml.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/interruptible.h"
#include "python/result.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>
#include <utility>

namespace evical::python {
namespace {

namespace py = pybind11;

// The same steps as on the command line, from the session to the result folder.
std::shared_ptr<const Result> calibrated(const Session& session,
                                         const std::optional<std::filesystem::path>& output, RunLog& log,
                                         const RunContext& context) {
  validateMembers(session);
  std::optional<NewFolder> folder;
  if (output) folder.emplace(*output);
  CalibrationOutcome outcome = runCalibration(session, context);
  if (outcome.status != RunStatus::Done && folder)
    writeUnfinishedRun(*output, folder->wasThere(), session, outcome, EVICAL_VERSION, log.text());
  const auto run = std::make_shared<const CalibrationRun>(std::move(outcome).runOrThrow());
  if (output) {
    const ExportRemarks remarks = writeResultFiles(*output, session, run, EVICAL_VERSION, log.text());
    for (const std::string& refusal : remarks.refused) log.log(LogLevel::Warning, refusal);
  }
  return resultOf(session, *run);
}

// The current folder may change during the calibration.
Session withAbsolutePaths(Session session) {
  forEachRecording(session, [](std::filesystem::path& file) {
    if (!file.empty()) file = std::filesystem::absolute(file);
  });
  return session;
}

std::shared_ptr<Result> calibrate(const Session& given, const std::optional<std::filesystem::path>& output,
                                  const py::object& progress) {
  const Session session = withAbsolutePaths(given);  // a copy, which no other thread can change
  const std::optional<std::filesystem::path> folder =
      output ? std::optional(std::filesystem::absolute(*output)) : std::nullopt;
  std::shared_ptr<const Result> result;
  RunLog log;
  runInterruptibly(progress, log,
                   [&](const RunContext& context) { result = calibrated(session, folder, log, context); });
  return std::const_pointer_cast<Result>(result);
}

std::size_t cameraOf(const Session& session, const std::optional<std::string>& name) {
  std::string known;
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    if (name && session.cameras[k].name == *name) return k;
    known += (known.empty() ? "" : ", ") + session.cameras[k].name;
  }
  if (name) throw badInput(*name, "is not a camera of the session", "Use one of: " + known);
  if (session.cameras.size() != 1)
    throw badInput("camera", fmt::format("the session has {} cameras", session.cameras.size()),
                   "Name one of: " + known);
  return 0;
}

IntrinsicsResult findIntrinsics(const Session& given, const std::optional<std::string>& camera,
                                const py::object& progress) {
  const Session session = withAbsolutePaths(given);
  IntrinsicsResult found;
  RunLog log;
  runInterruptibly(progress, log, [&](const RunContext& context) {
    validateMembers(session);
    found = calibrateIntrinsics(session, cameraOf(session, camera), context).result;
  });
  return found;
}

void bindIntrinsics(py::module_& module) {
  py::class_<IntrinsicsResult>(module, "IntrinsicsResult", "Result of the calibration of one lens alone.")
      .def_property_readonly(
          "status", [](const IntrinsicsResult& r) { return statusName(r.status); }, "ok or doubtful.")
      .def_property_readonly(
          "reason", [](const IntrinsicsResult& r) { return textOf(r.reason); },
          "Why the status is not ok, as text.")
      .def_property_readonly(
          "advice", [](const IntrinsicsResult& r) { return textsOf(r.advice); },
          "Which further views would improve the result.")
      .def_readonly("intrinsics", &IntrinsicsResult::intrinsics, "A Camera.")
      .def_property_readonly(
          "covariance", [](const IntrinsicsResult& r) { return arrayOf(Eigen::MatrixXd(r.covariance)); },
          "(9, 9) of fx, fy, cx, cy [px] and five coefficients; 0 for fixed parameters.")
      .def_property_readonly(
          "std", [](const IntrinsicsResult& r) { return arrayOf(Eigen::VectorXd(r.standardDeviations())); },
          "(9,): sigmas of the same parameters.")
      .def_readonly("reprojection_rms_px", &IntrinsicsResult::reprojection_rms_px)
      .def_readonly("views_used", &IntrinsicsResult::views_used)
      .def(py::pickle(
          [](const IntrinsicsResult& r) {
            CalibrationRun run;
            run.intrinsics = {r};
            return py::make_tuple(py::bytes(runData(run)));
          },
          [](const py::tuple& state) {
            return restored(state, 1, "IntrinsicsResult", [](const py::tuple& s) {
              const ReadRunData read = parseRunData(s[0].cast<py::bytes>());
              if (read.run.intrinsics.size() != 1 || !read.run.intrinsics[0])
                throwBadState("IntrinsicsResult");
              validate(read.run.intrinsics[0]->intrinsics, "intrinsics");
              return *read.run.intrinsics[0];
            });
          }))
      .def("__repr__", [](const IntrinsicsResult& r) {
        return fmt::format("<evical.IntrinsicsResult {}: {:.3f} px RMS>", statusName(r.status),
                           r.reprojection_rms_px);
      });
}

}  // namespace

void bindCalibration(py::module_& module) {
  bindIntrinsics(module);
  module.def("_calibrate", calibrate, py::arg("session"), py::arg("output"), py::arg("progress"));
  module.def("_intrinsics", findIntrinsics, py::arg("session"), py::arg("camera"), py::arg("progress"));
}

}  // namespace evical::python
