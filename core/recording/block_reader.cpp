#include "core/recording/block_reader.h"

#include "core/base/error.h"
#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kReadBlock_bytes = std::size_t{1} << 18;

}  // namespace

BlockReader::BlockReader(const std::filesystem::path& path, BlockFormat format,
                         std::unique_ptr<BlockDecoder> decoder)
    : format_(std::move(format)),
      decoder_(std::move(decoder)),
      file_(path, std::ios::binary | std::ios::ate) {
  if (!file_) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  file_size_ = static_cast<std::uint64_t>(file_.tellg());
  position_ = format_.data_offset;
  file_.seekg(static_cast<std::streamoff>(position_));
  faults_ = std::move(format_.notes);
  for (StreamInfo& stream : format_.streams) stream.readable = stream.type != StreamType::Triggers;
  imu_stream_ = streamOf(StreamType::Imu);
  frames_stream_ = streamOf(StreamType::Frames);
  imu_wanted_ = imu_stream_ < format_.streams.size();
}

std::size_t BlockReader::streamOf(StreamType type) const {
  const auto found = std::find_if(format_.streams.begin(), format_.streams.end(),
                                  [&](const StreamInfo& stream) { return stream.type == type; });
  return static_cast<std::size_t>(found - format_.streams.begin());
}

void BlockReader::select(const std::vector<std::size_t>& streams) {
  const auto wants = [&](StreamType type) {
    return std::any_of(streams.begin(), streams.end(),
                       [&](std::size_t stream) { return format_.streams.at(stream).type == type; });
  };
  events_wanted_ = wants(StreamType::Events);
  imu_wanted_ = wants(StreamType::Imu);
  frames_wanted_ = wants(StreamType::Frames);
}

bool BlockReader::read(Packet& packet) {
  packet.clear();
  if (!events_wanted_ && !imu_wanted_ && !frames_wanted_) return false;
  while (!handOut(packet) && !handOutSamples(packet) && !handOutFrames(packet)) {
    if (finished_ || !decodeBlock()) return false;
  }
  return true;
}

// Undecoded bytes of the previous block are at the front of this one.
bool BlockReader::decodeBlock() {
  const std::size_t left = bytes_.size();
  bytes_.resize(left + kReadBlock_bytes);
  const std::size_t got = readBlock(bytes_.data() + left);
  bytes_.resize(left + got);
  position_ += got;
  if (got == 0) {
    finish();
    return false;
  }
  decoded_.clear();
  handed_out_ = 0;
  const std::size_t used = decoder_->decode(bytes_, position_ - bytes_.size(), decoded_);
  bytes_.erase(0, used);
  return true;
}

// Reads the bytes that exist, up to a block; 0 at the end.
std::size_t BlockReader::readBlock(char* bytes) {
  file_.read(bytes, static_cast<std::streamsize>(kReadBlock_bytes));
  if (file_.gcount() == 0 && growth_ && growth_->waitFor(position_ + 1) > position_) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(position_));
    file_.read(bytes, static_cast<std::streamsize>(kReadBlock_bytes));
  }
  return static_cast<std::size_t>(file_.gcount());
}

bool BlockReader::follow(const std::shared_ptr<Growth>& growth) {
  growth_ = growth;
  return true;
}

