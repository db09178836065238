#include "core/recording/ros/topic_streams.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/recording/block_reader.h"
#include "core/recording/ros/image_messages.h"
#include "core/recording/ros/ros_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical::ros {
namespace {

constexpr int kEnoughMessages = 50;
constexpr std::uint64_t kEnoughStamps = 1000;

bool parse(Content content, std::string_view message, Serialization serialization, ImageMessage& image) {
  return content == Content::Image ? parseImage(message, serialization, image)
                                   : parsePackedImage(message, serialization, image);
}

bool isReadable(Content content, std::string_view encoding) {
  return content == Content::Image ? isReadableImage(encoding) : isReadablePackedImage(encoding);
}

}  // namespace

// The reason if a picture is damaged by its step.
std::string TopicStreams::stepText(std::size_t stream, std::string_view message) const {
  ImageMessage image;
  if (states_[stream].content != Content::Image || !parseImage(message, states_[stream].serialization, image))
    return {};
  const std::optional<WrongStep> wrong = wrongStep(image);
  return wrong ? fmt::format(" (its step is {} bytes, but a row of {} has {})", wrong->step_bytes,
                             image.encoding, wrong->needed_bytes)
               : std::string();
}

bool TopicStreams::State::refused() const {
  if (encoding.empty()) return false;
  if (content == Content::EventPacket) return encodingOf(encoding) == Encoding::Unknown;
  return (content == Content::Image || content == Content::PackedImage) && !isReadable(content, encoding);
}

const char* TopicStreams::State::readableEncodings() const {
  if (content == Content::Image) return kReadableImages;
  return content == Content::PackedImage ? kReadablePackedImages : kReadableEncodings;
}

std::size_t TopicStreams::add(const Topic& topic) {
  const std::string name = topic.publisher.empty() ? topic.name : topic.name + " of " + topic.publisher;
  const auto found = known_.find({name, topic.type});
  if (found != known_.end()) return found->second;
  if (listed_) return kNone;
  const std::size_t index = streams_.size();
  known_[{name, topic.type}] = index;
  State state;
  state.content = contentOf(topic.type, topic.md5, topic.definition);
  state.serialization = topic.serialization;
  StreamInfo stream;
  stream.name = name;
  stream.message = topic.type;
  stream.type = streamTypeOf(state.content);
  if (state.content == Content::Other) state.unread = whyUnread(topic.name, topic.type, topic.definition);
  if (!topic.publisher.empty())
    addFault(name, FaultKind::Metadata,
             fmt::format("Several nodes publish on {} at the same time; {} is a separate stream.", topic.name,
                         name));
  streams_.push_back(std::move(stream));
  states_.push_back(std::move(state));
  return index;
}

void TopicStreams::lookInto(std::size_t stream, std::string_view message) {
  if (knows(stream)) return;
  State& state = states_[stream];
  StreamInfo& info = streams_[stream];
  ++state.looked;
  const auto count = [&state](std::int64_t time_ns) {
    (time_ns == 0 ? state.zero_stamps : state.other_stamps) += 1;
  };
  if (state.content == Content::EventArray || state.content == Content::OldEventArray) {
    std::vector<Event> events;
    decodeArray(stream, message, events);
    for (const Event& event : events) count(event.time_ns);
  } else if (state.content == Content::Imu) {
    std::vector<RawImuSample> samples;
    decodeImu(message, state.serialization, samples);
    for (const RawImuSample& sample : samples) count(sample.time_ns);
  } else if (info.type == StreamType::Frames) {
    lookIntoImage(stream, message);
  } else if (state.content == Content::EventPacket) {
    lookIntoPacket(stream, message);
  }
}

void TopicStreams::lookIntoPacket(std::size_t stream, std::string_view message) {
  State& state = states_[stream];
  EventPacket packet;
  if (!parseEventPacket(message, state.serialization, packet)) return;
  if (packet.resolution_px.known()) streams_[stream].resolution_px = packet.resolution_px;
  if (state.encoding.empty()) state.encoding = packet.encoding;
  std::vector<Event> events;
  EventPacketDecoder decoder;
  decoder.decode(packet, events);
  if (const auto offset = decoder.hostClock().offset(); offset && !streams_[stream].host_clock_offset_s)
    streams_[stream].host_clock_offset_s = offset->offset_s;
}

