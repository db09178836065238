#include "python/open_recording.h"

#include "core/base/error.h"
#include "core/base/number.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <system_error>
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
                                       const std::optional<std::vector<std::string>>& streams) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; !streams && i < reader.streams().size(); ++i)
    if (isRead(reader.streams()[i])) chosen.push_back(i);
  for (const std::string& wanted : streams.value_or(std::vector<std::string>()))
    for (const std::size_t index : indicesOf(reader, wanted)) chosen.push_back(index);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

template <class Items, class Visit>
void forEachTime(const Items& items, const Visit& visit) {
  for (const auto& item : items) visit(item.time_ns);
}

}  // namespace

std::filesystem::path pathForReading(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) ? std::filesystem::absolute(path) : path;
}

OpenRecording::OpenRecording(std::filesystem::path path,
                             const std::optional<std::vector<std::string>>& streams)
    : path_(std::move(path)),
      process_(::getpid()),
      reader_(openRecording(pathForReading(path_))),
      format_(reader_->format()) {
  reader_->select(chosenStreams(*reader_, streams));
  last_ = stateNow();
}

OpenRecording::~OpenRecording() {
  if (isOfOtherProcess()) static_cast<void>(reader_.release());  // its end would end the parent's
}

bool OpenRecording::isOfOtherProcess() const {
  return process_ != ::getpid();
}

void OpenRecording::requireOwnProcess() const {
  if (isOfOtherProcess())
    throw badInput(path(), "the recording was opened by another process, before a fork",
                   "Open it in each process that reads it, or use the start method spawn");
}

std::optional<std::shared_ptr<Packet>> OpenRecording::read(std::chrono::milliseconds longest) {
  requireOwnProcess();
  const std::unique_lock turn(turn_, longest);
  if (!turn) return std::nullopt;
  if (!reader_) throw Closed{};
  auto packet = std::make_shared<Packet>();
  if (!reader_->read(*packet)) packet = nullptr;
  if (packet) note(*packet);
  State now = stateNow();
  const std::lock_guard lock(last_mutex_);
  last_ = std::move(now);
  return packet;
}

bool OpenRecording::close(std::chrono::milliseconds longest) {
  if (isOfOtherProcess()) return true;
  const std::unique_lock turn(turn_, longest);
  if (!turn) return false;
  if (!reader_) return true;
  State now = stateNow();
  now.closed = true;
  reader_.reset();
  const std::lock_guard lock(last_mutex_);
  last_ = std::move(now);
  return true;
}

void OpenRecording::note(const Packet& packet) {
  Order& order = orders_[packet.stream];
  const auto add = [&order](std::int64_t time_ns) {
    const std::int64_t back_ns = order.last_ns ? *order.last_ns - time_ns : 0;
    if (back_ns > 0) ++order.steps;
    order.largest_ns = std::max(order.largest_ns, back_ns);
    order.last_ns = time_ns;
  };
  if (!packet.events.empty()) {  // in order
    add(packet.events.front().time_ns);
    add(packet.events.back().time_ns);
  }
  forEachTime(packet.imu_samples, add);
  forEachTime(packet.frames, add);
  forEachTime(packet.points, add);
}

OpenRecording::State OpenRecording::stateNow() const {
  State state{false, reader_->streams(), reader_->faults(), reader_->fractionRead()};
  for (const auto& [stream, order] : orders_)
    if (order.steps > 0)
      state.faults.push_back(
          {state.streams.at(stream).name, FaultKind::BackwardTime, 0.0,
           fmt::format("Time runs backwards {} between packets, by {:.3f} ms at most.",
                       counted(order.steps, "time"), 1e-6 * static_cast<double>(order.largest_ns))});
  return state;
}

OpenRecording::State OpenRecording::state() const {
  requireOwnProcess();
  const std::lock_guard lock(last_mutex_);
  return last_;
}

bool OpenRecording::closed() const {
  return isOfOtherProcess() || state().closed;
}

std::vector<StreamInfo> OpenRecording::streams() const {
  return state().streams;
}

std::vector<RecordingFault> OpenRecording::faults() const {
  return state().faults;
}

double OpenRecording::fractionRead() const {
  return state().fraction_read;
}

}  // namespace evical::python
