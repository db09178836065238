// result.yaml: result of a calibration for programs and people. Keys are a contract.
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

// Description of a sensor from the session and the recording, for other programs. Empty or 0: unknown.
struct SensorDescription {
  std::string name, stream = {};
  // IMU only:
  ImuNoise noise = {0.0, 0.0, 0.0, 0.0};
  double rate_hz = 0.0;
  // Camera only; absent in older files, which have event cameras.
  CameraKind kind = CameraKind::Events;
  // IMU whose accelerometer has a separate stream; `stream` is then the gyroscope's.
  std::string accelerometer_stream = {};

  bool operator==(const SensorDescription&) const = default;
};

// Self-contained result. The numbers are final and shared by all users.
struct [[nodiscard]] NamedResult {
  std::string reference;                         // name of a sensor
  std::vector<SensorDescription> cameras, imus;  // as those of the state
  std::vector<std::string> boards = {"board"};   // the world's, then the further ones
  std::string version;
  std::vector<OptionRow> options;  // that differ from their defaults
  std::shared_ptr<const CalibrationResult> result = std::make_shared<const CalibrationResult>();
};

std::vector<std::string> sensorNames(const std::vector<SensorDescription>& sensors);

// In the order of its cameras.
std::vector<CameraKind> cameraKinds(const NamedResult& named);

const char* statusName(CalibrationStatus status);

// A failed run without numbers is written, too: status, reason, notes and all lists that are not empty.
std::string resultYaml(const NamedResult& named);

// Reads everything except trajectory, iterations and residuals. Absent numbers keep their defaults, so that
// truth.yaml can be read, too. Throws CalibrationError (BadInput).
NamedResult readResultYaml(const std::filesystem::path& file);
NamedResult parseResultYaml(const std::string& text, const std::string& place);

}  // namespace evical
