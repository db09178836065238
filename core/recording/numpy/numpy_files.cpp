#include "core/recording/numpy/numpy_files.h"

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/recording/numpy/zip_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <fstream>
#include <system_error>
#include <tuple>

namespace evical::numpy {
namespace {

constexpr const char *kArrayEnd = ".npy", *kArchiveEnd = ".npz";

std::string beginOf(const std::filesystem::path& path, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  return bytes;
}

std::string withoutEnd(std::string name) {
  if (name.ends_with(kArrayEnd)) name.resize(name.size() - std::string_view(kArrayEnd).size());
  return name;
}

Array arrayAt(const ByteRange& range, const std::string& name) {
  const std::unique_ptr<ByteStream> bytes = openBytes(range);
  return {name, range, readArrayHeader(*bytes, fmt::format("{}", range.path.string()))};
}

Array arrayOf(const std::filesystem::path& file) {
  ByteRange range;
  range.path = file;
  range.bytes = range.packed_bytes = std::filesystem::file_size(file);
  return arrayAt(range, visible(withoutEnd(file.filename().string())));
}

void addMember(const ZipMember& member, FoundFiles& found) {
  const std::string name = withoutEnd(member.name);
  if (name == member.name) return;  // not an array
  if (!member.problem.empty()) {
    found.problems.push_back(fmt::format("{} is left out: {}.", member.name, member.problem));
    return;
  }
  try {
    found.arrays.push_back(arrayAt(member.range, name));
  } catch (const CalibrationError& error) {
    found.problems.push_back(fmt::format("{} is left out: {}.", member.name, error.problem()));
  }
  if (member.cut)
    found.problems.push_back(fmt::format("{} is incomplete: the file is cut off.", member.name));
}

std::vector<std::filesystem::path> filesEndingOn(const std::filesystem::path& folder, const char* end) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == end && entry.is_regular_file(ignored)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool isNumber(const std::string& name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

FoundFiles arraysIn(const std::filesystem::path& file) {
  FoundFiles found;
  if (beginOf(file, kArrayMagic.size()) == kArrayMagic) {
    found.arrays.push_back(arrayOf(file));
    return found;
  }
  for (const ZipMember& member : zipMembers(file)) addMember(member, found);
  return found;
}

FoundFiles arraysOfFolder(const std::filesystem::path& folder) {
  FoundFiles found;
  for (const std::filesystem::path& file : filesEndingOn(folder, kArrayEnd)) {
    try {
      found.arrays.push_back(arrayOf(file));
    } catch (const CalibrationError& error) {
      found.problems.push_back(fmt::format("{} is left out: {}.", file.filename().string(), error.problem()));
    }
  }
  for (const std::filesystem::path& file : filesEndingOn(folder, kArchiveEnd))
    found.unread.push_back(file.filename().string());
  return found;
}

std::vector<std::string> arrayNames(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : filesEndingOn(folder, kArrayEnd))
    names.push_back(file.stem().string());
  return names;
}

// By value, since some programs do not pad with zeros.
std::vector<std::filesystem::path> numberedFiles(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files = filesEndingOn(folder, kArchiveEnd);
  if (files.empty()) files = filesEndingOn(folder, kArrayEnd);
  const auto numbered = [](const std::filesystem::path& file) { return isNumber(file.stem().string()); };
  if (!std::all_of(files.begin(), files.end(), numbered)) return {};
  const auto valueOf = [](const std::filesystem::path& file) {
    std::string digits = file.stem().string();
    digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
    return std::tuple(digits.size(), digits);
  };
  std::sort(files.begin(), files.end(),
            [&](const auto& a, const auto& b) { return valueOf(a) < valueOf(b); });
  return files;
}

bool isArrayFile(const std::filesystem::path& path, std::string_view first_bytes) {
  if (first_bytes.starts_with(kArrayMagic) || firstZipMember(first_bytes).ends_with(kArrayEnd)) return true;
  if (firstZipMember(first_bytes).empty()) return false;
  try {
    const std::vector<ZipMember> members = zipMembers(path);
    return std::any_of(members.begin(), members.end(),
                       [](const ZipMember& member) { return member.name.ends_with(kArrayEnd); });
  } catch (const CalibrationError&) {
    return false;  // an archive of unknown content
  }
}

}  // namespace evical::numpy
