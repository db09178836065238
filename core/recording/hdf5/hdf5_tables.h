// Events and IMU samples of datasets in any of the known layouts.
#pragma once

#include "core/recording/hdf5/hdf5_dataset.h"

#include "core/data/event.h"
#include "core/data/imu_units.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace evical::hdf5 {

// Scale of a file's numbers to ns: whole numbers are us (ns if they are too large for that), others seconds
// (us if the span would be days).
struct TimeScale {
  void setUnit(std::int64_t stated_ns) {
    factor_ns = static_cast<double>(stated_ns);
    unit_ns = is_real ? 1 : stated_ns;
  }

  double factor_ns = 1e9;       // of real numbers
  std::int64_t unit_ns = 1000;  // of whole ones
  std::int64_t offset_ns = 0;
  bool is_real = false;
  bool convert(std::int64_t time, std::int64_t& time_ns) const;  // false for an invalid time
  bool convert(double time, std::int64_t& time_ns) const;
};

class EventTable {
 public:
  virtual ~EventTable() = default;
  virtual std::uint64_t rows() const = 0;

  // Appends some 10k events from `row` on, and returns the next row; unreadable ones are
  // skipped, and then problem() has the reason.
  virtual std::uint64_t load(std::uint64_t row, std::vector<Event>& events) = 0;

  const TimeScale& timeScale() const { return time_; }
  std::string takeProblem() { return std::exchange(problem_, {}); }
  const std::string& note() const { return note_; }  // on the interpretation; empty if it is clear

 protected:
  void noteUnpolarised(std::size_t count, std::uint64_t row);

  TimeScale time_;
  std::string problem_, note_;
};

class ImuTable {
 public:
  virtual ~ImuTable() = default;

  // The next few samples; none at the end.
  virtual void load(std::vector<RawImuSample>& samples) = 0;

  const TimeScale& timeScale() const { return time_; }
  std::string takeProblem() { return std::exchange(problem_, {}); }

 protected:
  TimeScale time_;
  std::string problem_;
};

// Lists x, y, t, p of equal length (the shortest counts), in this order.
std::unique_ptr<EventTable> openColumns(hid_t file, const std::array<DatasetInfo, 4>& columns,
                                        std::int64_t offset_us, const std::string& place,
                                        std::optional<std::int64_t> unit_ns = {});
// Error: the four columns cannot be identified.
class UnknownColumns : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Rows x, y, t, p, or t, x, y, p, as the numbers show. Throws UnknownColumns if they are not
// events.
std::unique_ptr<EventTable> openEventRows(hid_t file, const DatasetInfo& table, const std::string& place);
// Metavision's layout: a compound of x, y, p, t.
std::unique_ptr<EventTable> openCompound(hid_t file, const DatasetInfo& list, const std::string& place);

// t; angular rate (rad/s) and acceleration (m/s^2) as rows of three.
std::unique_ptr<ImuTable> openImuColumns(hid_t file, const DatasetInfo& times, const DatasetInfo& rates,
                                         const DatasetInfo& accelerations, const std::string& place,
                                         std::optional<std::int64_t> unit_ns = {});
// t; rows of six. Gravity determines which three are the acceleration.
std::unique_ptr<ImuTable> openImuRows(hid_t file, const DatasetInfo& times, const DatasetInfo& rows,
                                      const std::string& place);
// TUM-VIE's imu_data.txt: t in us, angular rate, acceleration, temperature.
std::unique_ptr<ImuTable> openImuText(const std::filesystem::path& path);

}  // namespace evical::hdf5

// A column of times, of whole numbers or real ones.

namespace evical::hdf5 {

class Times {
 public:
  // Writes the type of its numbers to `time`.
  Times(hid_t file, const DatasetInfo& info, TimeScale& time, const std::string& place) {
    constexpr std::int64_t kNanoseconds = 100'000'000'000'000'000;
    time.is_real = info.isReal();
    if (time.is_real) {
      real_.emplace(file, info, H5T_NATIVE_DOUBLE, place);
      time.unit_ns = 1;
      return;
    }
    whole_.emplace(file, info, H5T_NATIVE_INT64, place);
    const auto first = whole_->numbersFrom(0);
    if (!first.empty() && (first[0] > kNanoseconds || first[0] < -kNanoseconds)) time.unit_ns = 1;
  }

  DatasetRows& rows() { return real_ ? static_cast<DatasetRows&>(*real_) : *whole_; }

  // Time of a row of rows().
  bool convert(std::uint64_t row, const TimeScale& time, std::int64_t& time_ns) {
    return real_ ? time.convert(real_->numbersFrom(row)[0], time_ns)
                 : time.convert(whole_->numbersFrom(row)[0], time_ns);
  }

 private:
  std::optional<Rows<std::int64_t>> whole_;
  std::optional<Rows<double>> real_;
};

}  // namespace evical::hdf5
