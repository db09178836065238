// A small recording of two streams, and helpers to write it and read it back.
#pragma once

#include "core/recording/recording_reader.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/recording_contents.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

namespace evical::test {

struct Recording {
  std::vector<Event> events;
  std::vector<ImuSample> imu_samples;
};

inline bool same(EventSpan a, EventSpan b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Event& left, const Event& right) {
    return left.time_ns == right.time_ns && left.x_px == right.x_px && left.y_px == right.y_px &&
           left.brighter == right.brighter;
  });
}

inline std::vector<StreamInfo> sampleStreams() {
  return {{"/dvs/events", StreamType::Events, "", {346, 260}, 0}, {"/dvs/imu", StreamType::Imu, "", {}, 0}};
}

inline Recording sampleRecording(std::size_t events, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  Recording recording;
  std::int64_t time_ns = 1'600'000'000'123'456'789;
  for (std::size_t i = 0; i < events; ++i) {
    time_ns += random() % 3000;
    recording.events.push_back({time_ns, static_cast<std::uint16_t>(random() % 346),
                                static_cast<std::uint16_t>(random() % 260), random() % 2 == 1});
    if (i % 700 != 0) continue;
    const auto value = [&random] { return 1e-9 * static_cast<double>(random()) - 2.0; };
    recording.imu_samples.push_back(
        {time_ns, {value(), value(), value()}, {value(), value(), 9.0 + value()}});
  }
  return recording;
}

// In packets of many sizes.
inline void writeAll(RecordingWriter& writer, const Recording& recording) {
  std::size_t event = 0;
  for (std::size_t i = 0; i < recording.imu_samples.size(); ++i) {
    const std::size_t count = std::min(recording.events.size() - event, std::size_t{1} + i * 97 % 2000);
    writer.write(0, EventSpan(recording.events).subspan(event, count));
    writer.write(1, std::span(recording.imu_samples).subspan(i, 1));
    event += count;
  }
  writer.write(0, EventSpan(recording.events).subspan(event));
  writer.finish();
}

inline Recording readRecording(RecordingReader& reader) {
  Recording recording;
  Packet packet;
  while (reader.read(packet)) {
    recording.events.insert(recording.events.end(), packet.events.begin(), packet.events.end());
    const StreamInfo& info = reader.streams()[packet.stream];
    toSi(packet.imu_samples, info.acceleration_unit, info.angular_rate_unit, recording.imu_samples);
  }
  return recording;
}

inline bool same(const std::vector<ImuSample>& a, const std::vector<ImuSample>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const ImuSample& left, const ImuSample& right) {
        return left.time_ns == right.time_ns && left.angular_rate_rad_s == right.angular_rate_rad_s &&
               left.specific_force_m_s2 == right.specific_force_m_s2;
      });
}

inline void writeFile(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

}  // namespace evical::test
