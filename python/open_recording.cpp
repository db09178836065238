#include "python/open_recording.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace evical::python {
namespace {

constexpr std::array kReadTypes{StreamType::Events, StreamType::Imu, StreamType::Frames, StreamType::Points};

bool isRead(const StreamInfo& stream) {
  return stream.readable && std::find(kReadTypes.begin(), kReadTypes.end(), stream.type) != kReadTypes.end();
}

// Streams of this name or this type.
std::vector<std::size_t> indicesOf(const RecordingReader& reader, const std::string& wanted) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < reader.streams().size(); ++i) {
    const StreamInfo& stream = reader.streams()[i];
    if (isRead(stream) && (stream.name == wanted || streamTypeName(stream.type) == wanted))
      found.push_back(i);
  }
  if (found.empty())
    static_cast<void>(findStream(reader, wanted, kReadTypes));  // throws with a list of streams
  if (found.empty()) throw badInput(wanted, "the recording has this stream, but it cannot be read");
  return found;
}

std::vector<std::size_t> chosenStreams(const RecordingReader& reader,
                                       const std::vector<std::string>& streams) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; streams.empty() && i < reader.streams().size(); ++i)
    if (isRead(reader.streams()[i])) chosen.push_back(i);
  for (const std::string& wanted : streams)
    for (const std::size_t index : indicesOf(reader, wanted)) chosen.push_back(index);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace

OpenRecording::OpenRecording(std::filesystem::path path, const std::vector<std::string>& streams)
    : path_(std::move(path)), reader_(openRecording(path_)), format_(reader_->format()) {
  reader_->select(chosenStreams(*reader_, streams));
  streams_ = reader_->streams();
}

std::shared_ptr<Packet> OpenRecording::read() {
  const std::lock_guard lock(mutex_);
  if (!reader_) throw Closed{};
  auto packet = std::make_shared<Packet>();
  return reader_->read(*packet) ? packet : nullptr;
}

void OpenRecording::close() {
  const std::lock_guard lock(mutex_);
  if (!reader_) return;
  streams_ = reader_->streams();
  faults_ = reader_->faults();
  fraction_read_ = reader_->fractionRead();
  reader_.reset();
}

bool OpenRecording::closed() const {
  const std::lock_guard lock(mutex_);
  return !reader_;
}

std::vector<StreamInfo> OpenRecording::streams() const {
  const std::lock_guard lock(mutex_);
  return reader_ ? reader_->streams() : streams_;
}

std::vector<RecordingFault> OpenRecording::faults() const {
  const std::lock_guard lock(mutex_);
  return reader_ ? reader_->faults() : faults_;
}

double OpenRecording::fractionRead() const {
  const std::lock_guard lock(mutex_);
  return reader_ ? reader_->fractionRead() : fraction_read_;
}

}  // namespace evical::python
