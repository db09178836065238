#include "core/recording/live/live_recording.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/recording/conversion.h"
#include "core/recording/live/live_source.h"
#include "core/recording/live/lost_packets.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <system_error>
#include <thread>
#include <utility>

namespace evical {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFlush{40};
constexpr std::chrono::seconds kSilence{2};
constexpr std::size_t kNotWritten = static_cast<std::size_t>(-1);

const RecordingFormat& liveFormat(const LiveRequest& request) {
  const RecordingFormat& format =
      request.format.empty() ? recordingFormatOf(request.output) : recordingFormat(request.format);
  if (format.live) return format;
  std::string names;
  for (const RecordingFormat& each : recordingFormats())
    if (each.live) names += (names.empty() ? "" : ", ") + std::string(each.name);
  throw badInput(format.name, "this format cannot be written live", "Choose one of: " + names);
}

// One source, read by a separate thread, since each may have nothing for a while.
struct Source {
  std::string address;
  std::unique_ptr<RecordingReader> reader;
  std::vector<std::size_t> targets;  // of its streams
  std::vector<LostPackets> lost;     // of its streams
  std::atomic<bool> ended = false;
  std::atomic<Clock::rep> last_arrival = 0;
  bool is_silent = false;  // and reported
  std::exception_ptr error;
  std::jthread thread;
};

class LiveRecorder {
 public:
  LiveRecorder(const LiveRequest& request, const RunContext& context)
      : request_(request), context_(context), format_(liveFormat(request)) {}
  ~LiveRecorder() { ended_.request_stop(); }
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;

  LiveSummary run();

 private:
  void openSources(const std::stop_token& stop);
  void addStreams(Source& source);
  void start();
  void readAll(Source& source);
  void write(Source& source, Packet& packet);
  void dropImpossible(Packet& packet);
  void follow(std::size_t target, std::int64_t time_ns);
  bool isOver() const;
  bool isComplete() const;
  void reportSilence();
  void finish();

  const LiveRequest& request_;
  const RunContext& context_;
  const RecordingFormat& format_;
  LiveSummary summary_;
  std::mutex mutex_;  // of the writer and the summary
  std::unique_ptr<RecordingWriter> writer_;
  std::vector<ImuSample> samples_;
  struct Written {
    std::optional<std::int64_t> last_ns;
    double duration_s = 0.0;
  };
  std::vector<Written> written_;  // by written stream
  std::uint64_t impossible_ = 0;  // items
  bool enough_ = false;
  std::stop_source ended_;
  std::vector<std::unique_ptr<Source>> sources_;  // last: their threads use the rest
};

// All at once: the streams run while one of them is waited for.
void LiveRecorder::openSources(const std::stop_token& stop) {
  for (const std::string& source : request_.sources) {
    std::error_code not_a_file;
    if (!isLiveAddress(source) && std::filesystem::equivalent(source, request_.output, not_a_file))
      throw badInput(source, "source and output are the same", "Choose another output");
  }
  const std::filesystem::path folder = request_.output.parent_path();
  std::mutex failing;
  std::exception_ptr first_error;
  for (const std::string& address : request_.sources) {
    Source& source = *sources_.emplace_back(std::make_unique<Source>());
    source.address = address;
    source.thread = std::jthread([this, &source, &first_error, &failing, folder, stop] {
      try {
        source.reader = openLive(source.address, folder, stop);
      } catch (const Cancelled&) {
        source.error = std::current_exception();
      } catch (...) {
        const std::scoped_lock lock(failing);
        if (!first_error) first_error = std::current_exception();
        ended_.request_stop();  // nobody waits for the others
      }
    });
  }
  for (const auto& source : sources_) source->thread.join();
  if (first_error) std::rethrow_exception(first_error);
  for (const auto& source : sources_)
    if (source->error) std::rethrow_exception(std::exchange(source->error, nullptr));
}

void LiveRecorder::addStreams(Source& source) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < source.reader->streams().size(); ++i) {
    StreamInfo info = source.reader->streams()[i];
    source.targets.push_back(info.readable && isWritable(info, format_) ? summary_.streams.size()
                                                                        : kNotWritten);
    if (source.targets.back() == kNotWritten) continue;
    if (info.type == StreamType::Events && !info.resolution_px.known())
      info.resolution_px = request_.resolution_px;
    if (info.type == StreamType::Events && !info.resolution_px.known())
      throw badInput(liveName(source.address), "the resolution of " + info.name + " is not in the stream",
                     "Give the resolution of the sensor, e.g. 346x260");
    const auto same = [&](const StreamInfo& other) { return other.name == info.name; };
    const std::string name = info.name;
    for (int number = 2; std::ranges::any_of(summary_.streams, same); ++number)
      info.name = fmt::format("{}_{}", name, number);
    info.acceleration_unit = AccelerationUnit::MetresPerSecond2;
    info.angular_rate_unit = AngularRateUnit::RadiansPerSecond;
    chosen.push_back(i);
    summary_.streams.push_back(std::move(info));
  }
  source.lost.resize(source.targets.size());
  source.reader->select(chosen);
}

void LiveRecorder::start() {
  for (const auto& source : sources_) addStreams(*source);
  if (summary_.streams.empty())
    throw badInput(
        liveName(request_.sources.front()),
        fmt::format("there are neither events nor IMU samples{}", format_.frames ? " nor frames" : ""),
        "Check what the program sends");
  written_.resize(summary_.streams.size());
  writer_ = createRecording(request_.output, format_.name, summary_.streams);
  for (const auto& source : sources_)
    source->thread = std::jthread([this, of = source.get()] { readAll(*of); });
}

