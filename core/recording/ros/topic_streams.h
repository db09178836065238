// The topics of a ROS recording as streams: which there are, and their messages decoded to packets. Shared by
// all containers, which only hand out messages; one object follows a recording's files in order.
#pragma once

#include "core/recording/recording_reader.h"
#include "core/recording/ros/event_packet_decoder.h"
#include "core/recording/ros/message_types.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

struct Topic {
  std::string name, type;
  std::string md5, definition;  // empty where the container has none
  Serialization serialization = Serialization::Ros1;
};

class TopicStreams {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  // The stream of this topic: a new one unless name and type are known, but none once looking has finished.
  std::size_t add(const Topic& topic);
  void countMessages(std::size_t stream, std::uint64_t count) { streams_[stream].messages += count; }

  // Resolution, encoding, and whether stamps are stamps, from the first messages of a stream.
  void lookInto(std::size_t stream, std::string_view message);
  bool knows(std::size_t stream) const;  // true if more messages cannot change it
  void finishLooking();                  // selects the default streams, lists triggers

  const std::vector<StreamInfo>& streams() const { return streams_; }
  void select(const std::string& path, const std::vector<std::size_t>& streams);
  bool selected(std::size_t stream) const { return stream != kNone && states_[stream].selected; }

  // Replaces the packet by the message's content, sorted; false if that is nothing. `place` is for messages:
  // the place of the message in the file.
  bool decode(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
              const std::string& place, Packet& packet);
  // Rest of a message in which time ran far back; call before the next message.
  bool handOutRest(Packet& packet);
  // Conclusions that need the whole recording.
  void finishReading();

  const std::vector<RecordingFault>& faults() const { return faults_; }
  void addFault(const std::string& stream, FaultKind kind, const std::string& text);
  void dropFaultsFrom(std::size_t count) { faults_.resize(count); }

 private:
  struct State {
    Content content = Content::Other;
    Serialization serialization = Serialization::Ros1;
    bool selected = false;
    int looked = 0;  // messages
    // Stamps in the first messages. Some zeros and nothing else mean no stamps; a single zero may be
    // intended.
    std::uint64_t zero_stamps = 0, other_stamps = 0;
    bool stampless() const { return zero_stamps > 1 && other_stamps == 0; }
    // Steps back within messages, which were sorted.
    std::uint64_t disordered = 0;
    std::int64_t largest_disorder_ns = 0;
    std::string encoding;  // of event packets and pictures, from their first message
    // Decoder of event packets.
    EventPacketDecoder decoder;
    std::optional<std::size_t> trigger_stream;
    bool refused() const;  // its encoding
    const char* readableEncodings() const;
  };

  void lookIntoPacket(std::size_t stream, std::string_view message);
  void lookIntoImage(std::size_t stream, std::string_view message);
  void listTriggers();
  bool decodeEvents(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
                    std::vector<Event>& events);
  bool decodePacket(std::size_t stream, std::string_view message, std::vector<Event>& events);
  bool decodeSamples(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
                     std::vector<RawImuSample>& samples);
  bool decodeFrame(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
                   std::vector<Frame>& frames);
  void putInOrder(std::size_t stream, std::vector<Event>& events);
  void finishEventPackets(std::size_t stream);

  std::vector<StreamInfo> streams_;
  std::vector<State> states_;  // of streams_
  std::vector<RecordingFault> faults_;
  std::vector<Event> rest_;  // of a message in which time ran far back
  std::size_t rest_stream_ = 0;
  bool listed_ = false;
};

}  // namespace evical::ros
