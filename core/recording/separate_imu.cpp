#include "core/recording/separate_imu.h"

#include "core/base/time.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

namespace evical {
namespace {

// Most samples that wait for the other sensor. If there are more, its stream is elsewhere in the file or has
// ended.
constexpr std::size_t kMaxWaiting = std::size_t{1} << 20;
constexpr std::size_t kPacket_samples = 256;

// Samples of one sensor: those that wait, and the last one that was returned.
struct Half {
  std::deque<RawImuSample> waiting;
  std::optional<RawImuSample> last;

  // Interpolated from the samples before and after.
  Eigen::Vector3d at(std::int64_t time_ns, Eigen::Vector3d RawImuSample::*value) const {
    if (!last && waiting.empty()) return Eigen::Vector3d::Zero();
    if (!last) return waiting.front().*value;
    if (waiting.empty() || !(waiting.front().*value).allFinite()) return *last.*value;
    if (!(*last.*value).allFinite()) return waiting.front().*value;
    const double span_s = secondsSince(last->time_ns, waiting.front().time_ns);
    const double part =
        span_s > 0.0 ? std::clamp(secondsSince(last->time_ns, time_ns) / span_s, 0.0, 1.0) : 1.0;
    return (1.0 - part) * (*last.*value) + part * (waiting.front().*value);
  }
  RawImuSample take() {
    last = waiting.front();
    waiting.pop_front();
    return *last;
  }
};

// Samples of both sensors, ordered by time.
class JoinedHalves {
 public:
  void addRates(const std::vector<RawImuSample>& samples) {
    for (const RawImuSample& sample : samples) rates_.waiting.push_back(sample);
  }
  void addForces(const std::vector<RawImuSample>& samples) {
    for (const RawImuSample& sample : samples) forces_.waiting.push_back(sample);
  }
  // Samples of a stream with both sensors.
  void addAlternating(const std::vector<RawImuSample>& samples) {
    for (const RawImuSample& sample : samples) {
      const bool no_rate = lacksRate(sample), no_force = lacksForce(sample);
      if (!no_rate) rates_.waiting.push_back(sample);
      if (!no_force) forces_.waiting.push_back(sample);
    }
  }
  void finish() { finished_ = true; }

  // Returns the next sample whose order is certain, or false if there is none.
  bool take(std::vector<RawImuSample>& samples) {
    samples.clear();
    while (samples.size() < kPacket_samples && isCertain()) samples.push_back(next());
    return !samples.empty();
  }

 private:
  bool isCertain() const {
    const std::size_t rates = rates_.waiting.size(), forces = forces_.waiting.size();
    if (rates > 0 && forces > 0) return true;
    return rates + forces > (finished_ ? 0 : kMaxWaiting);
  }

  RawImuSample next() {
    const bool rate = !rates_.waiting.empty(), force = !forces_.waiting.empty();
    const std::int64_t rate_ns = rate ? rates_.waiting.front().time_ns : 0,
                       force_ns = force ? forces_.waiting.front().time_ns : 0;
    RawImuSample sample;
    if (rate && force && rate_ns == force_ns) {
      sample = rates_.take();
      sample.specific_force = forces_.take().specific_force;
      sample.measured_by = MeasuredBy::Both;
    } else if (rate && (!force || rate_ns < force_ns)) {
      sample = rates_.take();
      sample.specific_force = forces_.at(sample.time_ns, &RawImuSample::specific_force);
      sample.measured_by = MeasuredBy::Gyroscope;
    } else {
      sample = forces_.take();
      sample.angular_rate = rates_.at(sample.time_ns, &RawImuSample::angular_rate);
      sample.measured_by = MeasuredBy::Accelerometer;
    }
    return sample;
  }

  Half rates_, forces_;
  bool finished_ = false;
};

class SeparateImuReader : public RecordingReader {
 public:
  SeparateImuReader(std::unique_ptr<RecordingReader> reader, const std::vector<SeparateImu>& imus)
      : reader_(std::move(reader)) {
    for (const SeparateImu& imu : imus)
      imus_.push_back({nameOf(imu),
                       findStream(*reader_, imu.gyroscope, StreamType::Imu),
                       findStream(*reader_, imu.accelerometer, StreamType::Imu),
                       false,
                       {}});
    takeStreams();
    plain_.assign(reader_->streams().size(), false);
  }