void TopicStreams::lookIntoImage(std::size_t stream, std::string_view message) {
  State& state = states_[stream];
  ImageMessage image;
  if (!parse(state.content, message, state.serialization, image)) return;
  if (image.size_px.known()) streams_[stream].resolution_px = image.size_px;
  if (state.encoding.empty()) state.encoding = image.encoding;
  (image.stamp_ns == 0 ? state.zero_stamps : state.other_stamps) += 1;
}

bool TopicStreams::knows(std::size_t stream) const {
  const State& state = states_[stream];
  const bool sized = streams_[stream].resolution_px.known();
  if (state.looked >= kEnoughMessages) return true;
  switch (state.content) {
    case Content::Other:
      return true;
    case Content::OldEventArray:
      return state.other_stamps > 0;
    case Content::EventArray:
      return state.other_stamps > 0 && (sized || state.other_stamps > kEnoughStamps);
    case Content::Imu:
      return state.other_stamps > 0;
    case Content::Image:
    case Content::PackedImage:
      return state.other_stamps > 0 || state.stampless();
    case Content::EventPacket:
      break;
  }
  return state.refused() || (sized && state.looked >= 3);
}

void TopicStreams::finishLooking() {
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    State& state = states_[i];
    StreamInfo& info = streams_[i];
    const Encoding encoding = encodingOf(state.encoding);
    if (encoding == Encoding::Trigger) info.type = StreamType::Triggers;
    info.readable = info.type != StreamType::Triggers && info.type != StreamType::Other && !state.refused();
    state.selected = info.readable && info.type != StreamType::Frames;
    if (!state.unread.empty()) addFault(info.name, FaultKind::Unreadable, state.unread);
    if (state.stampless())
      addFault(info.name, FaultKind::NoStamps,
               "Stamps are 0; the times of recording are used, which have a jitter of some ms.");
    if (state.refused()) {
      addFault(info.name, FaultKind::Encoding,
               fmt::format("The encoding \"{}\" cannot be read; use {}.", state.encoding,
                           state.readableEncodings()));
    }
    if (encoding == Encoding::LibcaerCmp) {
      addFault(info.name, FaultKind::Encoding,
               "The encoding libcaer_cmp is lossy: drivers write some rows with errors of up to 7 px, and "
               "times that wrap at 65.5 ms in long messages. Record with the encoding libcaer.");
    }
  }
  listTriggers();
  listed_ = true;
}

// Separate streams, after all topics, as in RAW files, for every topic that may have triggers: a pin may be
// pulsed at any time, perhaps only at the end.
void TopicStreams::listTriggers() {
  for (std::size_t i = 0, topics = streams_.size(); i < topics; ++i) {
    if (!isOfSensor(encodingOf(states_[i].encoding)) || streams_[i].type != StreamType::Events) continue;
    StreamInfo triggers;
    triggers.name = streams_[i].name + "/triggers";
    triggers.type = StreamType::Triggers;
    triggers.readable = false;
    triggers.message = streams_[i].message;
    states_[i].trigger_stream = streams_.size();
    streams_.push_back(std::move(triggers));
    states_.emplace_back();
  }
}

void TopicStreams::select(const std::string& path, const std::vector<std::size_t>& streams) {
  for (State& state : states_) state.selected = false;
  for (const std::size_t stream : streams) {
    State& state = states_.at(stream);
    if (state.refused()) {
      throw badInput(path,
                     fmt::format("the {} of {} are encoded as \"{}\"", streamTypeName(streams_[stream].type),
                                 streams_[stream].name, state.encoding),
                     fmt::format("Record or convert them with one of these: {}", state.readableEncodings()));
    }
    state.selected = true;
  }
}

bool TopicStreams::decode(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
                          const std::string& place, Packet& packet) {
  packet.stream = stream;
  packet.clear();
  bool whole = true;
  switch (streams_[stream].type) {
    case StreamType::Events:
      whole = decodeEvents(stream, message, record_time_ns, packet.events);
      break;
    case StreamType::Imu:
      whole = decodeSamples(stream, message, record_time_ns, packet.imu_samples);
      break;
    case StreamType::Frames:
      whole = decodeFrame(stream, message, record_time_ns, packet.frames);
      break;
    case StreamType::Points:
    case StreamType::Triggers:
    case StreamType::Other:
      return false;
  }
  if (!whole) {
    addFault(streams_[stream].name, FaultKind::Corrupt,
             fmt::format("A message {} is damaged{}; {}.", place, stepText(stream, message),
                         packet.events.empty() ? "it is left out" : "its end is left out"));
  }
  return !packet.empty();
}

