// Valid recordings with false contents: a good one of a few seconds, with times and values changed according
// to bytes. For the fuzz target `calibrate`, and for a test that runs over some of its inputs.
#pragma once

#include "core/data/event.h"
#include "core/data/imu_sample.h"
#include "core/pipeline/session/session.h"
#include "core/synthetic/scenario.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace evical::test {

class LyingRecording {
 public:
  // Simulates the good recording; files are written to `folder`.
  explicit LyingRecording(std::filesystem::path folder);

  // Six bytes per disturbance, four at most: kind, begin, end, size, sign and axis. Without any it is the
  // good recording.
  Session tell(std::span<const std::uint8_t> lies) const;

 private:
  struct Content {
    std::vector<Event> events;
    std::vector<ImuSample> samples;
  };
  void tellOne(std::span<const std::uint8_t> lie, Content& content) const;
  void write(Content content) const;

  std::filesystem::path folder_;
  Scenario scenario_;
  Content good_;
};

}  // namespace evical::test
