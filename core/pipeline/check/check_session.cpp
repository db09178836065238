#include "core/pipeline/check/check_session.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/data/quantity.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/pipeline/session/calibration_options.h"
#include "core/pipeline/session/session_keys.h"
#include "core/pipeline/session/session_of_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace evical {
namespace {

NamedResult resultIn(const std::filesystem::path& path) {
  NamedResult before = readOldResult(path, "checked");
  if (before.result->state.cameras.empty())
    throw badInput(resultFileOf(path).string(), "has no cameras", "Give the result of a calibration");
  return before;
}

template <class Sensors>
void checkSensors(const Sensors& sensors, const std::vector<SensorDescription>& known, const char* what,
                  CheckInput& input) {
  const std::vector<std::string> names = sensorNames(known);
  std::set<std::string> seen;
  for (const auto& sensor : sensors) {
    seen.insert(sensor.name);
    if (std::find(names.begin(), names.end(), sensor.name) == names.end())
      throw badInput(
          input.session.source.string(),
          fmt::format("the {} '{}' is not in the old result: the result is of another rig, or the sensor has "
                      "another name in it",
                      what, sensor.name),
          names.empty() ? fmt::format("The old result has no {}s", what) : nameAdvice(sensor.name, names));
  }
  for (const std::string& name : names)
    if (!seen.contains(name))
      input.notes.push_back(
          fmt::format("the {} '{}' of the old result is not in the session and is not checked", what, name));
}

// Removes priors with sigmas: they would pull both results to one value and hide a change. Fixed values stay.
template <class Rows, class Prior>
void dropWeighed(const Rows& rows, Prior& prior) {
  forEachPriorQuantity(rows, [&](const auto& row) {
    auto& known = row.prior(prior);
    if (known && !known->isGiven()) known.reset();
  });
}

// Uses the old lens for detection, so that a change of the lens becomes visible.
void setLens(const CameraState& before, SessionCamera& camera, CheckInput& input) {
  const std::optional<CameraIntrinsics>& lens = before.lens.inUse();
  if (!lens)
    throw badInput("cameras." + camera.name, "the old result has no intrinsics for it",
                   "Calibrate again: the result is from an older version, or incomplete");
  if (camera.resolution_px.known() && camera.resolution_px != lens->resolution_px)
    throw badInput(input.session.source.string() + ": cameras." + camera.name,
                   fmt::format("has images of {}, but {} in the old result", sizeText(camera.resolution_px),
                               sizeText(lens->resolution_px)),
                   "Record with the resolution at which the camera was calibrated");
  if (camera.intrinsics && camera.intrinsics->model != lens->model)
    input.notes.push_back(
        fmt::format("{}: the session's lens model ({}) differs from the old result's ({}), which is used",
                    camera.name, cameraModelTitle(camera.intrinsics->model), cameraModelTitle(lens->model)));
  camera.intrinsics = lens;
  camera.resolution_px = lens->resolution_px;
  camera.intrinsics_uncertainty.reset();
}

Session sessionFor(const CheckPaths& paths) {
  if (isSessionFile(paths.recording)) return readSession(paths.recording);
  if (!pathExists(paths.recording))
    throw badInput(paths.recording.string(), "does not exist", "Give the new recording, or a session of it");
  Session session;
  if (!paths.session.empty()) {
    session = readSessionOfRun(paths.session);
  } else {
    std::optional<Session> kept = sessionOfOldResult(paths.result);
    if (!kept)
      throw badInput(paths.result.string(),
                     "has no run_session.yaml next to it, which describes board and sensors",
                     "Give the session of the new recording by " + howTo(HowTo::Option, {"session"}));
    session = std::move(*kept);
  }
  setRecording(paths.recording, session);
  return session;
}

std::optional<Session> storedSession(const std::filesystem::path& result) {
  try {
    return sessionOfOldResult(result);
  } catch (const CalibrationError&) {
    return std::nullopt;  // it is optional
  }
}

// Adds priors for quantities with a sigma in the old result; the session has the given ones.
template <class Rows, class State, class Uncertainty, class Prior>
void weigh(const Rows& rows, const State& was, const Uncertainty& uncertainty, bool reference,
           const CheckOptions& options, Prior& prior) {
  constexpr double kMin = 1e-12;  // a sigma of 0 would fix the value
  forEachPriorQuantity(rows, [&](const auto& row) {
    const std::optional<double> stability = stabilityOf(row.info, options);
    const Eigen::VectorXd sigmas = quantityNumbers(row.sigma(uncertainty));
    auto& known = row.prior(prior);
    if (!stability || (reference && row.info.relative) || isGiven(known) || !(sigmas.array() > 0.0).any())
      return;
    known = {row.value(was)};
    Eigen::VectorXd both = (sigmas.array().square() + *stability * *stability).sqrt().max(kMin);
    if (both.size() == 1) both[0] = std::hypot(sigmas[0], *stability);
    setQuantityNumbers(both, known->sigma.emplace());
  });
}

// True for a camera that has its priors from another one of the same sensor, even if its lens was estimated
// separately.
bool isSecondOfSensor(const SessionCamera& camera) {
  return !camera.same_sensor_as.empty();
}
bool isSecondOfSensor(const SessionImu&) {
  return false;
}

// Adds the lens as prior with its full covariance: errors of focal length and distortion are correlated.
void weighLens(const UncertaintyReport& before, std::size_t camera, double stability_px,
               SessionCamera& session_camera) {
  Eigen::MatrixXd covariance = intrinsicsCovariance(before, camera);
  const Eigen::Index count = covariance.rows();
  if (count == 0) return;
  covariance += lensCovariance(*session_camera.intrinsics, count, stability_px);
  const Eigen::VectorXd std = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  LensUncertainty& uncertainty = session_camera.intrinsics_uncertainty.emplace();
  uncertainty.std.head(count) = std;
  IntrinsicsMatrix& correlation = uncertainty.correlation.emplace(IntrinsicsMatrix::Identity());
  correlation.topLeftCorner(count, count) =
      std.cwiseInverse().asDiagonal() * covariance * std.cwiseInverse().asDiagonal();
}

}  // namespace

