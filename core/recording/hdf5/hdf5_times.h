// A column of times, of whole numbers or real ones.
#pragma once

#include "core/recording/hdf5/hdf5_tables.h"

#include <cstdint>
#include <optional>
#include <string>

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
