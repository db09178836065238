// report.html: one self-contained page that says how good a calibration is, why, and what to do better; and
// the numbers behind its plots as CSV. Also of a failed calibration: the reason, and what there is.
#pragma once

#include "core/data/calibration_check.h"
#include "core/data/calibration_setup.h"
#include "core/data/intrinsics_result.h"
#include "core/data/maintenance.h"
#include "core/data/recording.h"
#include "core/data/repeatability.h"
#include "core/report/result_yaml.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evical {

struct ReportNeeds {
  double rotation_deg = 0.1, translation_mm = 1.0, time_offset_ms = 0.1;
};

// Lists may be empty or shorter than those of the result where a calibration failed early.
struct ReportData {
  const NamedResult& named;
  std::string recording;               // as people know it: the file's name
  std::vector<SeenBoard> boards = {};  // by camera
  std::int64_t start_ns = 0;
  std::span<const BoardObservations> cameras = {};
  std::span<const CameraLens> lenses = {};  // what they were seen with
  std::span<const ImuData> imus = {};
  std::span<const Resolution> resolutions_px = {};
  std::span<const RecordingFault> faults = {};
  ReportNeeds needs = {};
  // By camera: as calibrated first; empty where all were given.
  std::span<const std::optional<IntrinsicsResult>> intrinsics = {};
  const CalibrationCheck* check =
      nullptr;  // of an older result by this recording, where it was made for that
};

struct ReportFile {
  std::string name;  // "report.html", "plots/imu1_gyroscope.csv"
  std::string content;
};

std::vector<ReportFile> reportFiles(const ReportData& data);
std::vector<ReportFile> reportFiles(const Maintenance& maintenance);
std::vector<ReportFile> reportFiles(const Repeatability& repeat);

}  // namespace evical
