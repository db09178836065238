// A whole recording in memory, for comparisons in tests, and a scratch folder.
#pragma once

#include "core/base/progress.h"
#include "core/recording/recording_reader.h"

#include <QTemporaryDir>

#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace evical::test {

// Messages of a conversion.
class Log : public ProgressSink {
 public:
  void stageStarted(const ProgressStage& /*stage*/) override {}
  void stageProgress(double /*fraction*/) override {}
  void log(LogLevel /*level*/, std::string_view text) override { said += text; }
  std::string said;
};

struct Contents {
  std::vector<StreamInfo> streams;
  std::map<std::size_t, std::vector<Event>> events;   // by stream
  std::map<std::size_t, std::vector<ImuSample>> imu;  // in SI units
  std::map<std::size_t, std::vector<Frame>> frames;
  std::vector<RecordingFault> faults;

  std::size_t eventCount() const {
    std::size_t count = 0;
    for (const auto& [stream, list] : events) count += list.size();
    return count;
  }
  std::size_t sampleCount() const {
    std::size_t count = 0;
    for (const auto& [stream, list] : imu) count += list.size();
    return count;
  }
  std::size_t frameCount() const {
    std::size_t count = 0;
    for (const auto& [stream, list] : frames) count += list.size();
    return count;
  }
  bool hasFault(FaultKind kind) const {
    for (const RecordingFault& fault : faults)
      if (fault.kind == kind) return true;
    return false;
  }
};

inline Contents readAll(RecordingReader& reader) {
  Contents contents;
  Packet packet;
  while (reader.read(packet)) {
    std::vector<Event>& events = contents.events[packet.stream];
    events.insert(events.end(), packet.events.begin(), packet.events.end());
    const StreamInfo& info = reader.streams()[packet.stream];
    if (!packet.frames.empty()) {
      std::vector<Frame>& frames = contents.frames[packet.stream];
      frames.insert(frames.end(), packet.frames.begin(), packet.frames.end());
    }
    toSi(packet.imu_samples, info.acceleration_unit, info.angular_rate_unit, contents.imu[packet.stream]);
  }
  contents.streams = reader.streams();
  contents.faults = reader.faults();
  return contents;
}

inline Contents readAll(const std::filesystem::path& path) {
  return readAll(*openRecording(path));
}

// Also frames, which are not read by default.
inline Contents readEverything(RecordingReader& reader) {
  std::vector<std::size_t> streams;
  for (std::size_t i = 0; i < reader.streams().size(); ++i)
    if (reader.streams()[i].readable) streams.push_back(i);
  reader.select(streams);
  return readAll(reader);
}

inline Contents readEverything(const std::filesystem::path& path) {
  return readEverything(*openRecording(path));
}

class ScratchFolder {
 public:
  std::filesystem::path operator/(const std::string& name) const {
    return std::filesystem::path(directory_.path().toStdString()) / name;
  }
  std::filesystem::path path() const { return directory_.path().toStdString(); }
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((*this / name).parent_path());
    std::ofstream(*this / name, std::ios::binary) << content;
    return *this / name;
  }

 private:
  QTemporaryDir directory_;
};

inline std::string fileBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Regular events and samples that are all different: `count` events 10 us apart, samples 1 ms apart.
inline std::vector<Event> someEvents(std::size_t count, std::int64_t start_ns = 1'700'000'000'000'000'000) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < count; ++i)
    events.push_back({start_ns + static_cast<std::int64_t>(i) * 10'000,
                      static_cast<std::uint16_t>(i * 7 % 64), static_cast<std::uint16_t>(i * 3 % 48),
                      i % 3 == 0});
  return events;
}

inline std::vector<ImuSample> someSamples(std::size_t count,
                                          std::int64_t start_ns = 1'700'000'000'000'000'000) {
  std::vector<ImuSample> samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double phase = 0.05 * static_cast<double>(i);
    samples[i].time_ns = start_ns + static_cast<std::int64_t>(i) * 1'000'000;
    samples[i].angular_rate_rad_s = {std::sin(phase), std::cos(phase), std::sin(2.0 * phase)};
    samples[i].specific_force_m_s2 = {0.1 * std::cos(phase), 0.1 * std::sin(phase),
                                      9.81 + 0.1 * std::sin(phase)};
  }
  return samples;
}

// Contents of messages of 100 events per ms.
inline std::vector<Event> eventsOfMessages(std::size_t count) {
  std::vector<Event> events;
  for (const ImuSample& sample : someSamples(count)) {
    const std::vector<Event> part = someEvents(100, sample.time_ns);
    events.insert(events.end(), part.begin(), part.end());
  }
  return events;
}

inline bool sameEvents(const std::vector<Event>& a, const std::vector<Event>& b) {
  const auto same = [](const Event& p, const Event& q) {
    return p.time_ns == q.time_ns && p.x_px == q.x_px && p.y_px == q.y_px && p.brighter == q.brighter;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

inline bool sameSamples(const std::vector<ImuSample>& a, const std::vector<ImuSample>& b) {
  const auto same = [](const ImuSample& p, const ImuSample& q) {
    return p.time_ns == q.time_ns && p.angular_rate_rad_s == q.angular_rate_rad_s &&
           p.specific_force_m_s2 == q.specific_force_m_s2;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

}  // namespace evical::test