  const std::vector<StreamInfo>& streams() const override { return streams_; }

  void select(const std::vector<std::size_t>& streams) override {
    plain_.assign(reader_->streams().size(), false);
    for (Joined& imu : imus_) imu.wanted = false;
    std::vector<std::size_t> own;
    for (const std::size_t stream : streams) {
      static_cast<void>(streams_.at(stream));  // throws for a wrong index, which is a bug in the caller
      if (stream < plain_.size()) {
        plain_[stream] = true;
        own.push_back(stream);
        continue;
      }
      Joined& imu = imus_[stream - plain_.size()];
      imu.wanted = true;
      own.insert(own.end(), {imu.gyroscope, imu.accelerometer});
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    reader_->select(own);
  }

  bool read(Packet& packet) override {
    for (;;) {
      if (takeJoined(packet)) return true;
      if (finished_) return false;
      finished_ = !reader_->read(packet);
      takeStreams();
      if (finished_) {
        for (Joined& imu : imus_) imu.halves.finish();
        continue;
      }
      add(packet);
      if (plain_[packet.stream]) return true;
    }
  }

  bool follow(const std::shared_ptr<Growth>& growth) override { return reader_->follow(growth); }
  double fractionRead() const override { return reader_->fractionRead(); }
  const std::vector<RecordingFault>& faults() const override { return reader_->faults(); }
  std::string format() const override { return reader_->format(); }

 private:
  struct Joined {
    std::string name;
    std::size_t gyroscope = 0, accelerometer = 0;  // streams of the recording
    bool wanted = false;
    JoinedHalves halves;
  };

  // Some properties of streams are known only while they are read.
  void takeStreams() {
    streams_ = reader_->streams();
    for (const Joined& imu : imus_) {
      StreamInfo info = reader_->streams()[imu.gyroscope];
      const StreamInfo& accelerometer = reader_->streams()[imu.accelerometer];
      info.name = imu.name;
      info.acceleration_unit = accelerometer.acceleration_unit;
      if (imu.accelerometer != imu.gyroscope) info.messages += accelerometer.messages;
      streams_.push_back(std::move(info));
    }
  }

  void add(const Packet& packet) {
    for (Joined& imu : imus_) {
      if (!imu.wanted) continue;
      if (imu.gyroscope == imu.accelerometer) {
        if (packet.stream == imu.gyroscope) imu.halves.addAlternating(packet.imu_samples);
      } else if (packet.stream == imu.gyroscope) {
        imu.halves.addRates(packet.imu_samples);
      } else if (packet.stream == imu.accelerometer) {
        imu.halves.addForces(packet.imu_samples);
      }
    }
  }

  bool takeJoined(Packet& packet) {
    for (std::size_t i = 0; i < imus_.size(); ++i) {
      if (!imus_[i].wanted || !imus_[i].halves.take(joined_)) continue;
      packet.clear();
      packet.stream = plain_.size() + i;
      packet.imu_samples.swap(joined_);
      return true;
    }
    return false;
  }

  std::unique_ptr<RecordingReader> reader_;
  std::vector<Joined> imus_;
  std::vector<StreamInfo> streams_;
  std::vector<bool> plain_;  // per stream of the recording: not joined
  std::vector<RawImuSample> joined_;
  bool finished_ = false;
};

}  // namespace

std::string nameOf(const SeparateImu& imu) {
  return imu.gyroscope + " + " + imu.accelerometer;
}

std::unique_ptr<RecordingReader> withSeparateImus(std::unique_ptr<RecordingReader> reader,
                                                  const std::vector<SeparateImu>& imus) {
  if (imus.empty()) return reader;
  return std::make_unique<SeparateImuReader>(std::move(reader), imus);
}

}  // namespace evical
