#include "core/report/html/svg_plot.h"

#include "core/report/html/html_text.h"

#include "core/report/csv_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace evical::html {
namespace {

constexpr double kLetter_px = 7.0;  // mean width of a letter of the plots' font size

// Round steps of 1, 2 or 5 that give about `count` ticks.
std::vector<double> ticks(const AxisRange& range, double count) {
  const double raw = (range.high - range.low) / std::max(1.0, count);
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double share = raw / decade;
  const double step = decade * (share <= 1.0 ? 1.0 : share <= 2.0 ? 2.0 : share <= 5.0 ? 5.0 : 10.0);
  std::vector<double> places;
  for (double k = std::ceil(range.low / step - 1e-9); k * step <= range.high + 1e-9 * step; k += 1.0)
    places.push_back(k * step);
  return places;
}

std::string tickText(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  if (std::abs(value) >= 1e5 || step < 1e-4) return significant(value, 2);
  return number(value, std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 4));
}

}  // namespace

AxisRange rangeOf(std::span<const double> values, double margin_share) {
  AxisRange range{1e300, -1e300};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  if (range.low > range.high) return {};
  const double size = range.high - range.low;
  const double margin = size > 0.0 ? margin_share * size : std::max(1e-6, 0.1 * std::abs(range.high));
  return {range.low - margin, range.high + margin};
}

AxisRange joined(const AxisRange& a, const AxisRange& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

PlotFrame imageFrame(int width_px, int height_px, const std::string& title) {
  PlotFrame frame;
  frame.title = title;
  frame.x_label = "x [px]";
  frame.y_label = "y [px]";
  frame.x = {0.0, static_cast<double>(width_px)};
  frame.y = {0.0, static_cast<double>(height_px)};
  frame.y_down = true;
  frame.width = 420.0;
  frame.height = std::clamp(68.0 + 346.0 * height_px / std::max(1, width_px), 160.0, 420.0);
  return frame;
}

SvgPlot::SvgPlot(PlotFrame frame) : frame_(std::move(frame)) {
  if (!(frame_.x.high > frame_.x.low)) frame_.x = {frame_.x.low - 0.5, frame_.x.low + 0.5};
  if (!(frame_.y.high > frame_.y.low)) frame_.y = {frame_.y.low - 0.5, frame_.y.low + 0.5};
  if (!frame_.equal_scale) return;
  const double wide = frame_.width - left_ - right_, high = frame_.height - top_ - bottom_;
  const double unit = std::max((frame_.x.high - frame_.x.low) / wide, (frame_.y.high - frame_.y.low) / high);
  const auto widen = [unit](AxisRange& range, double pixels) {
    const double middle = 0.5 * (range.low + range.high);
    range = {middle - 0.5 * unit * pixels, middle + 0.5 * unit * pixels};
  };
  widen(frame_.x, wide);
  widen(frame_.y, high);
}

double SvgPlot::across(double x) const {
  const double share = (x - frame_.x.low) / (frame_.x.high - frame_.x.low);
  return left_ + share * (frame_.width - left_ - right_);
}

double SvgPlot::down(double y) const {
  const double share = (y - frame_.y.low) / (frame_.y.high - frame_.y.low);
  return top_ + (frame_.y_down ? share : 1.0 - share) * (frame_.height - top_ - bottom_);
}

bool SvgPlot::inside(double x, double y) const {
  return x >= frame_.x.low && x <= frame_.x.high && y >= frame_.y.low && y <= frame_.y.high;
}

void SvgPlot::line(std::span<const double> x, std::span<const double> y, std::string_view css_class) {
  std::string path;
  bool pen_down = false;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i]) || x[i] < frame_.x.low || x[i] > frame_.x.high) {
      pen_down = false;
      continue;
    }
    const double level = std::clamp(y[i], frame_.y.low, frame_.y.high);
    fmt::format_to(std::back_inserter(path), "{}{:.1f} {:.1f}", pen_down ? "L" : "M", across(x[i]),
                   down(level));
    pen_down = true;
  }
  if (!path.empty()) marks_ += fmt::format("<path class=\"line {}\" d=\"{}\"/>\n", css_class, path);
}

