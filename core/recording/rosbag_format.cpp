#include "core/recording/rosbag_format.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <limits>

namespace evical {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

}  // namespace

std::optional<BagFields> BagFields::parse(Bytes bytes) {
  BagFields result;
  ByteReader reader(bytes);
  while (reader.remaining() > 0) {
    Bytes field;
    if (!reader.takeSized(field)) return std::nullopt;
    const std::string_view text = textOf(field);
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || result.count_ == result.fields_.size()) return std::nullopt;
    result.fields_[result.count_++] = {text.substr(0, equals), field.subspan(equals + 1)};
  }
  return result;
}

std::optional<Bytes> BagFields::find(std::string_view name) const {
  for (std::size_t i = 0; i < count_; ++i)
    if (fields_[i].name == name) return fields_[i].value;
  return std::nullopt;
}

std::string BagFields::text(std::string_view name) const {
  const std::optional<Bytes> value = find(name);
  return value ? std::string(textOf(*value)) : std::string();
}

std::optional<BagOp> BagFields::op() const {
  const std::optional<std::uint8_t> value = number<std::uint8_t>("op");
  if (!value || *value < 2 || *value > 7) return std::nullopt;
  return static_cast<BagOp>(*value);
}

std::int64_t bagTime(const std::uint8_t* bytes) {
  return loadLittleEndian<std::uint32_t>(bytes) * kSecond_ns + loadLittleEndian<std::uint32_t>(bytes + 4);
}

BagFieldsWriter& BagFieldsWriter::op(BagOp op) {
  return number("op", static_cast<std::uint8_t>(op));
}

BagFieldsWriter& BagFieldsWriter::text(std::string_view name, std::string_view value) {
  appendLittleEndian(bytes_, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  bytes_.insert(bytes_.end(), name.begin(), name.end());
  bytes_.push_back('=');
  bytes_.insert(bytes_.end(), value.begin(), value.end());
  return *this;
}

BagFieldsWriter& BagFieldsWriter::time(std::string_view name, std::int64_t time_ns) {
  std::vector<std::uint8_t> bytes;
  appendBagTime(bytes, time_ns);
  return text(name, textOf(bytes));
}

void appendBagTime(std::vector<std::uint8_t>& bytes, std::int64_t time_ns) {
  if (time_ns < 0 || time_ns / kSecond_ns > std::numeric_limits<std::uint32_t>::max())
    throw badInput(fmt::format("{} ns", time_ns), "is a time that a ROS bag cannot hold (0 to 2^32 s)",
                   "Shift the times, or write another format");
  appendLittleEndian(bytes, static_cast<std::uint32_t>(time_ns / kSecond_ns));
  appendLittleEndian(bytes, static_cast<std::uint32_t>(time_ns % kSecond_ns));
}

void appendSized(std::vector<std::uint8_t>& bytes, Bytes content) {
  appendLittleEndian(bytes, static_cast<std::uint32_t>(content.size()));
  bytes.insert(bytes.end(), content.begin(), content.end());
}

void appendBagRecord(std::vector<std::uint8_t>& bytes, const BagFieldsWriter& header, Bytes data) {
  appendSized(bytes, header.bytes());
  appendSized(bytes, data);
}

}  // namespace evical
