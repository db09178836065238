// result.yaml: what a calibration says, as a file that programs and people read. Keys are a contract.
#pragma once

#include "core/base/option_row.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/geometry/camera_model.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// What a session and its recording say of an IMU, handed on to other programs. Empty, 0: not known.
struct KnownOfImu {
  std::string stream;
  std::optional<ImuNoise> noise;
  double gyroscope_random_walk = 0.0;      // rad/s^2/sqrt(Hz)
  double accelerometer_random_walk = 0.0;  // m/s^3/sqrt(Hz)
  double rate_hz = 0.0;
};

// What a result needs besides the numbers to be read by itself. Lists run parallel to those of the state.
struct ResultNames {
  std::string reference;
  std::vector<std::string> cameras, imus;
  std::vector<std::optional<CameraIntrinsics>> intrinsics;  // as used
  std::string version;
  std::vector<OptionRow> options;           // that differ from their defaults
  std::vector<std::string> camera_streams;  // empty: not known
  std::vector<KnownOfImu> known_of_imus;
  // Where intrinsics were calibrated: sigmas of fx fy cx cy and distortion, as in intrinsics_result.h.
  std::vector<std::optional<std::array<double, 9>>> intrinsics_std = {};
};

struct NamedResult {
  ResultNames names;
  CalibrationResult result;
};

const char* statusName(CalibrationStatus status);

// A failed run without numbers is written too: status, reason, notes and whatever lists are filled.
std::string resultYaml(const NamedResult& named);

// All but trajectory, iterations and residuals. Absent numbers stay at their defaults, so that truth.yaml can
// be read too. Throws CalibrationError (BadInput).
NamedResult readResultYaml(const std::filesystem::path& file);

}  // namespace evical
