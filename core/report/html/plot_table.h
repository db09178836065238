// The numbers behind one plot: it is drawn from nothing else, and they are written beside the report as CSV.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace evical::html {

struct PlotTable {
  std::string file;                         // "plots/camera1_windows.csv"; no sensor's name in it
  std::vector<std::string> columns;         // with units
  std::vector<std::vector<double>> values;  // by column, all of one length
  std::string label_column;                 // a first column of words; empty for none
  std::vector<std::string> labels;

  PlotTable(std::string file_name, std::vector<std::string> column_names);
  void add(const std::vector<double>& row);
  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
};

// What isn't finite is an empty cell; labels are quoted.
std::string tableCsv(const PlotTable& table);

// Of `count` things, each how many-th is shown so that at most `most` are.
std::size_t strideFor(std::size_t count, std::size_t most);

}  // namespace evical::html
