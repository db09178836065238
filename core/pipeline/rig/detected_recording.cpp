#include "core/pipeline/rig/detected_recording.h"

#include "core/data/calibration_observer.h"
#include "core/initialisation/initialisation_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/report/report_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace evical {
namespace {

// The session with only those settings that affect detection.
Session withoutLaterStages(Session session) {
  session.options.initialisation = InitialisationOptions();
  session.options.optimisation = OptimisationOptions();
  session.options.report = ReportOptions();
  session.exports.clear();
  for (SessionCamera& camera : session.cameras) camera.prior = {};
  for (SessionImu& imu : session.imus) {
    imu.prior = {};
    imu.noise = {};
  }
  return session;
}

// The session with sensors that are named by their place.
Session withoutNames(Session session) {
  std::map<std::string, std::string> places;
  const auto place = [&](auto& sensors, const char* kind) {
    for (std::size_t k = 0; k < sensors.size(); ++k)
      sensors[k].name = places[sensors[k].name] = fmt::format("{}_{}", kind, k);
  };
  place(session.cameras, "camera");
  place(session.imus, "imu");
  const auto refer = [&](std::string& name) {
    if (const auto found = places.find(name); found != places.end()) name = found->second;
  };
  refer(session.reference);
  for (SessionCamera& camera : session.cameras) refer(camera.same_sensor_as);
  return session;
}

// Places of files do not depend on that of the session.
std::string textOf(const Session& session) {
  return sessionYaml(withoutRejectedWindows(withoutNames(session)), "/");
}

}  // namespace

FoundLenses findLenses(const Session& session, const RunContext& context) {
  FoundLenses found{givenLenses(session), {}};
  std::vector<CameraLens>& lenses = found.lenses;
  const auto missing = [](const CameraLens& lens) { return !lens.given; };
  if (std::none_of(lenses.begin(), lenses.end(), missing)) return found;
  SessionRecording{session};  // reports missing streams now, not after minutes
  found.intrinsics.resize(lenses.size());
  for (std::size_t k = 0; k < lenses.size(); ++k) {
    if (lenses[k].given || session.sensorOf(k) != k) continue;
    found.intrinsics[k] = calibrateIntrinsics(session, k, context.unobserved()).result;
    lenses[k].detection_intrinsics = found.intrinsics[k]->intrinsics;
  }
  for (std::size_t k = 0; k < lenses.size(); ++k) lenses[k] = lenses[session.sensorOf(k)];
  return found;
}

DetectedRecording detectRecording(const Session& session, const RunContext& context) {
  FoundLenses found = findLenses(session, context);
  context.progress.stageStarted(nameOf(CalibrationStage::Detect));
  return {readAndDetect(session, std::move(found.lenses), context), std::move(found.intrinsics)};
}

bool sameExceptNames(const Session& one, const Session& other) {
  return textOf(one) == textOf(other);
}

bool detectsTheSame(const Session& one, const Session& other) {
  return sameExceptNames(withoutLaterStages(one), withoutLaterStages(other));
}

DetectedRecording forSession(DetectedRecording detected, const Session& session) {
  for (std::size_t k = 0; k < detected.detections.cameras.size(); ++k)
    detected.detections.cameras[k].camera = session.cameras.at(k).name;
  for (std::size_t k = 0; k < detected.detections.imus.size(); ++k) {
    detected.detections.imus[k].name = session.imus.at(k).name;
    detected.detections.imus[k].noise = session.imus.at(k).noise;
  }
  return detected;
}

}  // namespace evical
