// Where things are in a ROS 1 bag: its connections and chunks, from the index at the end, or, where that is
// missing or damaged, from one pass over the records.
#pragma once

#include "core/recording/chunk_compression.h"
#include "core/recording/fault_log.h"
#include "core/recording/input_file.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct BagConnection {
  std::uint32_t id = 0;
  std::string topic, type, md5, definition;
};

struct BagChunk {
  std::uint64_t position = 0;  // of its record
  struct Count {
    std::uint32_t connection = 0, messages = 0;
  };
  // Messages by connection. `counted` false: not known (the recorder died before it wrote them), so look
  // inside.
  std::vector<Count> counts;
  bool counted = false;
};

struct BagLayout {
  std::vector<BagConnection> connections;
  std::vector<BagChunk> chunks;  // in the file's order
};

// Faults ("truncated", "corrupt") name the byte. Throws CalibrationError (BadInput) where there is nothing to
// read.
BagLayout readBagLayout(const InputFile& file, FaultLog& faults);

// A chunk's own header and the place of its data.
struct ChunkHeader {
  Compression compression = Compression::None;
  std::uint64_t data_position = 0;
  std::uint32_t packed_size = 0, size = 0;  // as the file claims
};

// Nothing where there is no chunk at `position`. Throws CalibrationError (BadInput) on an unknown
// compression.
std::optional<ChunkHeader> readChunkHeader(const InputFile& file, std::uint64_t position);

// Records inside a chunk, or any bytes that hold whole records.
struct BagRecordView {
  Bytes header, data;
};
// False at the end; `whole` false where the last one is cut or its lengths lie.
bool nextBagRecord(ByteReader& reader, BagRecordView& record, bool& whole);

// Nothing where fields are missing.
std::optional<BagConnection> parseConnection(const BagRecordView& record);

}  // namespace evical
