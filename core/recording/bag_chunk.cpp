#include "core/recording/bag_chunk.h"

#include "core/recording/chunk_compression.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr std::uint32_t kLongestHeader = 1U << 20;       // real ones have some 100 bytes
constexpr std::uint64_t kUsualHeader = 512;              // fits nearly all, so one read suffices
constexpr std::size_t kLargestChunk = (1ULL << 31) - 1;  // unpacked; real ones have 1 MB, or one long message

}  // namespace

void readBagFileRecord(const InputFile& file, std::uint64_t position, BagFileRecord& record) {
  record.state = BagFileRecord::State::Truncated;
  record.has_header = false;
  record.data_size = 0;
  record.data_position = position;
  std::vector<std::uint8_t>& bytes = record.header_bytes;
  file.readAt(position, kUsualHeader, bytes);
  if (bytes.size() < sizeof(std::uint32_t)) return;
  const auto header_size = loadLittleEndian<std::uint32_t>(bytes.data());
  if (header_size == 0 || header_size > kLongestHeader) {
    record.state = BagFileRecord::State::Corrupt;
    return;
  }
  const std::size_t needed = 2 * sizeof(std::uint32_t) + header_size;
  if (bytes.size() < needed) file.readAt(position, needed, bytes);
  if (bytes.size() < needed) return;
  const Bytes header = Bytes(bytes).subspan(sizeof(std::uint32_t), header_size);
  const std::optional<BagFields> fields = BagFields::parse(header);
  if (!fields || !fields->op()) {
    record.state = BagFileRecord::State::Corrupt;
    return;
  }
  record.fields = *fields;
  record.has_header = true;
  record.data_position = position + needed;
  record.data_size = loadLittleEndian<std::uint32_t>(bytes.data() + needed - sizeof(std::uint32_t));
  if (record.end() <= file.size()) record.state = BagFileRecord::State::Whole;
}

void BagChunkReader::setFault(const char* kind, const std::string& text) {
  if (!fault_kind_.empty()) return;  // the first one explains those that follow
  fault_kind_ = kind;
  fault_text_ = fmt::format("the chunk at byte {} {}", position_, text);
}

void BagChunkReader::load(const InputFile& file, std::uint64_t position) {
  position_ = position;
  fault_kind_.clear();
  fault_text_.clear();
  plain_.clear();
  BagFileRecord record;
  readBagFileRecord(file, position, record);
  if (!record.has_header && record.state == BagFileRecord::State::Truncated) {
    setFault("truncated", "is cut off in its header");
  } else if (!record.has_header || record.fields.op() != BagOp::Chunk) {
    setFault("corrupt", "has no valid header");
  } else {
    loadData(file, record.data_position, record.data_size,
             record.fields.number<std::uint32_t>("size").value_or(0), record.fields.text("compression"));
  }
  reader_ = ByteReader(plain_);
}

void BagChunkReader::loadData(const InputFile& file, std::uint64_t data_position, std::uint32_t packed_size,
                              std::uint32_t size, std::string_view compression_name) {
  const std::optional<Compression> compression = compressionNamed(compression_name);
  if (!compression) {
    setFault("corrupt",
             "has a compression that is not known: '" + std::string(compression_name.substr(0, 20)) + "'");
    return;
  }
  if (packed_size > kLargestChunk || size > kLargestChunk) {
    setFault("corrupt", fmt::format("claims {} bytes", std::max(packed_size, size)));
    return;
  }
  file.readAt(data_position, packed_size, packed_);
  if (packed_.size() < packed_size)
    setFault("truncated", fmt::format("is cut off: {} of {} bytes are there", packed_.size(), packed_size));
  if (*compression == Compression::None) {
    std::swap(packed_, plain_);
    return;
  }
  const Unpacked result = unpack(*compression, packed_, size, plain_);
  if (result == Unpacked::Corrupt) {
    setFault("corrupt", fmt::format("cannot be unpacked ({})", compression_name));
    plain_.clear();
  } else if (result == Unpacked::Partial) {
    setFault("corrupt", fmt::format("holds {} of {} bytes", plain_.size(), size));
  }
}

bool BagChunkReader::next(BagRecord& record) {
  if (reader_.remaining() == 0) return false;
  Bytes header;
  const std::size_t start = reader_.position();
  if (!reader_.takeSized(header) || !reader_.takeSized(record.data)) {
    setFault("corrupt", fmt::format("ends within a record (byte {} of the unpacked chunk)", start));
    reader_ = ByteReader(Bytes());
    return false;
  }
  const std::optional<BagFields> fields = BagFields::parse(header);
  if (!fields || !fields->op()) {
    setFault("corrupt", fmt::format("has a damaged record (byte {} of the unpacked chunk)", start));
    reader_ = ByteReader(Bytes());
    return false;
  }
  record.fields = *fields;
  return true;
}

double BagChunkReader::fractionRead() const {
  const double size = static_cast<double>(plain_.size());
  return size > 0.0 ? static_cast<double>(reader_.position()) / size : 1.0;
}

}  // namespace evical
