// A result in other programs' formats, by name of the program. Each exporter writes a folder of its own and
// says in its files which transform and which sign of the time offset they hold; what a format has no place
// for is refitted with a stated error, named in a note, or refused, never dropped. Directions and keys are
// those of the programs' own sources.
#pragma once

#include "core/base/atomic_file.h"
#include "core/report/result_yaml.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

struct ExportedFiles {
  std::vector<FileContent> files;         // paths relative to the output folder: "kalibr/imu.yaml"
  std::vector<std::string> notes;         // what to know before using them
  std::vector<std::string> refused = {};  // of several targets those that got nothing, each with the reason
  std::vector<std::string> targets = {};  // those that have files
};

struct ReadBack;

struct ExportTarget {
  const char* name;
  const char* program;     // "Kalibr"; several where one file serves them
  const char* files;       // what is written, in a line
  const char* use;         // who reads it, in a line
  bool inertial_odometry;  // programs that estimate motion from camera and IMU start from it
  ExportedFiles (*write)(const NamedResult& result);  // paths relative to the target's folder
  // The written files as the program takes them (read_back.h).
  ReadBack (*read)(const std::filesystem::path& folder);
};

std::span<const ExportTarget> exportTargets();

// Throws CalibrationError (BadInput) for a name that nobody knows, with the nearest one; `place` precedes it.
const ExportTarget& exportTarget(std::string_view name, std::string_view place);

// Files of several targets, each below its name; a target that cannot hold the result stops none of the others. Throws
// CalibrationError (BadInput) for the result of a failed calibration, for names that nobody knows, and where no
// target can hold it.
ExportedFiles exportResult(const NamedResult& result, std::span<const std::string> targets);

// The same where nothing is wrong with request and result; that no target can hold it is said in `refused` only.
ExportedFiles exportWhatCanBe(const NamedResult& result, std::span<const std::string> targets);

// Writes all or none, and the folders that they need.
void writeExportedFiles(const std::filesystem::path& folder, std::span<const FileContent> files);

}  // namespace evical