void LiveRecorder::readAll(Source& source) {
  source.last_arrival = Clock::now().time_since_epoch().count();
  try {
    Packet packet;
    while (source.reader->read(packet)) {
      write(source, packet);
      source.last_arrival = Clock::now().time_since_epoch().count();
    }
  } catch (...) {
    source.error = std::current_exception();
    ended_.request_stop();
  }
  source.ended = true;
}

// Streams may have different clocks, and a clock may jump.
void LiveRecorder::follow(std::size_t target, std::int64_t time_ns) {
  constexpr double kLongestPause_s = 5.0;
  Written& written = written_[target];
  const double step_s = written.last_ns ? secondsSince(*written.last_ns, time_ns) : 0.0;
  written.last_ns = time_ns;
  if (step_s > 0.0 && step_s <= kLongestPause_s) written.duration_s += step_s;
  summary_.duration_s = std::max(summary_.duration_s, written.duration_s);
  enough_ = summary_.duration_s >= request_.max_duration_s;
}

// Times that files cannot contain are a damaged clock's.
void LiveRecorder::dropImpossible(Packet& packet) {
  constexpr std::int64_t kEnd_ns = (std::int64_t{1} << 31) * kSecond_ns;
  const auto drop = [this](auto& items) {
    impossible_ +=
        std::erase_if(items, [](const auto& item) { return item.time_ns < 0 || item.time_ns >= kEnd_ns; });
  };
  drop(packet.events);
  drop(packet.imu_samples);
  drop(packet.frames);
}

void LiveRecorder::write(Source& source, Packet& packet) {
  const std::size_t target = source.targets.at(packet.stream);
  if (target == kNotWritten) return;
  const StreamInfo& info = source.reader->streams()[packet.stream];
  const std::scoped_lock lock(mutex_);
  if (enough_) return;
  dropImpossible(packet);
  source.lost[packet.stream].add(packet);
  samples_.clear();
  toSi(packet.imu_samples, info.acceleration_unit, info.angular_rate_unit, samples_);
  if (!packet.events.empty()) writer_->write(target, EventSpan(packet.events));
  if (!samples_.empty()) writer_->write(target, std::span<const ImuSample>(samples_));
  for (const Frame& frame : packet.frames) writer_->writeFrame(target, frame);
  summary_.events += packet.events.size();
  summary_.imu_samples += samples_.size();
  summary_.frames += packet.frames.size();
  if (!packet.events.empty()) follow(target, packet.events.back().time_ns);
  if (!samples_.empty()) follow(target, samples_.back().time_ns);
  if (!packet.frames.empty()) follow(target, packet.frames.back().time_ns);
}

// All streams have begun, so that readers of the file know them, or some are late.
bool LiveRecorder::isComplete() const {
  constexpr double kLate_s = 2.0;
  return summary_.duration_s >= kLate_s ||
         std::ranges::all_of(written_, [](const Written& written) { return written.last_ns.has_value(); });
}

bool LiveRecorder::isOver() const {
  return std::ranges::all_of(sources_, [](const auto& source) { return source->ended.load(); });
}

void LiveRecorder::reportSilence() {
  for (const auto& source : sources_) {
    const Clock::duration since(Clock::now().time_since_epoch().count() - source->last_arrival);
    const bool silent = !source->ended && since >= kSilence;
    if (silent && !source->is_silent)
      context_.progress.log(LogLevel::Warning, fmt::format("Nothing has arrived from {} for {} s.",
                                                           liveName(source->address), kSilence.count()));
    source->is_silent = silent;
  }
}

void LiveRecorder::finish() {
  const std::scoped_lock lock(mutex_);
  for (const auto& source : sources_) {
    for (const RecordingFault& fault : source->reader->faults()) summary_.faults.push_back(fault);
    for (std::size_t i = 0; i < source->lost.size(); ++i)
      if (auto fault = source->lost[i].fault(source->reader->streams()[i].name))
        summary_.faults.push_back(std::move(*fault));
  }
  if (impossible_ > 0)
    summary_.faults.push_back(
        {"", FaultKind::Corrupt, 0.0,
         counted(impossible_, "time", "is", "are") + " before 1970 or after 2038; these data are left out."});
  writer_->finish();
}

LiveSummary LiveRecorder::run() {
  const std::stop_callback on_stop(context_.stop, [this] { ended_.request_stop(); });
  context_.progress.stageStarted("wait for the streams");
  openSources(ended_.get_token());
  start();
  context_.progress.stageStarted("record");
  while (!isOver()) {
    std::this_thread::sleep_for(kFlush);
    {
      const std::scoped_lock lock(mutex_);
      if (isComplete()) {
        writer_->flush();
        if (request_.progressed) request_.progressed(summary_.duration_s);
      }
      if (enough_) ended_.request_stop();
    }
    reportSilence();
    context_.progress.stageProgress(summary_.duration_s / request_.max_duration_s);
  }
  for (const auto& source : sources_) source->thread.join();
  finish();
  for (const auto& source : sources_)
    if (source->error) std::rethrow_exception(source->error);
  summary_.format = format_.name;
  return std::move(summary_);
}

}  // namespace

LiveSummary recordLive(const LiveRequest& request, const RunContext& context) {
  return LiveRecorder(request, context).run();
}

}  // namespace evical