void SvgPlot::points(std::span<const double> x, std::span<const double> y, std::string_view css_class,
                     double diameter) {
  std::string path;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (inside(x[i], y[i]))
      fmt::format_to(std::back_inserter(path), "M{:.1f} {:.1f}h0", across(x[i]), down(y[i]));
  }
  if (!path.empty())
    marks_ += fmt::format("<path class=\"dots {}\" stroke-width=\"{:.1f}\" d=\"{}\"/>\n", css_class, diameter,
                          path);
}

void SvgPlot::bar(double x0, double x1, double y0, double y1, std::string_view css_class, double opacity) {
  if (!std::isfinite(x0 + x1 + y0 + y1)) return;
  const auto bounded = [](double value, const AxisRange& range) {
    return std::clamp(value, range.low, range.high);
  };
  const double a = across(bounded(x0, frame_.x)), b = across(bounded(x1, frame_.x));
  const double c = down(bounded(y0, frame_.y)), d = down(bounded(y1, frame_.y));
  marks_ += fmt::format(
      "<rect class=\"fill {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.2f}\"{}/>\n", css_class,
      std::min(a, b), std::min(c, d), std::abs(b - a), std::abs(d - c),
      opacity < 1.0 ? fmt::format(" fill-opacity=\"{:.2f}\"", opacity) : "");
}

void SvgPlot::segment(double x0, double y0, double x1, double y1, std::string_view css_class) {
  if (!std::isfinite(x0 + x1 + y0 + y1)) return;
  marks_ += fmt::format("<path class=\"line {}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", css_class,
                        across(x0), down(y0), across(x1), down(y1));
}

void SvgPlot::arrow(double x0, double y0, double x1, double y1, std::string_view css_class) {
  if (!std::isfinite(x0 + x1 + y0 + y1)) return;
  const double ax = across(x0), ay = down(y0), bx = across(x1), by = down(y1);
  const double length = std::hypot(bx - ax, by - ay);
  if (length < 0.5) return;
  const double head = std::min(7.0, 0.5 * length), ux = (bx - ax) / length, uy = (by - ay) / length;
  marks_ += fmt::format(
      "<path class=\"line {}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} "
      "{:.1f}\"/>\n",
      css_class, ax, ay, bx, by, bx - head * (ux + 0.5 * uy), by - head * (uy - 0.5 * ux), bx, by,
      bx - head * (ux - 0.5 * uy), by - head * (uy + 0.5 * ux));
}

void SvgPlot::circle(double x, double y, double radius, std::string_view css_class) {
  if (!std::isfinite(x + y + radius)) return;
  marks_ += fmt::format("<circle class=\"line {}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>\n", css_class,
                        across(x), down(y), across(x + radius) - across(x));
}

void SvgPlot::text(double x, double y, std::string_view text, std::string_view anchor, double dy_px) {
  if (!std::isfinite(x + y)) return;
  marks_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", across(x),
                        down(y) + dy_px, anchor, escaped(text));
}

void SvgPlot::legend(const std::vector<LegendEntry>& entries) {
  double at = left_;
  for (const LegendEntry& entry : entries) {
    legend_ += fmt::format(
        "<rect class=\"fill {}\" x=\"{:.1f}\" y=\"6\" width=\"12\" height=\"10\"/><text x=\"{:.1f}\" "
        "y=\"15\">{}</text>\n",
        entry.css_class, at, at + 17.0, escaped(entry.label));
    at += 34.0 + kLetter_px * static_cast<double>(entry.label.size());
  }
}

