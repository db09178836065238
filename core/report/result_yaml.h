// result.yaml: what a calibration says, as a file that programs and people read. Keys are a contract.
#pragma once

#include "core/base/option_row.h"
#include "core/data/board_observations.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical {

// What a session and its recording say of a sensor, handed on to other programs. Empty, 0: not known.
struct SensorDescription {
  std::string name, stream = {};
  // Of an IMU:
  ImuNoise noise = {0.0, 0.0, 0.0, 0.0};
  double rate_hz = 0.0;
  // Of a camera; older files do not say it, and are of events.
  CameraKind kind = CameraKind::Events;
  // Of an IMU whose accelerometer has a stream of its own; `stream` is then the gyroscope's.
  std::string accelerometer_stream = {};

  bool operator==(const SensorDescription&) const = default;
};

// A result that can be read by itself. Nobody changes the numbers any more, so that all who show or write
// them share them.
struct NamedResult {
  std::string reference;                         // a sensor's name
  std::vector<SensorDescription> cameras, imus;  // as those of the state
  std::vector<std::string> boards = {"board"};   // the world's, then the further ones
  std::string version;
  std::vector<OptionRow> options;  // that differ from their defaults
  std::shared_ptr<const CalibrationResult> result = std::make_shared<const CalibrationResult>();
};

std::vector<std::string> sensorNames(const std::vector<SensorDescription>& sensors);

// As its cameras are listed.
std::vector<CameraKind> cameraKinds(const NamedResult& named);

const char* statusName(CalibrationStatus status);

// A failed run without numbers is written too: status, reason, notes and whatever lists are filled.
std::string resultYaml(const NamedResult& named);

// All but trajectory, iterations and residuals. Absent numbers stay at their defaults, so that truth.yaml can
// be read too. Throws CalibrationError (BadInput).
NamedResult readResultYaml(const std::filesystem::path& file);
NamedResult parseResultYaml(const std::string& text, const std::string& place);

}  // namespace evical
