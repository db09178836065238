#include "core/recording/joined_reader.h"

#include <algorithm>
#include <utility>

namespace evical {
namespace {

bool isReadByDefault(const StreamInfo& stream) {
  return stream.type == StreamType::Events || stream.type == StreamType::Imu ||
         stream.type == StreamType::Points;
}

std::int64_t lastTime_ns(const Packet& packet) {
  if (!packet.events.empty()) return packet.events.back().time_ns;
  if (!packet.imu_samples.empty()) return packet.imu_samples.back().time_ns;
  if (!packet.frames.empty()) return packet.frames.back().time_ns;
  return packet.points.back().time_ns;
}

}  // namespace

JoinedReader::JoinedReader(std::vector<Part> parts) {
  for (Part& part : parts) {
    State& state = states_.emplace_back();
    state.part = std::move(part);
    state.first_stream = streams_.size();
    const std::vector<StreamInfo>& streams = state.part.reader->streams();
    streams_.resize(streams_.size() + streams.size());
    takeStreams(state);
    state.wanted = std::any_of(streams.begin(), streams.end(), isReadByDefault);
  }
  gatherFaults();
}

// Some properties of streams become known during reading.
void JoinedReader::takeStreams(const State& state) {
  const std::vector<StreamInfo>& streams = state.part.reader->streams();
  for (std::size_t i = 0; i < streams.size(); ++i) streams_[state.first_stream + i] = streams[i];
  if (state.isRenamed()) streams_[state.first_stream].name = state.part.name;
}

void JoinedReader::gatherFaults() {
  faults_.clear();
  for (const State& state : states_) {
    for (RecordingFault fault : state.part.reader->faults()) {
      if (state.isRenamed() && !fault.stream.empty()) fault.stream = state.part.name;
      faults_.push_back(std::move(fault));
    }
  }
}

void JoinedReader::select(const std::vector<std::size_t>& streams) {
  for (State& state : states_) {
    const std::size_t behind = state.first_stream + state.part.reader->streams().size();
    std::vector<std::size_t> own;
    for (const std::size_t stream : streams) {
      static_cast<void>(streams_.at(stream));  // a wrong index is a bug of the caller
      if (stream >= state.first_stream && stream < behind) own.push_back(stream - state.first_stream);
    }
    state.part.reader->select(own);
    state.wanted = !own.empty();
  }
}

// The part with the earliest time is read first, so that all advance together.
bool JoinedReader::read(Packet& packet) {
  for (;;) {
    State* behind = nullptr;
    for (State& state : states_)
      if (state.wanted && !state.finished && (!behind || state.last_ns < behind->last_ns)) behind = &state;
    if (!behind) break;
    behind->finished = !behind->part.reader->read(packet);
    takeStreams(*behind);
    if (behind->finished) continue;
    packet.stream += behind->first_stream;
    behind->last_ns = lastTime_ns(packet);
    return true;
  }
  packet.clear();
  gatherFaults();
  return false;
}

double JoinedReader::fractionRead() const {
  double sum = 0.0, count = 0.0;
  for (const State& state : states_) {
    if (!state.wanted) continue;
    sum += state.part.reader->fractionRead();
    count += 1.0;
  }
  return count == 0.0 ? 1.0 : sum / count;
}

std::string JoinedReader::format() const {
  std::vector<std::string> names;
  for (const State& state : states_) {
    const std::string name = state.part.reader->format();
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : "+") + name;
  return all;
}

}  // namespace evical
