// Topics of a ROS recording as streams: their list, and their messages decoded to packets. Shared by
// all containers, which only return messages; one object processes a recording's files in order.
#pragma once

#include "core/recording/recording_reader.h"
#include "core/recording/ros/event_packet_decoder.h"
#include "core/recording/ros/message_types.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace evical::ros {

struct Topic {
  std::string name, type;
  std::string md5, definition;  // empty if the container has none
  Serialization serialization = Serialization::Ros1;
  std::string publisher = {};  // the node, for a topic that several publish at the same time; otherwise empty
};

class TopicStreams {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  // The stream of this topic: a new one unless name and type are known, but none after finishLooking().
  std::size_t add(const Topic& topic);
  void countMessages(std::size_t stream, std::uint64_t count) { streams_[stream].messages += count; }

  // Determines resolution, encoding, and the validity of stamps, from the first messages of a stream.
  void lookInto(std::size_t stream, std::string_view message);
  bool knows(std::size_t stream) const;  // true if more messages cannot change it
  void finishLooking();                  // selects the default streams, lists triggers

  const std::vector<StreamInfo>& streams() const { return streams_; }
  void select(const std::string& path, const std::vector<std::size_t>& streams);
  bool selected(std::size_t stream) const { return stream != kNone && states_[stream].selected; }

  // Replaces the packet by the message's content, sorted; false if it is empty. `place`: the message's
  // place in the file, for error messages.
  bool decode(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
              const std::string& place, Packet& packet);
  // Rest of a message with a large step back in time; call before the next message.
  bool handOutRest(Packet& packet);
  // Conclusions that need the whole recording.
  void finishReading();

  const std::vector<RecordingFault>& faults() const { return faults_; }
  void addFault(const std::string& stream, FaultKind kind, const std::string& text);
  void dropFaultsFrom(std::size_t count) { faults_.resize(count); }
  void dropFaults(FaultKind kind) {
    std::erase_if(faults_, [&](const RecordingFault& fault) { return fault.kind == kind; });
  }

 private:
  struct State {
    Content content = Content::Other;
    Serialization serialization = Serialization::Ros1;
    bool selected = false;
    int looked = 0;  // messages
    // Stamps in the first messages. Several zeros and nothing else mean missing stamps; a single zero may be
    // intended.
    std::uint64_t zero_stamps = 0, other_stamps = 0;
    bool stampless() const { return zero_stamps > 1 && other_stamps == 0; }
    // Steps back within messages, which were sorted.
    std::uint64_t disordered = 0;
    std::int64_t largest_disorder_ns = 0;
    // Messages that begin before the end of the one before, as those of two publishers do.
    std::uint64_t messages = 0, overlapping = 0;
    std::int64_t latest_ns = 0;
    std::string encoding;  // of event packets and pictures, from their first message
    std::string unread;    // why messages of a sensor are not read
    // Decoder of event packets.
    EventPacketDecoder decoder;
    std::optional<std::size_t> trigger_stream;
    bool refused() const;  // by its encoding
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
  bool decodeArray(std::size_t stream, std::string_view message, std::vector<Event>& events);
  void followMessage(std::size_t stream, const std::vector<Event>& events);
  std::string stepText(std::size_t stream, std::string_view message) const;
  void putInOrder(std::size_t stream, std::vector<Event>& events);
  void finishEventPackets(std::size_t stream);

  std::vector<StreamInfo> streams_;
  std::map<std::pair<std::string, std::string>, std::size_t> known_;  // streams by topic and type
  std::vector<State> states_;                                         // of streams_
  std::vector<RecordingFault> faults_;
  std::vector<Event> rest_;  // of a message with a large step back in time
  std::size_t rest_stream_ = 0;
  bool listed_ = false;
};

}  // namespace evical::ros
