#include "core/recording/numpy/numpy_files.h"

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/recording/block_reader.h"
#include "core/recording/byte_cursor.h"
#include "core/recording/unpacking_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
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

// PKWARE's APPNOTE.TXT, 4.3: the end record and, for large files, zip64's before it give the directory's
// position.

namespace evical::numpy {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kLocalMagic = "PK\3\4"sv, kEntryMagic = "PK\1\2"sv, kEndMagic = "PK\5\6"sv,
                           kEnd64Magic = "PK\6\6"sv, kEnd64PlaceMagic = "PK\6\7"sv;
constexpr std::uint64_t kEnd_bytes = 22, kEnd64Place_bytes = 20, kEnd64_bytes = 56, kEntry_bytes = 46,
                        kLocal_bytes = 30;
constexpr std::uint64_t kLongestComment_bytes = 65'535;
constexpr std::uint32_t kIn64 = 0xFFFFFFFF;  // the number is zip64's
constexpr unsigned kStored = 0, kDeflated = 8;

struct Directory {
  std::uint64_t position = 0, entries = 0;
};

class ArchiveReader {
 public:
  explicit ArchiveReader(const std::filesystem::path& path)
      : path_(path), file_(path), locals_(path, std::ios::binary) {}

  std::vector<ZipMember> run() {
    const Directory directory = findDirectory();
    std::vector<ZipMember> members;
    UnpackingLimit limit(path_.string(), file_.size());
    std::uint64_t position = directory.position;
    for (std::uint64_t i = 0; i < directory.entries; ++i) {
      members.push_back(readEntry(position));
      limit.add(members.back().range.bytes);  // several members can be at one place
    }
    return members;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw badInput(path_.string(), problem, "Copy the file again; was it written completely?");
  }

  std::string_view at(std::uint64_t position, std::uint64_t count, const char* what) {
    std::string_view bytes;
    if (!file_.read(position, count, bytes))
      fail(fmt::format("{} is incomplete, at byte {}", what, position));
    return bytes;
  }

  Directory findDirectory() {
    const std::uint64_t tail = std::min(file_.size(), kEnd_bytes + kLongestComment_bytes);
    const std::uint64_t tail_at = file_.size() - tail;
    const std::string_view bytes = at(tail_at, tail, "the end");
    const std::size_t found = findEnd(bytes);
    if (found == std::string_view::npos)
      fail("the archive's directory, which is at its end, is missing: the file is cut off");
    ByteCursor cursor(bytes.substr(found + kEndMagic.size()));
    cursor.take(6);  // disks, and entries on this one
    Directory directory;
    directory.entries = cursor.number<std::uint16_t>();
    cursor.take(4);  // its size
    directory.position = cursor.number<std::uint32_t>();
    const std::uint64_t end_at = tail_at + found;
    if (directory.position == kIn64 || directory.entries == 0xFFFF) findDirectory64(end_at, directory);
    return directory;
  }

  // A comment with any content may follow it.
  static std::size_t findEnd(std::string_view bytes) {
    std::size_t last = std::string_view::npos;
    for (std::size_t at = bytes.rfind(kEndMagic); at != std::string_view::npos;
         at = at == 0 ? std::string_view::npos : bytes.rfind(kEndMagic, at - 1)) {
      if (bytes.size() - at < kEnd_bytes) continue;
      ByteCursor cursor(bytes.substr(at + kEnd_bytes - 2));
      if (cursor.number<std::uint16_t>() == bytes.size() - at - kEnd_bytes) return at;
      if (last == std::string_view::npos) last = at;
    }
    return last;
  }

  void findDirectory64(std::uint64_t end_at, Directory& directory) {
    if (end_at < kEnd64Place_bytes) return;
    ByteCursor place(at(end_at - kEnd64Place_bytes, kEnd64Place_bytes, "the archive's end"));
    if (place.take(kEnd64PlaceMagic.size()) != kEnd64PlaceMagic) return;  // not a zip64 archive
    place.take(4);                                                        // disk
    const auto position = place.number<std::uint64_t>();
    ByteCursor cursor(at(position, kEnd64_bytes, "zip64's end record"));
    if (cursor.take(kEnd64Magic.size()) != kEnd64Magic)
      fail(fmt::format("zip64's end record is not at byte {}", position));
    cursor.take(28);  // its size, versions, disks, and entries on this one
    directory.entries = cursor.number<std::uint64_t>();
    cursor.take(8);  // its size
    directory.position = cursor.number<std::uint64_t>();
  }

