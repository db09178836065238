#include "core/recording/aedat/flat_buffer.h"

#include "core/recording/byte_cursor.h"

namespace evical::aedat {
namespace {

constexpr std::size_t kVtableHeader_bytes = 4;

}  // namespace

FlatBuffer::FlatBuffer(std::string_view bytes) {
  ByteCursor cursor(bytes);
  bytes_ = cursor.sized();
  ok_ = cursor.ok() && bytes_.size() >= 8;
  if (ok_) identifier_ = bytes_.substr(4, 4);
}

FlatTable FlatBuffer::tableAt(std::size_t position) {
  FlatTable table;
  const std::size_t offset = read<std::uint32_t>(position);
  table.position = position + offset;
  const std::int64_t vtable = static_cast<std::int64_t>(table.position) - read<std::int32_t>(table.position);
  if (vtable < 0) ok_ = false;
  if (!ok_) return {};
  table.vtable = static_cast<std::size_t>(vtable);
  const std::size_t size = read<std::uint16_t>(table.vtable);
  if (!ok_ || size < kVtableHeader_bytes || size > bytes_.size() - table.vtable) {
    ok_ = false;
    return {};
  }
  table.fields = (size - kVtableHeader_bytes) / 2;
  return table;
}

std::size_t FlatBuffer::field(const FlatTable& table, std::size_t index, std::size_t size) {
  if (!ok_ || index >= table.fields) return 0;
  const std::size_t offset = read<std::uint16_t>(table.vtable + kVtableHeader_bytes + 2 * index);
  if (offset == 0) return 0;
  const std::size_t position = table.position + offset;
  if (position <= bytes_.size() && size <= bytes_.size() - position) return position;
  ok_ = false;
  return 0;
}

FlatVector FlatBuffer::vector(const FlatTable& table, std::size_t index, std::size_t element_bytes) {
  const std::size_t at = field(table, index, 4);
  if (at == 0) return {};
  const std::size_t start = at + read<std::uint32_t>(at);
  const FlatVector vector{start + 4, read<std::uint32_t>(start)};
  if (ok_ && vector.count <= (bytes_.size() - vector.position) / element_bytes) return vector;
  ok_ = false;
  return {};
}

std::string_view FlatBuffer::text(const FlatTable& table, std::size_t index) {
  const FlatVector letters = vector(table, index, 1);
  return bytes_.substr(letters.position, letters.count);
}

}  // namespace evical::aedat
