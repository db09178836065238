#include "core/recording/numpy/numpy_columns.h"

#include <fmt/format.h>

namespace evical::numpy {
namespace {

constexpr std::size_t kColumnBlock_bytes = std::size_t{1} << 20;

}  // namespace

double detail::fromHalf(std::uint16_t bits) {
  const int exponent = bits >> 10 & 0x1F, fraction = bits & 0x3FF;
  const double sign = (bits & 0x8000) != 0 ? -1.0 : 1.0;
  if (exponent == 0x1F) return fraction == 0 ? sign * HUGE_VAL : std::nan("");
  if (exponent == 0) return sign * std::ldexp(fraction, -24);
  return sign * std::ldexp(1024 + fraction, exponent - 25);
}

ColumnBlocks::ColumnBlocks(std::span<const Column> columns, std::uint64_t rows) : rows_(rows) {
  std::vector<const Column*> leaders;  // one per source
  for (const Column& column : columns) {
    const auto same = [&](const Column* other) {
      return other->range.path == column.range.path && other->range.position == column.range.position &&
             other->start == column.start && other->stride == column.stride;
    };
    const auto found = std::find_if(leaders.begin(), leaders.end(), same);
    places_.push_back({static_cast<std::size_t>(found - leaders.begin()), column.offset, column.type});
    if (found != leaders.end()) continue;
    leaders.push_back(&column);
    Source& source = sources_.emplace_back();
    source.array = column.array;
    source.stride = column.stride;
    source.bytes = openBytes(column.range);
    if (rows > 0 && !source.bytes->skip(column.data_offset + column.start)) rows_ = 0, ended_ = column.array;
    largest_stride_ = std::max(largest_stride_, column.stride);
  }
}

std::size_t ColumnBlocks::next(std::size_t most) {
  const std::size_t rows = static_cast<std::size_t>(std::min<std::uint64_t>(
      {most, rows_ - read_, std::max<std::size_t>(1, kColumnBlock_bytes / largest_stride_)}));
  in_block_ = rows;
  if (rows == 0) return 0;
  for (Source& source : sources_) {
    const std::size_t filled = fill(source, rows);
    if (filled < rows) {
      rows_ = read_ + std::min(in_block_, filled);  // and no more
      ended_ = source.array;
    }
    in_block_ = std::min(in_block_, filled);
  }
  read_ += in_block_;
  return in_block_;
}

std::size_t ColumnBlocks::fill(Source& source, std::size_t rows) {
  source.block.resize(rows * source.stride);
  std::size_t filled = 0;
  while (filled < source.block.size()) {
    const std::size_t got = source.bytes->read(source.block.data() + filled, source.block.size() - filled);
    if (got == 0) break;
    filled += got;
  }
  return filled / source.stride;
}

std::string ColumnBlocks::problem() const {
  for (const Source& source : sources_) {
    const std::string problem = source.bytes->problem();
    if (!problem.empty()) return fmt::format("{}: {}", source.array, problem);
  }
  return ended_.empty() ? "" : fmt::format("{} has fewer rows than it states: {}", ended_, rows_);
}

}  // namespace evical::numpy
