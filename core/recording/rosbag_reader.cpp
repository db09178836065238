#include "core/recording/rosbag_reader.h"

#include "core/base/error.h"
#include "core/base/time.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace evical {
namespace {

constexpr std::size_t kPacketEvents = 1U << 16;  // 1 MB: stays in the cache, however long a message is
constexpr int kMessagesToLookAt = 3;             // one zero stamp may be meant, three are no stamps
constexpr std::size_t kChunksToLookAt = 64;  // streams that begin later show their resolution when they come

StreamType typeOf(RosMessage message) {
  switch (message) {
    case RosMessage::EventArray:
      return StreamType::Events;
    case RosMessage::Imu:
      return StreamType::Imu;
    case RosMessage::Image:
      return StreamType::Frames;
    case RosMessage::EventPacket:
    case RosMessage::Other:
      return StreamType::Other;
  }
  return StreamType::Other;
}

std::int64_t recordTime(const BagRecord& record) {
  const std::optional<Bytes> time = record.fields.find("time");
  return time && time->size() == 8 ? bagTime(time->data()) : 0;
}

bool allStampsZero(const EventArrayView& view) {
  if (view.stamp_ns != 0) return false;
  for (std::size_t i = 0; i < view.events.size(); i += kRosEventSize)
    if (bagTime(view.events.data() + i + 4) != 0) return false;
  return true;
}

}  // namespace

RosbagReader::RosbagReader(const std::filesystem::path& path) : file_(path) {
  layout_ = readBagLayout(file_, faults_);
  makeStreams();
  lookAhead();
}

// Several connections may carry one topic; messages of another type under the same topic are another stream.
void RosbagReader::makeStreams() {
  for (const BagConnection& connection : layout_.connections) {
    const RosMessage message = identifyMessage(connection.type, connection.md5, connection.definition);
    std::size_t stream = 0;
    while (stream < streams_.size() &&
           (streams_[stream].name != connection.topic || states_[stream].message != message))
      ++stream;
    if (stream == streams_.size()) {
      streams_.push_back({connection.topic, typeOf(message), connection.type, {}, 0});
      states_.push_back({message});
      if (message == RosMessage::EventPacket)
        faults_.add(connection.topic, "unsupported", 0.0,
                    fmt::format("{} cannot be read yet; record dvs_msgs/EventArray", connection.type));
    }
    stream_of_connection_.emplace(connection.id, stream);
  }
  for (const BagChunk& chunk : layout_.chunks)
    for (const BagChunk::Count& count : chunk.counts)
      if (const auto found = stream_of_connection_.find(count.connection);
          found != stream_of_connection_.end())
        streams_[found->second].messages += count.messages;
}

template <class Predicate>
bool RosbagReader::chunkHas(const BagChunk& chunk, Predicate wanted) const {
  if (!chunk.counted) return true;
  return std::any_of(chunk.counts.begin(), chunk.counts.end(), [&](const BagChunk::Count& count) {
    const auto found = stream_of_connection_.find(count.connection);
    return found != stream_of_connection_.end() && count.messages > 0 && wanted(found->second);
  });
}

bool RosbagReader::lookAheadDone(std::size_t stream) const {
  const StreamState& state = states_[stream];
  switch (typeOf(state.message)) {
    case StreamType::Events:
    case StreamType::Imu:
      return state.messages_seen >= kMessagesToLookAt || !state.only_zero_stamps;
    case StreamType::Frames:
      return state.messages_seen > 0;
    default:
      return true;
  }
}

// Resolutions, and whether stamps are stamps, are in the messages.
void RosbagReader::lookAhead() {
  std::size_t loaded = 0;
  for (const BagChunk& chunk : layout_.chunks) {
    if (loaded == kChunksToLookAt) break;
    if (!chunkHas(chunk, [&](std::size_t stream) { return !lookAheadDone(stream); })) continue;
    chunk_.load(file_, chunk.position);
    ++loaded;
    BagRecord record;
    while (chunk_.next(record))
      if (record.fields.op() == BagOp::Message) lookAhead(record);
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    StreamState& state = states_[i];
    const bool stamped = streams_[i].type == StreamType::Events || streams_[i].type == StreamType::Imu;
    state.uses_record_time = stamped && state.only_zero_stamps && state.messages_seen >= kMessagesToLookAt;
    if (state.uses_record_time)
      faults_.add(streams_[i].name, "no_stamps", 0.0,
                  "all stamps are zero; the times of recording are used, which jitter by milliseconds");
  }
}

void RosbagReader::lookAhead(const BagRecord& record) {
  const auto connection = record.fields.number<std::uint32_t>("conn");
  const auto found = connection ? stream_of_connection_.find(*connection) : stream_of_connection_.end();
  if (found == stream_of_connection_.end() || lookAheadDone(found->second)) return;
  StreamState& state = states_[found->second];
  Resolution& resolution = streams_[found->second].resolution_px;
  if (state.message == RosMessage::EventArray) {
    const std::optional<EventArrayView> view = parseEventArray(record.data);
    if (!view) return;
    resolution = view->resolution_px;
    state.only_zero_stamps = state.only_zero_stamps && allStampsZero(*view);
  } else if (state.message == RosMessage::Imu) {
    const std::optional<ImuSample> sample = parseImu(record.data);
    if (!sample) return;
    state.only_zero_stamps = state.only_zero_stamps && sample->time_ns == 0;
  } else {
    resolution = parseResolution(record.data).value_or(Resolution());
  }
  state.messages_seen += 1;
}

void RosbagReader::select(const std::vector<std::size_t>& streams) {
  for (std::size_t i = 0; i < states_.size(); ++i)
    states_[i].selected = std::find(streams.begin(), streams.end(), i) != streams.end();
}

