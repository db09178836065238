// The events of one topic's event_camera_msgs/EventPacket messages, in the encodings evt2, evt21, evt3, mono,
// libcaer and libcaer_cmp. Messages may continue the state of the previous one, so a decoder follows its
// topic from the start. Source: ros-event-camera/event_camera_codecs.
#pragma once

#include "core/data/event.h"
#include "core/recording/block_decoder.h"
#include "core/recording/prophesee/evt3_decoder.h"
#include "core/recording/ros/ros_messages.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

// Offset of a sensor's clock to that of the host that received its data, from stamps at the arrival of
// packets. Delays vary, so the earliest packets determine it.

// host_time = sensor_time + offset, at the middle of the recording; drift_ppm is its change.
struct HostClockOffset {
  double offset_s = 0.0;
  std::optional<double> drift_ppm;  // nullopt for short recordings
};

class HostClock {
 public:
  void add(std::int64_t sensor_ns, std::int64_t host_ns);

  // nullopt before the first packet.
  std::optional<HostClockOffset> offset() const;

 private:
  struct Earliest {
    std::int64_t sensor_ns = 0, offset_ns = 0;
  };
  std::map<std::int64_t, Earliest> earliest_;  // of some seconds each
};

enum class Encoding { Unknown, Evt2, Evt21, Evt3, Mono, Trigger, Libcaer, LibcaerCmp };
Encoding encodingOf(std::string_view name);
inline constexpr const char* kReadableEncodings = "evt2, evt21, evt3, mono, libcaer and libcaer_cmp";
inline bool isOfSensor(Encoding encoding) {
  return encoding >= Encoding::Evt2 && encoding <= Encoding::Evt3;
}

class EventPacketDecoder {
 public:
  // Appends the packet's events, in the order of the encoding. Times of evt* are the sensor's, of the others
  // the host's. False if the packet cannot be decoded: a big-endian one, an unknown encoding, an invalid time
  // base, or a fraction of an event at the end; the events before it are appended.
  bool decode(const EventPacket& packet, std::vector<Event>& events);

  std::uint64_t triggers() const {
    return triggers_ + evt3_.counts().triggers + (words_ ? words_->findings().triggers : 0);
  }
  std::uint64_t lostMessages() const { return lost_messages_; }
  std::uint64_t outside() const {  // events beyond the sensor; dropped
    return evt3_.counts().outside + (words_ ? words_->findings().outside.count : 0);
  }
  const HostClock& hostClock() const { return host_clock_; }  // of evt*
  // The encoding of the content if it is not the one that messages state; empty otherwise.
  const char* otherEncoding() const { return other_encoding_; }

 private:
  void followSequence(std::uint64_t sequence);
  void lookAtWords(const EventPacket& packet, Encoding stated);
  void decodeWords(const EventPacket& packet, std::vector<Event>& events);

  Encoding words_encoding_ = Encoding::Unknown;  // of evt*, after the first packet with events
  const char* other_encoding_ = "";
  Evt3Decoder evt3_;
  std::unique_ptr<BlockDecoder> words_;  // of evt2 and evt21
  HostClock host_clock_;
  bool has_sequence_ = false;
  std::uint64_t last_sequence_ = 0;
  std::uint64_t lost_messages_ = 0;
  std::uint64_t triggers_ = 0;  // of this encoding
};

}  // namespace evical::ros
