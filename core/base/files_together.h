// Atomic writing of a set of files one after the other: all appear or none, and at most one of them is in
// memory.
#pragma once

#include "core/base/atomic_file.h"

#include <filesystem>
#include <vector>

namespace evical {

class FilesTogether {
 public:
  FilesTogether() = default;
  // Removes files that were not placed, and the folders that were created for them; restores replaced links.
  ~FilesTogether();
  FilesTogether(const FilesTogether&) = delete;
  FilesTogether& operator=(const FilesTogether&) = delete;

  // Creates the folder and its parents, as makeOutputFolder does.
  void makeFolder(const std::filesystem::path& folder);
  // Writes a temporary file next to the target, and syncs it; throws as writeFileWhole does.
  void write(const std::filesystem::path& path, const TextSource& content);
  void write(const FileContent& file);
  // The same at the file's path within a folder; creates missing folders, and does not follow links to others
  // (removeLinksWithin).
  void writeInto(const std::filesystem::path& folder, const FileContent& file);
  // Renames all files to their targets, as writeFilesWhole does: the last one written marks the set as
  // complete.
  void place();

 private:
  void writeAt(const std::filesystem::path& path, const FileContent& file);

  std::vector<FileMove> files_;
  std::vector<std::filesystem::path> made_;
  std::vector<FileMove> links_;  // that were replaced by folders
};

}  // namespace evical
