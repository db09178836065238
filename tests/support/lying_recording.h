// Recordings that parse but lie: a good one of a few seconds, its times and values changed as bytes say. For the fuzz
// target `calibrate`, and for a test that runs over some of its inputs.
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
  // Simulates the good one; files go to `folder`.
  explicit LyingRecording(std::filesystem::path folder);

  // Six bytes a lie, four lies at most: what, from where to where, how large, of which sign and axis.
  // Without any it is the good one.
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
