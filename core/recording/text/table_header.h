// A table's header line: its columns of events, IMU samples or points, and their units.
#pragma once

#include "core/recording/column_guess.h"
#include "core/recording/column_names.h"
#include "core/recording/text/text_columns.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Column in the first rows.
struct TableColumn {
  ColumnNumbers numbers;
  std::vector<double> values;           // of cells with a number
  std::vector<std::string_view> cells;  // all
};

struct TableHeader {
  std::vector<std::string> names;  // as written
  std::vector<ColumnName> columns;
  bool comment = false;

  bool has(ColumnKind kind) const;
  bool namesTable() const;         // time and all columns of an event, a sample or a point
  std::size_t recognised() const;  // columns of a known kind
};

TableHeader readTableHeader(std::string_view line, bool comment);

// Fills in `columns`, or sets `problem` and `advice` if the names are ambiguous. `sensor`: named by the
// file's name.
void applyHeader(TableHeader header, std::span<const TableColumn> table, std::size_t rows,
                 std::optional<MeasuredBy> sensor, TextColumns& columns);

// Proposed line for the session, and its place there.
std::string columnsAdvice(const std::string& names, StreamType type = StreamType::Other);

}  // namespace evical
