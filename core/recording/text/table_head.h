// First lines of a text table: rows of numbers, and the lines above them, which may name columns or state
// scales.
#pragma once

#include "core/geometry/resolution.h"
#include "core/recording/text/table_header.h"
#include "core/recording/text/text_columns.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Multipliers of a table's raw numbers, in lines "gscale,0.001" above the header (Gyroflow's .gcsv).
struct TableScales {
  std::optional<double> time_s, rate_rad_s, acceleration_g;
  std::string orientation;  // "yxZ": the channels that are x, y and z

  bool any() const { return time_s || rate_rad_s || acceleration_g || !orientation.empty(); }
};

class TableHead {
 public:
  // `named`: the session names the columns.
  explicit TableHead(bool named) : named_(named) {}

  // `line` has its number in the file, and must outlive this object. False if the text is not a table.
  bool add(std::string_view line, std::uint64_t number);

  TextStyle style;
  std::vector<TableColumn> columns;
  std::vector<TableHeader> headers;               // lines above the rows that may name columns
  std::vector<double> first_norms, second_norms;  // of columns 1-3 and 4-6, if these exist
  std::vector<std::uint64_t> lines;               // number of each row's line
  std::size_t rows = 0;
  std::uint64_t first_row = 1;
  Resolution size_px;
  bool has_geometry = false;
  TableScales scales;
  // If there are no rows: the first line below a header of a table that is not one of numbers.
  std::vector<std::string> unread_cells;
  std::uint64_t unread_line = 0;

 private:
  bool readGeometry(std::string_view line);
  bool readSize(std::string_view line);
  bool readScale(std::string_view line);
  bool readUnits(std::string_view line);
  bool addRow(std::string_view line, std::uint64_t number);
  bool isBelowHeader() const;

  bool named_ = false;
  std::vector<std::string_view> cells_;
  std::vector<double> numbers_;
};

// A cell's number: also true and false, dates and times of day (in s). nullopt for others.
std::optional<double> cellNumber(std::string_view text, const TextStyle& style);

}  // namespace evical
