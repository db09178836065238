// Events from the columns of a layout, in order of the rows and in bounded memory.
#pragma once

#include "core/data/event.h"
#include "core/recording/block_decoder.h"
#include "core/recording/numpy/numpy_columns.h"
#include "core/recording/numpy/numpy_layouts.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical::numpy {

class EventTable {
 public:
  explicit EventTable(const EventLayout& layout);

  // Replaces `events` by those of the next rows, some 10k; false at the end. Some rows may have none.
  bool load(std::vector<Event>& events);

  std::uint64_t rowsRead() const { return blocks_.rowsRead(); }
  std::uint64_t rows() const { return rows_; }
  std::string problem() const { return blocks_.problem(); }

  // Number of omitted rows, and the first of them.
  const Occurrences& untimed() const { return untimed_; }
  const Occurrences& outside() const { return outside_; }
  const Occurrences& unpolarised() const { return unpolarised_; }

 private:
  void loadTimes(std::uint64_t first_row, std::vector<Event>& events);
  void loadPlaces(std::uint64_t first_row, std::vector<Event>& events);
  void loadPolarities(std::uint64_t first_row, std::vector<Event>& events);

  ColumnBlocks blocks_;
  std::uint64_t rows_;
  std::int64_t unit_ns_, offset_ns_;
  std::vector<unsigned char> bad_;  // of the rows of the block
  Occurrences untimed_, outside_, unpolarised_;
};

}  // namespace evical::numpy
