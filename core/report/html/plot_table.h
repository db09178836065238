// Data of one plot, which is drawn only from them. They are written next to the report as CSV.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace evical::html {

struct PlotTable {
  std::string file;                         // "plots/camera1_windows.csv"; without the sensor's name
  std::vector<std::string> columns;         // with units
  std::vector<std::vector<double>> values;  // by column, all of one length
  std::string label_column;                 // header of a first column of labels; empty if there is none
  std::vector<std::string> labels;

  PlotTable(std::string file_name, std::vector<std::string> column_names);
  void add(const std::vector<double>& row);
  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
};

// Values that are not finite become empty cells; labels are quoted.
std::string tableCsv(const PlotTable& table);

// Stride that shows at most `most` of `count` items.
std::size_t strideFor(std::size_t count, std::size_t most);

}  // namespace evical::html
