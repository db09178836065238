// Atomic writing of files: a file appears completely or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Sinks for texts that are too large for memory: passed on piece by piece.

using TextSink = std::function<void(std::string_view piece)>;
using TextSource = std::function<void(const TextSink& sink)>;

inline std::string wholeText(const TextSource& source) {
  std::string text;
  source([&](std::string_view piece) { text += piece; });
  return text;
}

// Writes a temporary file next to the target, syncs and renames it. On failure, throws CalibrationError
// (CalibrationFailed) that names path and reason, leaves no temporary file, and keeps an older file
// unchanged. The folder must exist. An existing device or pipe is not replaced.
void writeFileWhole(const std::filesystem::path& path, std::string_view content);

struct FileContent {
  std::filesystem::path path;
  std::string content;
  TextSource pieces = {};  // of large files, instead of content; references its source data
};
std::string contentOf(const FileContent& file);

// The same for several files that belong together: all are written to temporary files before the first is
// renamed. If one rename fails, those before it are undone. The last file marks the whole set as complete: it
// is removed first and appears last, so that a killed run leaves no mark instead of parts of two runs.
void writeFilesWhole(std::span<const FileContent> files);

// The same for existing files and folders, elsewhere in the same file system; a folder replaces an older one
// as a whole. If it throws, all are in their old places.
struct FileMove {
  std::filesystem::path from, to;
};
void moveFilesWhole(std::span<const FileMove> moves);

// Removes temporary files of this file that killed runs have left: "NAME.part.XXXXXX", files or folders
// without a change for an hour. "NAME.former.XXXXXX", which was being replaced, stays if the file itself is
// missing.
void removeLitterOf(const std::filesystem::path& path);

// Creates the folder and its parents; throws CalibrationError (BadInput) if it cannot be created or written
// to.
void makeOutputFolder(const std::filesystem::path& folder);

// A result folder may be a stranger's. Symbolic links to folders in it are replaced by folders, as linked
// files are by files: following them would overwrite files elsewhere. Removes those on the way to output /
// below, and returns them (from: what the link names).
std::vector<FileMove> removeLinksWithin(const std::filesystem::path& output,
                                        const std::filesystem::path& below);

// Creates output / below, without following links in `output`; throws as makeOutputFolder does.
void makeFolderWithin(const std::filesystem::path& output, const std::filesystem::path& below);

}  // namespace evical
