// Files that appear whole or not at all.
#pragma once

#include "core/base/text_sink.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace evical {

// Writes beside the target, syncs, renames. On failure throws CalibrationError (CalibrationFailed) that names
// path and reason, leaves nothing behind and an older file as it was. The folder must exist. What is there
// and is no file (a device, a pipe) stays.
void writeFileWhole(const std::filesystem::path& path, std::string_view content);

struct FileContent {
  std::filesystem::path path;
  std::string content;
  TextSource pieces = {};  // of what is large, in the place of content; refers to what it is made of
};
std::string contentOf(const FileContent& file);

// The same for several files that belong together: all are written aside before the first takes its place,
// and where one cannot, those before give theirs back. The last of them is the mark of the whole: it goes
// first and comes last, so that a run that is killed between leaves no mark rather than parts of two runs.
void writeFilesWhole(std::span<const FileContent> files);

// The same with files and folders that are written already, elsewhere in the file system of their places; a folder takes
// the place of an older one as a whole. Where it throws, they are where they were.
struct FileMove {
  std::filesystem::path from, to;
};
void moveFilesWhole(std::span<const FileMove> moves);

// Removes what killed runs have left of this file while it was written: "NAME.part.XXXXXX", files or folders
// in which nothing has changed for an hour.
void removeLitterOf(const std::filesystem::path& path);

// Makes the folder and those above it; throws CalibrationError (BadInput) if it can't be made or written to.
void makeOutputFolder(const std::filesystem::path& folder);

}  // namespace evical
