// IMU samples that a driver stamped on arrival, several at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace evical {

struct StampBatches {
  std::size_t samples = 0;  // of a batch, about
  double interval_s = 0.0;  // between its samples
  double pause_s = 0.0;     // between batches, without samples

  std::string text() const;  // "samples are stamped in batches of about 10, ..."
};

// nullopt for samples that are stamped one by one.
std::optional<StampBatches> findStampBatches(std::span<const std::int64_t> times_ns);

}  // namespace evical