double RosbagReader::fractionRead() const {
  if (next_chunk_ == 0 || layout_.chunks.empty()) return layout_.chunks.empty() ? 1.0 : 0.0;
  const auto begin_of = [&](std::size_t chunk) {
    return static_cast<double>(chunk < layout_.chunks.size() ? layout_.chunks[chunk].position : file_.size());
  };
  const double begin = begin_of(next_chunk_ - 1);
  const double within = chunk_loaded_ ? chunk_.fractionRead() : 1.0;
  return (begin + within * (begin_of(next_chunk_) - begin)) / static_cast<double>(file_.size());
}

bool RosbagReader::loadNextChunk() {
  chunk_loaded_ = false;
  while (next_chunk_ < layout_.chunks.size()) {
    const BagChunk& chunk = layout_.chunks[next_chunk_++];
    if (!chunkHas(chunk, [&](std::size_t stream) {
          return states_[stream].selected &&
                 (streams_[stream].type == StreamType::Events || streams_[stream].type == StreamType::Imu);
        }))
      continue;
    chunk_.load(file_, chunk.position);
    messages_in_chunk_ = 0;
    chunk_loaded_ = true;
    return true;
  }
  return false;
}

void RosbagReader::reportChunk() {
  if (chunk_.faultKind().empty()) return;
  const BagChunk& chunk = layout_.chunks[next_chunk_ - 1];
  std::string text = chunk_.faultText();
  if (chunk.counted) {
    const auto add = [](std::uint64_t sum, const BagChunk::Count& count) { return sum + count.messages; };
    const std::uint64_t expected =
        std::accumulate(chunk.counts.begin(), chunk.counts.end(), std::uint64_t{0}, add);
    text += fmt::format("; {} of its {} messages are lost", expected - std::min(expected, messages_in_chunk_),
                        expected);
  }
  faults_.add("", chunk_.faultKind(), 0.0, text);
}

bool RosbagReader::read(Packet& packet) {
  for (;;) {
    if (!pending_.bytes.empty() && readPendingEvents(packet)) return true;
    BagRecord record;
    if (chunk_loaded_ && chunk_.next(record)) {
      if (record.fields.op() == BagOp::Message && readMessage(record, packet)) return true;
      continue;
    }
    if (chunk_loaded_) reportChunk();
    if (!loadNextChunk()) return false;
  }
}

bool RosbagReader::readMessage(const BagRecord& record, Packet& packet) {
  messages_in_chunk_ += 1;
  const auto connection = record.fields.number<std::uint32_t>("conn");
  const auto found = connection ? stream_of_connection_.find(*connection) : stream_of_connection_.end();
  if (found == stream_of_connection_.end() || !states_[found->second].selected) return false;
  const std::size_t stream = found->second;
  switch (states_[stream].message) {
    case RosMessage::EventArray:
      return readEvents(stream, record.data, recordTime(record), packet);
    case RosMessage::Imu:
      return readImu(stream, record.data, recordTime(record), packet);
    default:
      return false;
  }
}

bool RosbagReader::readImu(std::size_t stream, Bytes message, std::int64_t record_time_ns, Packet& packet) {
  std::optional<ImuSample> sample = parseImu(message);
  if (!sample) {
    reportMessage(stream, record_time_ns);
    return false;
  }
  StreamState& state = states_[stream];
  if (state.uses_record_time) sample->time_ns = record_time_ns;
  if (state.first_ns < 0) state.first_ns = sample->time_ns;
  packet.stream = stream;
  packet.events.clear();
  packet.imu_samples.assign(1, *sample);
  return true;
}

bool RosbagReader::readEvents(std::size_t stream, Bytes message, std::int64_t record_time_ns,
                              Packet& packet) {
  const std::optional<EventArrayView> view = parseEventArray(message);
  if (!view) {
    reportMessage(stream, record_time_ns);
    return false;
  }
  if (view->resolution_px.known() && !streams_[stream].resolution_px.known())
    streams_[stream].resolution_px = view->resolution_px;
  pending_ = {stream, view->events, record_time_ns};
  return !view->events.empty() && readPendingEvents(packet);
}

bool RosbagReader::readPendingEvents(Packet& packet) {
  const std::size_t count = std::min(kPacketEvents, pending_.bytes.size() / kRosEventSize);
  packet.stream = pending_.stream;
  packet.imu_samples.clear();
  packet.events.resize(count);
  const bool valid = decodeEvents(pending_.bytes.data(), count, packet.events.data());
  pending_.bytes = pending_.bytes.subspan(count * kRosEventSize);
  StreamState& state = states_[pending_.stream];
  if (state.uses_record_time)
    for (Event& event : packet.events) event.time_ns = pending_.record_time_ns;
  if (state.first_ns < 0) state.first_ns = packet.events.front().time_ns;
  if (valid) return true;
  reportMessage(pending_.stream, pending_.record_time_ns);
  packet.events.clear();
  pending_.bytes = {};
  return false;
}

void RosbagReader::reportMessage(std::size_t stream, std::int64_t record_time_ns) {
  faults_.add(streams_[stream].name, "corrupt", sinceFirst(stream, record_time_ns),
              fmt::format("a message in the chunk at byte {} is damaged and left out",
                          layout_.chunks[next_chunk_ - 1].position));
}

// Record times serve where a message is unreadable: near enough to find the place.
double RosbagReader::sinceFirst(std::size_t stream, std::int64_t time_ns) const {
  const std::int64_t first_ns = states_[stream].first_ns;
  return first_ns < 0 ? 0.0 : std::max(0.0, secondsSince(first_ns, time_ns));
}

}  // namespace evical