bool TopicStreams::decodeEvents(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
                                std::vector<Event>& events) {
  const State& state = states_[stream];
  const bool whole = state.content == Content::EventPacket ? decodePacket(stream, message, events)
                                                           : decodeArray(stream, message, events);
  if (state.stampless()) {
    if (!isTime(record_time_ns)) events.clear();
    for (Event& event : events) event.time_ns = record_time_ns;
  }
  followMessage(stream, events);
  putInOrder(stream, events);
  return whole && (!state.stampless() || isTime(record_time_ns));
}

bool TopicStreams::decodeArray(std::size_t stream, std::string_view message, std::vector<Event>& events) {
  const State& state = states_[stream];
  return state.content == Content::OldEventArray
             ? decodeOldEventArray(message, events)
             : decodeEventArray(message, state.serialization, events, streams_[stream].resolution_px);
}

void TopicStreams::followMessage(std::size_t stream, const std::vector<Event>& events) {
  State& state = states_[stream];
  if (events.empty()) return;
  const std::int64_t back_ns = state.latest_ns - events.front().time_ns;
  if (state.messages++ > 0 && back_ns > kMicrosecond_ns && back_ns < kSecond_ns) ++state.overlapping;
  state.latest_ns = events.back().time_ns;
}

bool TopicStreams::decodePacket(std::size_t stream, std::string_view message, std::vector<Event>& events) {
  State& state = states_[stream];
  EventPacket packet;
  if (!parseEventPacket(message, state.serialization, packet)) return false;
  if (packet.resolution_px.known()) streams_[stream].resolution_px = packet.resolution_px;
  if (encodingOf(packet.encoding) == Encoding::Unknown) {
    addFault(
        streams_[stream].name, FaultKind::Encoding,
        fmt::format("There are messages with the encoding \"{}\", which cannot be read.", packet.encoding));
    return true;
  }
  const bool whole = state.decoder.decode(packet, events);
  if (state.trigger_stream) streams_[*state.trigger_stream].messages = state.decoder.triggers();
  return whole;
}

bool TopicStreams::decodeSamples(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
                                 std::vector<RawImuSample>& samples) {
  const bool whole = decodeImu(message, states_[stream].serialization, samples);
  if (!states_[stream].stampless()) return whole;
  if (!isTime(record_time_ns)) samples.clear();
  for (RawImuSample& sample : samples) sample.time_ns = record_time_ns;
  return whole && isTime(record_time_ns);
}

bool TopicStreams::decodeFrame(std::size_t stream, std::string_view message, std::int64_t record_time_ns,
                               std::vector<Frame>& frames) {
  const State& state = states_[stream];
  StreamInfo& info = streams_[stream];
  ImageMessage image;
  if (!parse(state.content, message, state.serialization, image)) return false;
  if (!isReadable(state.content, image.encoding)) {
    addFault(info.name, FaultKind::Encoding,
             fmt::format("There are frames with the encoding \"{}\", which cannot be read; use {}.",
                         image.encoding, state.readableEncodings()));
    return true;
  }
  if (const auto wrong = state.content == Content::Image ? wrongStep(image) : std::nullopt;
      wrong && wrong->complete)
    addFault(info.name, FaultKind::Metadata,
             fmt::format(
                 "The step is {} bytes, but rows of {} have {}; the data are complete and are read as such.",
                 wrong->step_bytes, image.encoding, wrong->needed_bytes));
  Frame frame;
  const bool whole = state.content == Content::Image ? toFrame(image, frame) : toPackedFrame(image, frame);
  if (state.stampless()) frame.time_ns = record_time_ns;
  if (!whole || !isTime(frame.time_ns)) return false;
  if (!info.resolution_px.known()) info.resolution_px = image.size_px;
  frames.push_back(std::move(frame));
  return true;
}