std::string SvgPlot::axes() const {
  constexpr double kPixelsPerTickX = 62.0, kPixelsPerTickY = 36.0;
  const double bottom = frame_.height - bottom_, right = frame_.width - right_;
  std::string grid, labels;
  for (std::size_t k = 0; k < frame_.x_names.size(); ++k)
    labels += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                          across(static_cast<double>(k) + 0.5), bottom + 15.0, escaped(frame_.x_names[k]));
  const std::vector<double> xs =
      frame_.x_names.empty() ? ticks(frame_.x, (right - left_) / kPixelsPerTickX) : std::vector<double>{};
  const double x_step = xs.size() > 1 ? xs[1] - xs[0] : 1.0;
  for (const double x : xs) {
    grid += fmt::format("M{:.1f} {:.1f}V{:.1f}", across(x), top_, bottom);
    labels += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", across(x),
                          bottom + 15.0, tickText(x, x_step));
  }
  const std::vector<double> ys = ticks(frame_.y, (bottom - top_) / kPixelsPerTickY);
  const double y_step = ys.size() > 1 ? ys[1] - ys[0] : 1.0;
  for (const double y : ys) {
    grid += fmt::format("M{:.1f} {:.1f}H{:.1f}", left_, down(y), right);
    labels += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left_ - 6.0,
                          down(y) + 4.0, frame_.y_decades ? plain(std::pow(10.0, y)) : tickText(y, y_step));
  }
  return fmt::format(
      "<path class=\"grid\" d=\"{0}\"/>\n<rect class=\"frame\" x=\"{1:.1f}\" y=\"{2:.1f}\" width=\"{3:.1f}\" "
      "height=\"{4:.1f}\"/>\n{5}<text x=\"{6:.1f}\" y=\"{7:.1f}\" text-anchor=\"middle\">{8}</text>\n"
      "<text transform=\"translate(13 {9:.1f}) rotate(-90)\" text-anchor=\"middle\">{10}</text>\n",
      grid, left_, top_, right - left_, bottom - top_, labels, 0.5 * (left_ + right), frame_.height - 7.0,
      escaped(frame_.x_label), 0.5 * (top_ + bottom), escaped(frame_.y_label));
}

std::string SvgPlot::svg() const {
  return plotTitle(frame_.title) +
         fmt::format(
             "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
             "aria-label=\"{2}\">\n{3}{4}{5}</svg>\n",
             frame_.width, frame_.height, escaped(frame_.title), axes(), marks_, legend_);
}

}  // namespace evical::html

namespace evical::html {

std::string heatMapSvg(const std::string& title, const std::vector<std::string>& names,
                       const Eigen::MatrixXd& values) {
  constexpr double kLargest_px = 860.0, kLetter_px = 7.2;
  const auto count = static_cast<double>(names.size());
  std::size_t longest = 0;
  for (const std::string& name : names) longest = std::max(longest, name.size());
  const double left = std::min(340.0, kLetter_px * static_cast<double>(longest) + 34.0), top = 8.0;
  const double cell = std::clamp((kLargest_px - left - 24.0) / count, 6.0, 22.0);
  const double width = left + cell * count + 24.0, height = top + cell * count + 26.0;
  std::string text =
      plotTitle(title) +
      fmt::format(
          "<svg viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
          "aria-label=\"{2}\">\n",
          width, height, escaped(title));
  for (std::size_t row = 0; row < names.size(); ++row) {
    const double y = top + cell * static_cast<double>(row);
    text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{} {}</text>\n", left - 5.0,
                        y + 0.5 * cell + 4.0, escaped(names[row]), row + 1);
    if (cell > 14.0 || row % 5 == 4)
      text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                          left + cell * (static_cast<double>(row) + 0.5), height - 8.0, row + 1);
    for (std::size_t col = 0; col < names.size(); ++col) {
      const double value = values(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(col));
      if (!std::isfinite(value) || std::abs(value) < 0.02) continue;
      text += fmt::format(
          "<rect class=\"fill {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
          "fill-opacity=\"{:.2f}\"><title>{} / {}: {}</title></rect>\n",
          value > 0.0 ? "warm" : "cold", left + cell * static_cast<double>(col), y, cell - 0.5, cell - 0.5,
          std::min(1.0, std::abs(value)), escaped(names[row]), escaped(names[col]), number(value, 2));
    }
  }
  return text + fmt::format(
                    "<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                    "height=\"{:.1f}\"/>\n</svg>\n",
                    left, top, cell * count, cell * count);
}

}  // namespace evical::html

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
