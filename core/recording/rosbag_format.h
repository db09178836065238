// The records of a ROS 1 bag, format 2.0 (http://wiki.ros.org/Bags/Format/2.0), shared by reader and writer:
// u32 header length, header, u32 data length, data. A header is fields of u32 length and "name=value", value
// binary.
#pragma once

#include "core/recording/byte_reader.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

inline constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
inline constexpr std::size_t kBagHeaderRecordSize =
    4096;  // with padding, so that it can be rewritten at the end

enum class BagOp : std::uint8_t {
  Message = 2,
  BagHeader = 3,
  IndexData = 4,
  Chunk = 5,
  ChunkInfo = 6,
  Connection = 7
};

// Fields of a header, or of a connection's data, which is written the same way.
class BagFields {
 public:
  // Nothing if the bytes aren't such fields to the end, or more of them than any bag has.
  static std::optional<BagFields> parse(Bytes bytes);

  std::optional<Bytes> find(std::string_view name) const;
  std::string text(std::string_view name) const;  // empty where absent
  template <class T>
  std::optional<T> number(std::string_view name) const {
    const std::optional<Bytes> value = find(name);
    if (!value || value->size() != sizeof(T)) return std::nullopt;
    return loadLittleEndian<T>(value->data());
  }
  std::optional<BagOp> op() const;

 private:
  struct Field {
    std::string_view name;
    Bytes value;
  };
  std::array<Field, 16> fields_ =
      {};  // views into what was parsed; no allocation, since every message has such
  std::size_t count_ = 0;
};

// u32 seconds, u32 nanoseconds.
std::int64_t bagTime(const std::uint8_t* bytes);

class BagFieldsWriter {
 public:
  BagFieldsWriter& op(BagOp op);
  BagFieldsWriter& text(std::string_view name, std::string_view value);
  template <class T>
  BagFieldsWriter& number(std::string_view name, T value) {
    std::vector<std::uint8_t> bytes;
    appendLittleEndian(bytes, value);
    return text(name, textOf(bytes));
  }
  BagFieldsWriter& time(std::string_view name, std::int64_t time_ns);
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

// Throws CalibrationError (BadInput) for times that two u32 can't hold.
void appendBagTime(std::vector<std::uint8_t>& bytes, std::int64_t time_ns);

void appendSized(std::vector<std::uint8_t>& bytes, Bytes content);
void appendBagRecord(std::vector<std::uint8_t>& bytes, const BagFieldsWriter& header, Bytes data);

}  // namespace evical
