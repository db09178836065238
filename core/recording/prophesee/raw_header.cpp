#include "core/recording/prophesee/raw_header.h"

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <vector>

namespace evical::prophesee {
namespace {

constexpr int kLargestSensorSide_px = 16384;  // DAT has 14 bits
constexpr unsigned char kDatEventBytes = 8;
constexpr const char* kReadableEncodings = "Convert it with Metavision's tools to EVT2, EVT2.1 or EVT3";

struct Field {
  std::string key, value;
};

// Older files only name the system. (Table of Prophesee's plugins.)
struct KnownSystem {
  int id;
  Encoding encoding;
  Resolution resolution_px;
};
constexpr Resolution kVga_px{640, 480}, kHd_px{1280, 720};
constexpr KnownSystem kSystems[] = {
    {21, Encoding::Evt2, kVga_px}, {23, Encoding::Evt2, kVga_px}, {25, Encoding::Evt2, kVga_px},
    {28, Encoding::Evt2, kVga_px}, {29, Encoding::Evt2, kVga_px}, {33, Encoding::Evt2, kVga_px},
    {34, Encoding::Evt2, kVga_px}, {35, Encoding::Evt2, kVga_px}, {41, Encoding::Evt2, kVga_px},
    {26, Encoding::Evt2, kHd_px},  {31, Encoding::Evt2, kHd_px},  {39, Encoding::Evt2, kHd_px},
    {40, Encoding::Evt3, kVga_px}, {30, Encoding::Evt3, kHd_px},  {46, Encoding::Evt3, kHd_px},
    {48, Encoding::Evt3, kHd_px},  {49, Encoding::Evt3, kHd_px},  {50, Encoding::Evt3, kHd_px},
};
constexpr int kSystemMask = 0x7F;
constexpr int kFirstPlainSystem = 55;  // first system with the halves of EVT 2.1 in order

std::optional<int> headerNumber(std::string_view text) {
  int number = 0;
  text = trimmed(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

bool isText(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\r';  // names may be UTF-8
  });
}

// Removes the header lines; `offset` is the beginning of the data.
std::vector<Field> takeHeaderFields(const std::filesystem::path& path, std::string_view start,
                                    std::uint64_t& offset) {
  std::vector<Field> fields;
  offset = 0;
  while (start.substr(offset).starts_with("% ")) {
    const std::size_t end = start.find('\n', offset);
    const std::string_view line = start.substr(offset, end == std::string_view::npos ? end : end - offset);
    if (end == std::string_view::npos || !isText(line)) {
      if (!isText(line) && !fields.empty()) break;  // data that look like the begin of a line
      throw badInput(path.string(), fmt::format("the header is cut off in its line at byte {}", offset),
                     "Copy the file again");
    }
    offset = end + 1;
    const std::string_view content = trimmed(line.substr(2));
    if (content == "end") break;
    const std::size_t blank = std::min(content.find(' '), content.size());
    fields.push_back({std::string(content.substr(0, blank)), std::string(trimmed(content.substr(blank)))});
  }
  return fields;
}

const std::string* fieldNamed(const std::vector<Field>& fields, std::string_view key) {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const Field& field) { return field.key == key; });
  return found == fields.end() ? nullptr : &found->value;
}

// "EVT3;height=720;width=1280" becomes fields like those of lines.
void addOptions(std::vector<Field>& fields, std::string_view format) {
  for (bool first = true; !format.empty(); first = false) {
    const std::size_t end = std::min(format.find(';'), format.size());
    const std::string_view part = format.substr(0, end);
    format.remove_prefix(std::min(end + 1, format.size()));
    const std::size_t equals = std::min(part.find('='), part.size());
    if (!first && equals < part.size())
      fields.push_back({std::string(part.substr(0, equals)), std::string(part.substr(equals + 1))});
  }
}

Resolution resolutionIn(const std::vector<Field>& fields) {
  std::optional<int> width, height;
  for (const Field& field : fields) {
    if (field.key == "width" || field.key == "Width") width = headerNumber(field.value);
    if (field.key == "height" || field.key == "Height") height = headerNumber(field.value);
    const std::size_t cross = field.value.find('x');
    if (field.key == "geometry" && cross != std::string::npos) {
      width = headerNumber(std::string_view(field.value).substr(0, cross));
      height = headerNumber(std::string_view(field.value).substr(cross + 1));
    }
  }
  const auto good = [](const std::optional<int>& side) {
    return side && *side > 0 && *side <= kLargestSensorSide_px;
  };
  return good(width) && good(height) ? Resolution{*width, *height} : Resolution{};
}