  ZipMember readEntry(std::uint64_t& position) {
    ByteCursor cursor(at(position, kEntry_bytes, "the archive's directory"));
    if (cursor.take(kEntryMagic.size()) != kEntryMagic)
      fail(fmt::format("the archive's directory is damaged at byte {}", position));
    cursor.take(4);  // versions
    const auto flags = cursor.number<std::uint16_t>(), method = cursor.number<std::uint16_t>();
    cursor.take(4);  // date
    ZipMember member;
    member.range.path = path_;
    member.range.checksum = cursor.number<std::uint32_t>();
    member.range.packed_bytes = cursor.number<std::uint32_t>();
    member.range.bytes = cursor.number<std::uint32_t>();
    const std::uint64_t name = cursor.number<std::uint16_t>(), extra = cursor.number<std::uint16_t>(),
                        comment = cursor.number<std::uint16_t>();
    cursor.take(8);  // disk, attributes
    std::uint64_t local_at = cursor.number<std::uint32_t>();
    const std::string_view texts = at(position + kEntry_bytes, name + extra, "the archive's directory");
    member.name = texts.substr(0, name);
    takeFrom64(texts.substr(name), member.range, local_at);
    position += kEntry_bytes + name + extra + comment;
    member.range.deflated = method == kDeflated;
    if ((flags & 1) != 0) member.problem = "it is encrypted";
    if (method != kStored && method != kDeflated)
      member.problem = fmt::format("it is packed with method {}, not stored or deflated", method);
    if (member.problem.empty()) findBytes(local_at, member);
    return member;
  }

  // Reads the numbers that do not fit in 32 bits, in this order.
  static void takeFrom64(std::string_view extra, ByteRange& range, std::uint64_t& local_at) {
    ByteCursor fields(extra);
    while (fields.remaining() >= 4) {
      const auto id = fields.number<std::uint16_t>(), size = fields.number<std::uint16_t>();
      const std::string_view content = fields.take(size);
      if (!fields.ok()) return;
      if (id != 1) continue;
      ByteCursor numbers(content);
      for (std::uint64_t* number : {&range.bytes, &range.packed_bytes, &local_at})
        if (*number == kIn64 && numbers.remaining() >= 8) *number = numbers.number<std::uint64_t>();
    }
  }

  void findBytes(std::uint64_t local_at, ZipMember& member) {
    std::string local(kLocal_bytes, '\0');
    locals_.clear();
    locals_.seekg(static_cast<std::streamoff>(local_at));
    if (local_at >= file_.size() || !locals_.read(local.data(), kLocal_bytes) ||
        !local.starts_with(kLocalMagic)) {
      member.problem = fmt::format("it is not at byte {}", local_at);
      return;
    }
    ByteCursor cursor(std::string_view(local).substr(26));
    const std::uint64_t name = cursor.number<std::uint16_t>(), extra = cursor.number<std::uint16_t>();
    ByteRange& range = member.range;
    range.position = local_at + kLocal_bytes + name + extra;
    const std::uint64_t there = file_.size() - std::min(file_.size(), range.position);
    member.cut = range.packed_bytes > there;
    range.packed_bytes = std::min(range.packed_bytes, there);
    range.bytes =
        std::min(range.bytes, range.deflated ? mostInflated(range.packed_bytes) : range.packed_bytes);
  }

  std::filesystem::path path_;
  RandomAccessFile file_;  // of the directory
  std::ifstream locals_;   // of members' own headers, throughout the file
};

}  // namespace

std::vector<ZipMember> zipMembers(const std::filesystem::path& path) {
  return ArchiveReader(path).run();
}

std::string_view firstZipMember(std::string_view first_bytes) {
  if (!first_bytes.starts_with(kLocalMagic) || first_bytes.size() < kLocal_bytes) return {};
  ByteCursor cursor(first_bytes.substr(26));
  const std::size_t name = cursor.number<std::uint16_t>();
  return first_bytes.substr(kLocal_bytes, name);
}

}  // namespace evical::numpy
