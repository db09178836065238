// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace evical {

// Writes beside the target, syncs, renames. On failure throws CalibrationError (CalibrationFailed) that names
// path and reason, leaves nothing behind and an older file as it was. The folder must exist.
void writeFileWhole(const std::filesystem::path& path, std::string_view content);

struct FileContent {
  std::filesystem::path path;
  std::string content;
};

// The same for several files: all are written aside before the first is renamed, so a full
// disk changes none of them.
void writeFilesWhole(std::span<const FileContent> files);

// Makes the folder and those above it; throws CalibrationError (BadInput) if it can't be made or written to.
void makeOutputFolder(const std::filesystem::path& folder);

}  // namespace evical