std::optional<Encoding> encodingIn(const std::filesystem::path& path, const std::vector<Field>& fields) {
  const std::string *format = fieldNamed(fields, "format"), *old = fieldNamed(fields, "evt");
  if (!format && !old) return std::nullopt;
  const std::string name = format ? format->substr(0, format->find(';')) : *old;
  if (name == "EVT2" || name == "2.0") return Encoding::Evt2;
  if (name == "EVT21" || name == "2.1") return Encoding::Evt21;
  if (name == "EVT3" || name == "3.0") return Encoding::Evt3;
  throw badInput(path.string(), fmt::format("the header states encoding \"{}\", which cannot be read", name),
                 kReadableEncodings);
}

HalfOrder halfOrderIn(const std::vector<Field>& fields, const std::optional<int>& system) {
  if (const std::string* endianness = fieldNamed(fields, "endianness")) {
    if (*endianness == "little") return HalfOrder::Plain;
    if (*endianness == "legacy") return HalfOrder::Exchanged;
  }
  if (!system) return HalfOrder::Unknown;
  return *system < kFirstPlainSystem ? HalfOrder::Exchanged : HalfOrder::Plain;
}

bool isDatType(unsigned char type) {
  return type == 0 || type == 12 || type == 14;
}

// True with the two bytes between text and events.
bool takeDatBytes(std::string_view start, FileHeader& header) {
  const std::string_view bytes = start.substr(std::min<std::size_t>(header.data_offset, start.size()));
  if (bytes.size() < 2) return false;
  header.event_type = static_cast<unsigned char>(bytes[0]);
  if (!isDatType(header.event_type) || static_cast<unsigned char>(bytes[1]) != kDatEventBytes) return false;
  header.encoding = Encoding::Dat;
  header.data_offset += 2;
  return true;
}

}  // namespace

FileHeader parseHeader(const std::filesystem::path& path, std::string_view start) {
  FileHeader header;
  std::vector<Field> fields = takeHeaderFields(path, start, header.data_offset);
  if (const std::string* format = fieldNamed(fields, "format")) addOptions(fields, std::string(*format));
  header.resolution_px = resolutionIn(fields);
  const std::string* version = fieldNamed(fields, "Version");
  header.version = version ? headerNumber(*version).value_or(0) : 0;
  const std::optional<Encoding> encoding = encodingIn(path, fields);
  if (!encoding && takeDatBytes(start, header)) {
    if (fields.empty()) header.version = 2;  // as in all files of the last ten years
    return header;
  }
  const std::string* system_text = fieldNamed(fields, "system_ID");
  const std::optional<int> system = system_text ? headerNumber(*system_text) : std::nullopt;
  const auto known = std::find_if(std::begin(kSystems), std::end(kSystems), [&](const KnownSystem& entry) {
    return system && entry.id == (*system & kSystemMask);
  });
  if (!encoding && known == std::end(kSystems)) {
    throw badInput(
        path.string(),
        fmt::format("the header, which ends at byte {}, does not state the encoding", header.data_offset),
        "Add a line \"% evt 2.0\" or \"% evt 3.0\" in front of the file");
  }
  header.encoding = encoding ? *encoding : known->encoding;
  if (!header.resolution_px.known() && known != std::end(kSystems))
    header.resolution_px = known->resolution_px;
  header.half_order = halfOrderIn(fields, system);
  return header;
}

bool isBareDat(std::string_view start) {
  FileHeader header;
  if (!takeDatBytes(start, header)) return false;
  ByteCursor cursor(start.substr(2));
  std::uint32_t last_us = 0;
  bool any = false;
  while (cursor.remaining() >= kDatEventBytes) {
    const auto time_us = cursor.number<std::uint32_t>();
    cursor.number<std::uint32_t>();
    if (time_us < last_us) return false;
    last_us = time_us;
    any = true;
  }
  return any;
}

}  // namespace evical::prophesee
