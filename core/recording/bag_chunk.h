// One chunk of a ROS 1 bag, unpacked, and the records in it.
#pragma once

#include "core/recording/input_file.h"
#include "core/recording/rosbag_format.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

struct BagRecord {
  BagFields fields;
  Bytes data;
};

class BagChunkReader {
 public:
  // Replaces the chunk by the one at `position`, reusing storage. What is whole of a damaged chunk can be
  // read; fault() says what isn't. A chunk whose checksum fails is dropped altogether.
  void load(const InputFile& file, std::uint64_t position);

  // False behind the last whole record.
  bool next(BagRecord& record);

  double fractionRead() const;  // of this chunk

  // "", "truncated" or "corrupt", and a sentence with the byte.
  const std::string& faultKind() const { return fault_kind_; }
  const std::string& faultText() const { return fault_text_; }

 private:
  void loadData(const InputFile& file, std::uint64_t data_position, std::uint32_t packed_size,
                std::uint32_t size, std::string_view compression_name);
  void setFault(const char* kind, const std::string& text);

  std::vector<std::uint8_t> packed_, plain_;
  ByteReader reader_{Bytes()};
  std::uint64_t position_ = 0;
  std::string fault_kind_, fault_text_;
};

// A record of the file itself, without its data.
struct BagFileRecord {
  BagFileRecord() = default;
  BagFileRecord(const BagFileRecord&) = delete;  // `fields` would look into the original
  BagFileRecord& operator=(const BagFileRecord&) = delete;

  enum class State { Whole, Truncated, Corrupt };
  State state = State::Corrupt;
  std::vector<std::uint8_t> header_bytes;  // what `fields` looks into
  BagFields fields;                        // valid unless Corrupt, or Truncated within the header
  bool has_header = false;
  std::uint64_t data_position = 0;
  std::uint32_t data_size = 0;  // as claimed; Truncated where the file ends before

  std::uint64_t end() const { return data_position + data_size; }
};
void readBagFileRecord(const InputFile& file, std::uint64_t position, BagFileRecord& record);

}  // namespace evical
