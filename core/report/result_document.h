// What result.yaml holds, without the splines: everything that tables, comparisons and exports need.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/geometry/camera_model.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace evical {

struct DocumentedCamera {
  std::string name;
  CameraState state;  // imu = the reference
  CameraUncertainty uncertainty;
  std::optional<CameraIntrinsics> intrinsics;  // as used
  CameraFit fit;
};

struct DocumentedImu {
  std::string name;
  ImuState state;
  ImuUncertainty uncertainty;
  ImuFit fit;
};

struct ProgramInfo {
  std::string version;
  std::vector<std::pair<std::string, std::string>>
      options;  // full name and value, those not at their default
};

struct ResultDocument {
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;  // why not ok, in plain words
  std::string reference;
  std::vector<DocumentedCamera> cameras;  // none where the calibration failed
  std::vector<DocumentedImu> imus;
  Eigen::Vector3d gravity_in_world_m_s2 = Eigen::Vector3d::Zero();
  UncertaintyReport uncertainty;  // its lists of cameras and IMUs stay empty: they are above
  std::vector<std::string> notes;
  Timing timing;
  double memory_peak_mb = 0.0;
  ProgramInfo program;
};

ResultDocument documentOf(const CalibrationInput& input, const CalibrationResult& result,
                          ProgramInfo program);

// For a run that gave no result.
ResultDocument failedDocument(std::string reason, ProgramInfo program);

const char* statusName(CalibrationStatus status);

}  // namespace evical
