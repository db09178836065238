// Plots as inline SVG: axes, lines, points, bars, arrows. Colours are CSS classes, so that the page defines
// light and dark. Values that are not finite or outside the range are not drawn (lines break there).
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical::html {

struct AxisRange {
  double low = 0.0, high = 1.0;
};

// Range of all finite values, with a margin on both sides; never empty.
AxisRange rangeOf(std::span<const double> values, double margin_share = 0.05);
AxisRange joined(const AxisRange& a, const AxisRange& b);

struct PlotFrame {
  std::string title;  // above the plot, and for screen readers
  std::string x_label, y_label;
  AxisRange x, y;
  double width = 860.0, height = 240.0;
  bool y_down = false;                    // image coordinates
  bool y_decades = false;                 // y is a power of ten: ticks show 10^y
  std::vector<std::string> x_names = {};  // instead of ticks, at 0.5, 1.5, ...
  bool equal_scale = false;               // one unit is as long along x as along y
};

// Axes in pixels of an image.
PlotFrame imageFrame(int width_px, int height_px, const std::string& title);

struct LegendEntry {
  std::string css_class, label;
};

class SvgPlot {
 public:
  explicit SvgPlot(PlotFrame frame);

  void line(std::span<const double> x, std::span<const double> y, std::string_view css_class);
  void points(std::span<const double> x, std::span<const double> y, std::string_view css_class,
              double diameter = 3.0);
  void bar(double x0, double x1, double y0, double y1, std::string_view css_class, double opacity = 1.0);
  void segment(double x0, double y0, double x1, double y1, std::string_view css_class);
  void arrow(double x0, double y0, double x1, double y1, std::string_view css_class);
  void circle(double x, double y, double radius, std::string_view css_class);  // radius in units of x
  void text(double x, double y, std::string_view text, std::string_view anchor = "start", double dy_px = 0.0);
  void legend(const std::vector<LegendEntry>& entries);

  std::string svg() const;  // with its title above it

 private:
  double across(double x) const;
  double down(double y) const;
  bool inside(double x, double y) const;
  std::string axes() const;

  PlotFrame frame_;
  double left_ = 70.0, right_ = 12.0, top_ = 26.0, bottom_ = 42.0;
  std::string marks_, legend_;
};

}  // namespace evical::html

// Square matrix of numbers between -1 and 1 as coloured cells; rows and columns have the same names.

namespace evical::html {

// Positive values have class "warm", negative ones "cold", with an opacity that grows with their size; each
// cell has its value as tooltip.
std::string heatMapSvg(const std::string& title, const std::vector<std::string>& names,
                       const Eigen::MatrixXd& values);

}  // namespace evical::html

// Data of one plot, which is drawn only from them. They are written next to the report as CSV.

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