// Small steps back are sorted; before a large one the packet ends, since sorting would only hide it.
bool BlockReader::handOut(Packet& packet) {
  if (!events_wanted_ || handed_out_ == decoded_.size()) return false;
  packet.stream = 0;
  std::size_t end = handed_out_ + 1;
  bool sorted = true;
  for (; end < decoded_.size(); ++end) {
    const std::int64_t back_ns = decoded_[end - 1].time_ns - decoded_[end].time_ns;
    if (back_ns <= 0) continue;
    if (back_ns > kLargestSorted_ns) break;
    sorted = false;
    ++disordered_;
    largest_disorder_ns_ = std::max(largest_disorder_ns_, back_ns);
  }
  const auto begin = decoded_.begin() + static_cast<std::ptrdiff_t>(handed_out_);
  const auto behind = decoded_.begin() + static_cast<std::ptrdiff_t>(end);
  if (!sorted) {
    std::stable_sort(begin, behind, [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
  }
  if (handed_out_ == 0 && end == decoded_.size()) {
    std::swap(packet.events, decoded_);
    decoded_.clear();
    handed_out_ = 0;
    return true;
  }
  packet.events.assign(begin, behind);
  handed_out_ = end;
  return true;
}

// Reported after the events of their block.
bool BlockReader::handOutSamples(Packet& packet) {
  std::vector<RawImuSample>& samples = decoder_->imuSamples();
  if (imu_wanted_ && !samples.empty()) {
    packet.stream = imu_stream_;
    std::swap(packet.imu_samples, samples);
  }
  samples.clear();
  return !packet.imu_samples.empty();
}

bool BlockReader::handOutFrames(Packet& packet) {
  std::vector<Frame>* const frames = decoder_->frames();
  if (frames == nullptr) return false;
  if (frames_wanted_ && !frames->empty()) {
    packet.stream = frames_stream_;
    std::swap(packet.frames, *frames);
  }
  frames->clear();
  return !packet.frames.empty();
}

void BlockReader::finish() {
  finished_ = true;
  decoder_->finish();
  const BlockFindings& found = decoder_->findings();
  for (StreamInfo& stream : format_.streams)
    if (stream.type == StreamType::Triggers) stream.messages = found.triggers;
  const auto report = [this](FaultKind kind, const Occurrences& occurrences, const char* what) {
    if (occurrences.count == 0) return;
    addFault(kind, fmt::format("{} {}; from byte {} on.", occurrences.count, what, occurrences.first_byte));
  };
  if (!bytes_.empty()) {
    addFault(FaultKind::Truncated,
             fmt::format("The last record, at byte {} of {}, is incomplete; it is left out.",
                         position_ - bytes_.size(), position_));
  }
  report(FaultKind::Outside, found.outside, "events are outside of the sensor and are left out");
  report(FaultKind::Untimed, found.untimed, "events have no time or place yet and are left out");
  report(FaultKind::Corrupt, found.unknown, "records have an unknown kind and are left out");
  report(FaultKind::TimeWrap, found.wraps, "overflows of the time counter were corrected");
  report(FaultKind::ImuLeftOut, found.imu, "IMU records have an unknown scale and are left out");
  report(FaultKind::ExposureLeftOut, found.exposure,
         "grey-level events belong to incomplete frames and are left out");
  if (found.rolling_frames > 0)
    faults_.push_back(
        {format_.streams.at(frames_stream_).name, FaultKind::Metadata, 0.0,
         counted(found.rolling_frames, "frame", "is", "are") +
             " of a rolling shutter that exposes column by column; each gets the middle of its exposures."});
  if (disordered_ > 0) {
    addFault(FaultKind::Unsorted,
             fmt::format("Time runs backwards {} by {:.3f} ms at most; sorted.", counted(disordered_, "time"),
                         1e-6 * static_cast<double>(largest_disorder_ns_)));
  }
}

void BlockReader::addFault(FaultKind kind, std::string text) {
  faults_.push_back(
      {format_.streams.empty() ? "" : format_.streams.front().name, kind, 0.0, std::move(text)});
}

double BlockReader::fractionRead() const {
  if (finished_ || file_size_ == 0) return 1.0;
  return std::min(1.0, static_cast<double>(position_) / static_cast<double>(file_size_));
}

std::size_t EventOrder::arrange(std::span<Event> events) {
  const std::uint64_t before = disordered_;
  std::size_t end = events.empty() ? 0 : 1;
  for (; end < events.size(); ++end) {
    const std::int64_t back_ns = events[end - 1].time_ns - events[end].time_ns;
    if (back_ns <= 0) continue;
    if (back_ns > kLargestSorted_ns) break;
    ++disordered_;
    largest_ns_ = std::max(largest_ns_, back_ns);
  }
  if (disordered_ != before) {
    std::stable_sort(events.begin(), events.begin() + static_cast<std::ptrdiff_t>(end),
                     [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
  }
  return end;
}

void EventOrder::split(std::vector<Event>& events, std::vector<Event>& rest) {
  const auto step = events.begin() + static_cast<std::ptrdiff_t>(arrange(events));
  rest.assign(step, events.end());
  events.erase(step, events.end());
}

std::string EventOrder::text() const {
  return fmt::format("Time runs backwards {} within packets, by {:.3f} ms at most; sorted.",
                     counted(disordered_, "time"), 1e-6 * static_cast<double>(largest_ns_));
}

namespace {

constexpr std::uint64_t kCachedBlock_bytes = 1 << 20;

}  // namespace

RandomAccessFile::RandomAccessFile(const std::filesystem::path& path) {
  file_.rdbuf()->pubsetbuf(nullptr, 0);  // the block is the buffer
  file_.open(path, std::ios::binary | std::ios::ate);
  if (!file_) throw badInput(path.string(), "the file cannot be opened", "Check its permissions");
  size_ = static_cast<std::uint64_t>(file_.tellg());
}

bool RandomAccessFile::reaches(std::uint64_t bytes) {
  if (bytes > size_ && growth_ && bytes - size_ <= kLargestAwaited_bytes) look(bytes);
  return bytes <= size_;
}

void RandomAccessFile::awaitEnd() {
  if (growth_) look(std::numeric_limits<std::uint64_t>::max());
}

// Bytes that were read may have changed: some formats complete their header at the end.
void RandomAccessFile::look(std::uint64_t bytes) {
  size_ = growth_->waitFor(bytes);
  block_.clear();
}

bool RandomAccessFile::read(std::uint64_t position, std::uint64_t count, std::string_view& bytes) {
  if (position > size_ || count > size_ - position) return false;
  const bool is_there = position >= block_position_ && position + count <= block_position_ + block_.size();
  if (!is_there) {
    block_.resize(static_cast<std::size_t>(std::max(count, std::min(kCachedBlock_bytes, size_ - position))));
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(position));
    file_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
    block_.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file_.gcount())));
    block_position_ = position;
    if (block_.size() < count) return false;
  }
  bytes = std::string_view(block_).substr(static_cast<std::size_t>(position - block_position_),
                                          static_cast<std::size_t>(count));
  return true;
}

}  // namespace evical
