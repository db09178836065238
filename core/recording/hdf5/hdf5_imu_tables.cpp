#include "core/recording/hdf5/hdf5_tables.h"
#include "core/recording/text/text_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

namespace evical::hdf5 {
namespace {

constexpr std::size_t kTablePacketSamples = 10;
constexpr double kGravity_m_s2 = 9.80665;
constexpr std::size_t kSamplesForGravity = 1000;

// Rate and acceleration each begin at a column of a table; both may be in one table.
class ImuDatasets : public ImuTable {
 public:
  ImuDatasets(hid_t file, const DatasetInfo& times, const DatasetInfo& rates,
              const DatasetInfo* accelerations, const std::string& place,
              std::optional<std::int64_t> unit_ns = {})
      : times_(file, times, time_, place), first_(file, rates, H5T_NATIVE_DOUBLE, place) {
    if (accelerations) second_.emplace(file, *accelerations, H5T_NATIVE_DOUBLE, place);
    const std::array<std::uint64_t, 3> lengths{times_.rows().rows(), first_.rows(),
                                               second_ ? second_->rows() : first_.rows()};
    rows_ = *std::min_element(lengths.begin(), lengths.end());
    if (*std::max_element(lengths.begin(), lengths.end()) != rows_) {
      problem_ = fmt::format("times and values differ in length; the first {} rows are read", rows_);
    }
    if (!second_) findGravity();
    if (unit_ns) time_.setUnit(*unit_ns);
  }

  void load(std::vector<RawImuSample>& samples) override {
    while (row_ < rows_ && samples.size() < kTablePacketSamples) {
      if (skipDamage()) continue;
      const auto first = first_.numbersFrom(row_);
      const double* rate = first.data() + rate_column_;
      const double* acceleration =
          second_ ? second_->numbersFrom(row_).data() : first.data() + 3 - rate_column_;
      RawImuSample sample;
      sample.angular_rate = Eigen::Vector3d(rate[0], rate[1], rate[2]);
      sample.specific_force = Eigen::Vector3d(acceleration[0], acceleration[1], acceleration[2]);
      const bool good = times_.convert(row_, time_, sample.time_ns) && sample.angular_rate.allFinite() &&
                        sample.specific_force.allFinite();
      if (good) samples.push_back(sample);
      if (!good) problem_ = fmt::format("row {} of the IMU has invalid numbers", row_);
      ++row_;
    }
  }

 private:
  bool skipDamage() {
    for (DatasetRows* rows : {&times_.rows(), static_cast<DatasetRows*>(&first_),
                              static_cast<DatasetRows*>(second_ ? &*second_ : &first_)}) {
      if (!rows->from(row_).empty()) continue;
      problem_ = rows->problem();
      row_ = rows->blockEnd(row_);
      return true;
    }
    return false;
  }

  // The three columns with a norm closer to gravity's are the acceleration.
  void findGravity() {
    const auto values = first_.numbersFrom(0);
    double error_first = 0.0, error_second = 0.0;
    for (std::size_t i = 0; i < std::min(values.size() / 6, kSamplesForGravity); ++i) {
      const double* row = values.data() + 6 * i;
      error_first += std::abs(std::hypot(row[0], row[1], row[2]) - kGravity_m_s2);
      error_second += std::abs(std::hypot(row[3], row[4], row[5]) - kGravity_m_s2);
    }
    rate_column_ = error_first <= error_second ? 3 : 0;
  }

  Times times_;
  Rows<double> first_;
  std::optional<Rows<double>> second_;
  std::uint64_t rows_ = 0, row_ = 0;
  std::size_t rate_column_ = 0;
};

// TUM-VIE's table. Only empty lines, comments and a first line with names are not rows.
class ImuText : public ImuTable {
 public:
  explicit ImuText(const std::filesystem::path& path) : lines_(path) {}

  void load(std::vector<RawImuSample>& samples) override {
    std::string_view line;
    while (samples.size() < kTablePacketSamples && lines_.next(line)) {
      RawImuSample sample;
      if (parse(line, sample)) {
        samples.push_back(sample);
      } else if (!isNoRow(line)) {
        problem_ =
            fmt::format("line {} of the IMU's text is not \"t gyro acc temperature\"", lines_.number());
      }
    }
  }

 private:
  bool isNoRow(std::string_view line) const {
    const std::string_view first = takeColumn(line);
    const bool is_name = !first.empty() && std::isalpha(static_cast<unsigned char>(first.front())) != 0;
    return first.empty() || first.front() == '#' || (lines_.number() == 1 && is_name);
  }

  // Numbers separated by blanks or commas. Lost disk blocks are zeros at a line's end.
  static bool parse(std::string_view line, RawImuSample& sample) {
    if (line.find('\0') != std::string_view::npos) return false;
    std::array<double, 7> values{};
    for (double& value : values)
      if (!parseNumber(takeColumn(line), value)) return false;
    TimeScale us;
    us.factor_ns = 1000.0;
    sample.angular_rate = Eigen::Vector3d(values[1], values[2], values[3]);
    sample.specific_force = Eigen::Vector3d(values[4], values[5], values[6]);
    return us.convert(values[0], sample.time_ns);
  }

  TextLines lines_;
};

}  // namespace

std::unique_ptr<ImuTable> openImuColumns(hid_t file, const DatasetInfo& times, const DatasetInfo& rates,
                                         const DatasetInfo& accelerations, const std::string& place,
                                         std::optional<std::int64_t> unit_ns) {
  return std::make_unique<ImuDatasets>(file, times, rates, &accelerations, place, unit_ns);
}

std::unique_ptr<ImuTable> openImuRows(hid_t file, const DatasetInfo& times, const DatasetInfo& rows,
                                      const std::string& place) {
  return std::make_unique<ImuDatasets>(file, times, rows, nullptr, place);
}

std::unique_ptr<ImuTable> openImuText(const std::filesystem::path& path) {
  return std::make_unique<ImuText>(path);
}

}  // namespace evical::hdf5
