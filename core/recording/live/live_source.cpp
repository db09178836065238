#include "core/recording/live/live_source.h"

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/recording/live/dv_stream.h"
#include "core/recording/live/foxglove_stream.h"
#include "core/recording/live/growth.h"
#include "core/recording/live/socket.h"
#include "core/recording/live/spool.h"
#include "core/recording/separate_reader.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

namespace evical {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kStandardInput = "-";
constexpr int kPoll_ms = 50;

void pumpDescriptor(int descriptor, Spool& spool, const std::stop_token& stop) {
  std::vector<char> bytes(std::size_t{1} << 18);
  while (!stop.stop_requested()) {
    pollfd waiting{descriptor, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, kPoll_ms);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t got = ::read(descriptor, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      throw badInput("the standard input", fmt::format("cannot be read: {}", std::strerror(errno)),
                     "Pipe a recording into this command");
    if (got == 0) return;
    spool.append({bytes.data(), static_cast<std::size_t>(got)});
  }
}

bool hasSensor(const RecordingReader& reader) {
  return std::ranges::any_of(reader.streams(), [](const StreamInfo& stream) {
    return stream.readable && (stream.type == StreamType::Events || stream.type == StreamType::Imu ||
                               stream.type == StreamType::Frames || stream.type == StreamType::Points);
  });
}

// A reader and the stream that it follows.
class LiveReader : public RecordingReader {
 public:
  LiveReader(std::string name, std::unique_ptr<Spool> spool, std::stop_token stop)
      : name_(std::move(name)),
        spool_(std::move(spool)),
        stop_(stop),
        on_stop_(std::move(stop), [this] { spool_->stop(); }) {
    open();
  }

  const std::vector<StreamInfo>& streams() const override;
  void select(const std::vector<std::size_t>& streams) override { reader_->select(streams); }
  bool read(Packet& packet) override;
  double fractionRead() const override { return reader_->fractionRead(); }
  const std::vector<RecordingFault>& faults() const override;
  std::string format() const override { return reader_->format(); }

 private:
  void open();
  void awaitFirst();

  std::string name_;
  std::unique_ptr<Spool> spool_;
  std::stop_token stop_;
  std::stop_callback<std::function<void()>> on_stop_;
  std::unique_ptr<RecordingReader> reader_;
  mutable std::vector<StreamInfo> streams_;
  mutable std::vector<RecordingFault> faults_;
};

// A table has its file's name.
const std::vector<StreamInfo>& LiveReader::streams() const {
  streams_ = reader_->streams();
  for (StreamInfo& stream : streams_)
    if (stream.name == spool_->path().filename()) stream.name = streamTypeName(stream.type);
  return streams_;
}

bool LiveReader::read(Packet& packet) {
  try {
    if (reader_->read(packet)) return true;
  } catch (const CalibrationError& error) {
    throw badInput(name_, error.problem(), error.advice());
  }
  spool_->check();
  return false;
}

// A stop ends the stream anywhere.
const std::vector<RecordingFault>& LiveReader::faults() const {
  faults_ = reader_->faults();
  for (RecordingFault& note : spool_->notes()) faults_.push_back(std::move(note));
  if (stop_.stop_requested())
    std::erase_if(faults_, [](const RecordingFault& fault) { return fault.kind == FaultKind::Truncated; });
  return faults_;
}

void LiveReader::awaitFirst() {
  const Growth& growth = *spool_->growth();
  const Clock::time_point begin = Clock::now();
  const bool is_server = name_.find("://") != std::string::npos;
  while (growth.bytes() == 0 && !growth.hasEnded()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (is_server && Clock::now() - begin > LivePatience::first_bytes)
      throw badInput(name_,
                     fmt::format("it is connected, but nothing has arrived for {:g} s",
                                 1e-3 * static_cast<double>(LivePatience::first_bytes.count())),
                     "Check that the program sends, and what this port is for");
  }
  if (growth.bytes() > 0) return;
  spool_->check();
  if (stop_.stop_requested()) throw Cancelled{};
  throw badInput(name_, "nothing arrived before its end", "Check the program that sends");
}

// Descriptions of the streams may come later than the first bytes: a recorder writes topics when they begin.
void LiveReader::open() {
  constexpr std::uint64_t kEnough_bytes = std::uint64_t{1} << 20, kMax_bytes = std::uint64_t{1} << 28;
  constexpr std::chrono::milliseconds kEnough{1000}, kAgain{200}, kMax{10'000};
  awaitFirst();
  Growth& growth = *spool_->growth();
  const Clock::time_point begin = Clock::now();
  while (growth.bytes() < kEnough_bytes && !growth.hasEnded() && Clock::now() - begin < kEnough)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  for (;;) {
    const bool last = growth.hasEnded() || Clock::now() - begin > kMax || growth.bytes() > kMax_bytes;
    try {
      reader_ = openRecording(spool_->path());
      if (hasSensor(*reader_)) break;
      spool_->check();
      if (last) break;
    } catch (const CalibrationError& error) {
      spool_->check();
      if (last) throw badInput(name_, error.problem(), error.advice());
    }
    std::this_thread::sleep_for(kAgain);
  }
  if (!reader_->follow(spool_->growth()) && !growth.hasEnded())
    throw badInput(name_, fmt::format("{} can only be read when it is complete", reader_->format()),
                   "Write it into a file first");
}

// A file that another program is still writing needs no copy.
class GrowingFileReader : public RecordingReader {
 public:
  GrowingFileReader(const std::filesystem::path& path, std::stop_token stop)
      : reader_(openRecording(path)),
        growth_(std::make_shared<Growth>(path, Growth::EndsBy::Silence)),
        on_stop_(std::move(stop), [this] { growth_->end(); }) {
    static_cast<void>(reader_->follow(growth_));
  }

  const std::vector<StreamInfo>& streams() const override { return reader_->streams(); }
  void select(const std::vector<std::size_t>& streams) override { reader_->select(streams); }
  bool read(Packet& packet) override { return reader_->read(packet); }
  double fractionRead() const override { return reader_->fractionRead(); }
  const std::vector<RecordingFault>& faults() const override { return reader_->faults(); }
  std::string format() const override { return reader_->format(); }

 private:
  std::unique_ptr<RecordingReader> reader_;
  std::shared_ptr<Growth> growth_;
  std::stop_callback<std::function<void()>> on_stop_;
};

}  // namespace

bool isLiveAddress(std::string_view source) {
  return source == kStandardInput || source.find("://") != std::string_view::npos;
}

std::string liveName(const std::string& source) {
  return source == kStandardInput ? "the standard input" : source;
}

std::unique_ptr<RecordingReader> openLive(const std::string& source, const std::filesystem::path& folder,
                                          std::stop_token stop) {
  if (!isLiveAddress(source)) return std::make_unique<GrowingFileReader>(source, std::move(stop));
  if (source != kStandardInput) static_cast<void>(liveAddress(source));
  const Spool::Fill fill = [source](Spool& spool, const std::stop_token& ended) {
    if (source == kStandardInput)
      pumpDescriptor(STDIN_FILENO, spool, ended);
    else if (source.starts_with("ws:"))
      storeFoxgloveStream(source, spool, ended);
    else
      storeDvStream(source, spool, ended);
  };
  return std::make_unique<LiveReader>(liveName(source), std::make_unique<Spool>(folder, fill),
                                      std::move(stop));
}

}  // namespace evical
