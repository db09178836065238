// A table's header line: which of its names are events, IMU samples or points, and in which units.
#pragma once

#include "core/recording/column_guess.h"
#include "core/recording/column_names.h"
#include "core/recording/text/text_columns.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// A column of numbers in the first rows.
struct TableColumn {
  ColumnNumbers numbers;
  std::vector<double> values;
  std::size_t texts = 0;  // cells that are no numbers
};

struct TableHeader {
  std::vector<std::string> names;  // as written
  std::vector<ColumnName> columns;
  bool comment = false;

  bool has(ColumnKind kind) const;
  bool namesTable() const;         // there is a time, and what an event, a sample or a point has
  std::size_t recognised() const;  // columns of a known kind
};

TableHeader readTableHeader(std::string_view line, bool comment);

// Fills in `columns`, or says in `problem` and `advice` why these names cannot be told.
void applyHeader(const TableHeader& header, std::span<const TableColumn> table, std::size_t rows,
                 TextColumns& columns);

// The session's line, and where it goes.
std::string columnsAdvice(const std::string& names);

// The unit that whole or fractional times are in: IMUs give 20 to 20 000 samples a second; of events see guessTimeUnit_ns.
std::int64_t guessUnit_ns(const TableColumn& time, StreamType type);

}  // namespace evical
