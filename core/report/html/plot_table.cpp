#include "core/report/html/plot_table.h"

#include "core/report/csv_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace evical::html {
PlotTable::PlotTable(std::string file_name, std::vector<std::string> column_names)
    : file(std::move(file_name)), columns(std::move(column_names)), values(columns.size()) {}

void PlotTable::add(const std::vector<double>& row) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i].push_back(row.at(i));
}

std::string tableCsv(const PlotTable& table) {
  std::string text = table.label_column;
  for (const std::string& column : table.columns) text += (text.empty() ? "" : ",") + column;
  text += "\n";
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!table.label_column.empty()) text += quotedCsv(table.labels.at(row)) + ",";
    for (std::size_t col = 0; col < table.values.size(); ++col) {
      if (col > 0) text += ",";
      const double value = table.values[col][row];
      if (std::isfinite(value)) fmt::format_to(std::back_inserter(text), "{:.9g}", value);
    }
    text += "\n";
  }
  return text;
}

std::size_t strideFor(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / most);
}

}  // namespace evical::html