CheckInput checkInputOf(NamedResult before, Session session) {
  CheckInput input{std::move(before), std::move(session), true, false, {}, {}};
  if (input.session.reference != input.before.reference)
    throw badInput(
        input.session.source.string() + ": reference",
        fmt::format("is '{}', but '{}' in the old result", input.session.reference, input.before.reference),
        "Use the old result's reference: poses are relative to it");
  checkSensors(input.session.cameras, input.before.cameras, "camera", input);
  checkSensors(input.session.imus, input.before.imus, "IMU", input);
  const std::vector<std::string> names = sensorNames(input.before.cameras);
  forEachSensorKind([&](auto kind) {
    for (auto& sensor : kind.of(input.session)) dropWeighed(kind.rows(), sensor.prior);
  });
  for (SessionCamera& camera : input.session.cameras) {
    if (!camera.same_sensor_as.empty()) continue;  // has the other camera's lens
    const auto k = std::find(names.begin(), names.end(), camera.name) - names.begin();
    setLens(input.before.result->state.cameras.at(static_cast<std::size_t>(k)), camera, input);
  }
  if (input.before.result->status == CalibrationStatus::Doubtful)
    input.notes.push_back("the old calibration was doubtful: " + input.before.result->reason);
  return input;
}

namespace {

CheckInput checkInputIn(const std::filesystem::path& result, NamedResult before, Session session) {
  CheckInput input = checkInputOf(std::move(before), std::move(session));
  const std::optional<Session> stored = storedSession(result);
  input.same_board = stored && stored->board == input.session.board;
  input.duplicate = stored && sharedRecording(*stored, input.session);
  input.before_name = result.string();
  return input;
}

}  // namespace

CheckInput readCheckInput(const CheckPaths& paths) {
  NamedResult before = resultIn(paths.result);
  return checkInputIn(paths.result, std::move(before), sessionFor(paths));
}

CheckInput readCheckInput(const std::filesystem::path& result, Session session) {
  return checkInputIn(result, resultIn(result), std::move(session));
}

Session withPriorOf(const NamedResult& before, Session session) {
  const CheckOptions& options = *session.options.check;
  const CalibrationState& state = before.result->state;
  const UncertaintyReport& sigmas = before.result->uncertainty;
  for (std::size_t k = 0; k < before.cameras.size(); ++k)
    for (SessionCamera& camera : session.cameras)
      if (camera.name == before.cameras[k].name && !isSecondOfSensor(camera))
        weighLens(sigmas, k, options.stability_lens_px, camera);
  forEachSensorKind([&](auto kind) {
    for (std::size_t k = 0; k < kind.of(before).size(); ++k)
      for (auto& sensor : kind.of(session)) {
        if (sensor.name != kind.of(before)[k].name || isSecondOfSensor(sensor)) continue;
        weigh(kind.rows(), kind.of(state)[k], kind.of(sigmas)[k], sensor.name == session.reference, options,
              sensor.prior);
      }
  });
  return session;
}

}  // namespace evical
