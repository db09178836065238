// Files that belong together, written one after the other: they appear all or not at all, and no more than one of them
// need be in memory.
#pragma once

#include "core/base/atomic_file.h"

#include <filesystem>
#include <vector>

namespace evical {

class FilesTogether {
 public:
  FilesTogether() = default;
  // What was not placed goes away again, and with it the folders that were made for it.
  ~FilesTogether();
  FilesTogether(const FilesTogether&) = delete;
  FilesTogether& operator=(const FilesTogether&) = delete;

  // Makes the folder and those above it, as makeOutputFolder.
  void makeFolder(const std::filesystem::path& folder);
  // Beside its place, synced; throws as writeFileWhole does.
  void write(const std::filesystem::path& path, const TextSource& content);
  void write(const FileContent& file);
  // At the file's path within a folder; makes those that are not there.
  void writeInto(const std::filesystem::path& folder, const FileContent& file);
  // All take their places, as writeFilesWhole says: the one that was written last is the mark of the whole.
  void place();

 private:
  void writeAt(const std::filesystem::path& path, const FileContent& file);

  std::vector<FileMove> files_;
  std::vector<std::filesystem::path> made_;
};

}  // namespace evical
