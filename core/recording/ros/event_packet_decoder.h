// The events of one topic's event_camera_msgs/EventPacket messages, in the encodings evt3, mono, libcaer and
// libcaer_cmp. Messages may continue the state of the previous one, so a decoder follows its topic from the
// start. Source: ros-event-camera/event_camera_codecs.
#pragma once

#include "core/data/event.h"
#include "core/recording/prophesee/evt3_decoder.h"
#include "core/recording/ros/host_clock.h"
#include "core/recording/ros/ros_messages.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

enum class Encoding { Unknown, Evt3, Mono, Trigger, Libcaer, LibcaerCmp };
Encoding encodingOf(std::string_view name);
inline constexpr const char* kReadableEncodings = "evt3, mono, libcaer and libcaer_cmp";

class EventPacketDecoder {
 public:
  // Appends the packet's events, in the order of the encoding. Times of evt3 are the sensor's, of the others
  // the host's. False if the packet cannot be decoded: a big-endian one, an unknown encoding, an invalid time
  // base, or a fraction of an event at the end; the events before it are appended.
  bool decode(const EventPacket& packet, std::vector<Event>& events);

  std::uint64_t triggers() const { return triggers_ + evt3_.counts().triggers; }
  std::uint64_t lostMessages() const { return lost_messages_; }
  const Evt3Counts& evt3Counts() const { return evt3_.counts(); }
  const HostClock& hostClock() const { return host_clock_; }  // of evt3

 private:
  void followSequence(std::uint64_t sequence);
  void decodeEvt3(const EventPacket& packet, std::vector<Event>& events);

  Evt3Decoder evt3_;
  HostClock host_clock_;
  bool has_sequence_ = false;
  std::uint64_t last_sequence_ = 0;
  std::uint64_t lost_messages_ = 0;
  std::uint64_t triggers_ = 0;  // of this encoding
};

}  // namespace evical::ros
