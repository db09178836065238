// report.html: one self-contained page with the quality of a calibration, its reasons and advice; and its
// plots' data as CSV. A failed calibration has a report, too: the reason, and the available data.
#pragma once

#include "core/data/assessment.h"
#include "core/data/calibration_setup.h"
#include "core/data/intrinsics_result.h"
#include "core/data/recording.h"
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

// Lists may be empty or shorter than those of the result if a calibration failed early.
struct ReportData {
  const NamedResult& named;
  std::string recording;               // the file's name
  std::vector<SeenBoard> boards = {};  // by camera
  std::int64_t start_ns = 0;
  std::span<const BoardObservations> cameras = {};
  std::span<const CameraLens> lenses = {};  // used for the detection
  std::span<const ImuData> imus = {};
  std::span<const Resolution> resolutions_px = {};
  std::span<const RecordingFault> faults = {};
  ReportNeeds needs = {};
  // By camera, if calibrated first; empty if all were given.
  std::span<const std::optional<IntrinsicsResult>> intrinsics = {};
  const CalibrationCheck* check = nullptr;  // check of an older result, if requested
};

struct ReportFile {
  std::string name;  // "report.html", "plots/imu1_gyroscope.csv"
  std::string content;
};

std::vector<ReportFile> reportFiles(const ReportData& data);
std::vector<ReportFile> reportFiles(const Maintenance& maintenance);
std::vector<ReportFile> reportFiles(const Repeatability& repeat);

}  // namespace evical
