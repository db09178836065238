// A result in other programs' formats, by name of the program. Each exporter writes a separate folder, whose
// files state the direction of each transform and the sign of the time offset. Data that a format does not
// support are refitted with a stated error, named in a note, or refused, never dropped. Directions and keys
// follow the programs' sources.
#pragma once

#include "core/base/atomic_file.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

struct [[nodiscard]] ExportedFiles {
  std::vector<FileContent> files;         // paths relative to the output folder: "kalibr/imu.yaml"
  std::vector<std::string> notes;         // remarks for users
  std::vector<std::string> refused = {};  // targets without files, each with the reason
  std::vector<std::string> targets = {};  // targets with files
};

struct ReadBack;

struct ExportTarget {
  const char* name;
  const char* program;                                // "Kalibr"; several if they share a file
  const char* files;                                  // one-line description of the files
  const char* use;                                    // one-line description of the users
  bool inertial_odometry;                             // for programs that estimate motion from camera and IMU
  ExportedFiles (*write)(const NamedResult& result);  // paths relative to the target's folder
  // Reads the written files like the program (read_back.h).
  ReadBack (*read)(const std::filesystem::path& folder);
};

std::span<const ExportTarget> exportTargets();

// Throws CalibrationError (BadInput) for an unknown name, with the closest one; `place` precedes it.
const ExportTarget& exportTarget(std::string_view name, std::string_view place);

// Files of several targets, each below its name; a target that does not support the result does not affect
// the others. Throws CalibrationError (BadInput) for the result of a failed calibration, for unknown names,
// and if no target supports it.
ExportedFiles exportResult(const NamedResult& result, std::span<const std::string> targets);

// For a valid request and result: if no target supports the result, this is only reported in `refused`.
ExportedFiles exportWhatCanBe(const NamedResult& result, std::span<const std::string> targets);

// Writes all or none, with the required folders.
void writeExportedFiles(const std::filesystem::path& folder, std::span<const FileContent> files);

}  // namespace evical