// Small steps back are sorted; before a large one the packet ends, since sorting would only hide it.
void TopicStreams::putInOrder(std::size_t stream, std::vector<Event>& events) {
  State& state = states_[stream];
  const std::uint64_t before = state.disordered;
  for (std::size_t i = 1; i < events.size(); ++i) {
    const std::int64_t back_ns = events[i - 1].time_ns - events[i].time_ns;
    if (back_ns <= 0) continue;
    if (back_ns > kLargestSorted_ns) {
      const auto step = events.begin() + static_cast<std::ptrdiff_t>(i);
      rest_.assign(step, events.end());
      rest_stream_ = stream;
      events.erase(step, events.end());
      break;
    }
    state.disordered += 1;
    state.largest_disorder_ns = std::max(state.largest_disorder_ns, back_ns);
  }
  if (state.disordered == before) return;
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
  const std::string& name = streams_[stream].name;
  addFault(name, FaultKind::Unsorted, "");
  for (RecordingFault& fault : faults_) {
    if (fault.stream != name || fault.kind != FaultKind::Unsorted) continue;
    fault.text =
        fmt::format("Time runs backwards {} within messages, by {:.3f} ms at most; sorted.",
                    counted(state.disordered, "time"), 1e-6 * static_cast<double>(state.largest_disorder_ns));
  }
}

bool TopicStreams::handOutRest(Packet& packet) {
  if (rest_.empty()) return false;
  packet.stream = rest_stream_;
  packet.clear();
  std::swap(packet.events, rest_);
  putInOrder(packet.stream, packet.events);
  return true;
}

void TopicStreams::finishReading() {
  constexpr std::uint64_t kFewest = 10;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const State& state = states_[i];
    if (state.selected && state.content == Content::EventPacket) finishEventPackets(i);
    // Each other one, if both publish equally often.
    if (state.messages < kFewest || 4 * state.overlapping < state.messages) continue;
    addFault(
        streams_[i].name, FaultKind::SecondClock,
        fmt::format(
            "{} of {} messages begin before the end of the one before: two cameras seem to publish on this "
            "topic. Record each on a separate topic.",
            state.overlapping, state.messages));
  }
}

void TopicStreams::finishEventPackets(std::size_t stream) {
  const State& state = states_[stream];
  StreamInfo& info = streams_[stream];
  if (state.decoder.lostMessages() > 0) {
    addFault(
        info.name, FaultKind::LostMessages,
        counted(state.decoder.lostMessages(), "message", "is", "are") + " missing between those recorded.");
  }
  if (const std::uint64_t outside = state.decoder.outside(); outside > 0) {
    addFault(info.name, FaultKind::Outside,
             fmt::format("{} outside of the sensor {} left out.", counted(outside, "event"),
                         outside == 1 ? "is" : "are"));
  }
  if (const std::string_view other = state.decoder.otherEncoding(); !other.empty())
    addFault(info.name, FaultKind::Encoding,
             fmt::format("The messages state the encoding {}, but their content is {}; it is read as {}.",
                         state.encoding, other, other));
  if (state.decoder.triggers() > 0 && !state.trigger_stream)
    addFault(info.name, FaultKind::Triggers,
             fmt::format("There {} {}.", state.decoder.triggers() == 1 ? "is" : "are",
                         counted(state.decoder.triggers(), "external trigger")));
  const std::optional<HostClockOffset> offset = state.decoder.hostClock().offset();
  if (!offset) return;
  info.host_clock_offset_s = offset->offset_s;
  const std::string drift =
      offset->drift_ppm ? fmt::format(", drifting by {:.1f} ppm", *offset->drift_ppm) : "";
  addFault(
      info.name, FaultKind::HostClock,
      fmt::format(
          "Times are on the sensor's clock. The host's clock is ahead by {:.6f} s{}. If the IMU is on the "
          "host's clock, set the camera's clock_offset_s: {:.6f}.",
          offset->offset_s, drift, offset->offset_s));
}

void TopicStreams::addFault(const std::string& stream, FaultKind kind, const std::string& text) {
  const std::ptrdiff_t limit =
      kind == FaultKind::Corrupt || kind == FaultKind::Unreadable ? kMostAlikeFaults : 1;
  const auto alike = [&](const RecordingFault& fault) {
    return fault.stream == stream && fault.kind == kind;
  };
  if (std::count_if(faults_.begin(), faults_.end(), alike) < limit)
    faults_.push_back({stream, kind, 0.0, text});
}

}  // namespace evical::ros
