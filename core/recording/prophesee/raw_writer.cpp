#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace evical {
namespace {

// Below the period of DAT's counter, 71 minutes. RAW grows by 2 bytes in 4 ms of a pause.
constexpr std::int64_t kLongestPause_us = 3'600'000'000;
// Times in Prophesee's files count from the start of the camera. A recording that starts later is written
// with times from its first event.
constexpr std::int64_t kLatestStart_ns = kLongestPause_us * kMicrosecond_ns;

// One event stream, encoded as words.
class EventFileWriter : public RecordingWriter {
 public:
  EventFileWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
                  const char* format, int largest_side_px)
      : file_(path), path_(path) {
    if (streams.size() != 1 || streams.front().type != StreamType::Events)
      throw badInput(path.string(), fmt::format("{} can only contain the events of one camera", format),
                     "Name that stream, or write a bag");
    const Resolution size_px = streams.front().resolution_px;
    if (!size_px.known() || size_px.width_px > largest_side_px || size_px.height_px > largest_side_px)
      throw badInput(
          path.string(),
          fmt::format("{} needs the sensor's size, at most {} pixels a side", format, largest_side_px),
          "Write a bag");
    size_px_ = size_px;
  }

  void write(std::size_t, EventSpan events) final {
    bytes_.clear();
    for (const Event& event : events) {
      if (event.x_px >= size_px_.width_px || event.y_px >= size_px_.height_px)
        throw badInput(path_.string(),
                       fmt::format("an event at ({}, {}) is outside the sensor of {} x {}", event.x_px,
                                   event.y_px, size_px_.width_px, size_px_.height_px),
                       "Give the sensor's size, or write a bag");
      if (!origin_ns_) origin_ns_ = event.time_ns > kLatestStart_ns || event.time_ns < 0 ? event.time_ns : 0;
      // An event that is so late that it precedes the first one cannot be represented.
      const std::int64_t time_us = std::max<std::int64_t>((event.time_ns - *origin_ns_) / kMicrosecond_ns, 0);
      if (time_us - latest_us_ > kLongestPause_us)
        throw badInput(path_.string(),
                       fmt::format("the events pause for {:.0f} s, which this format cannot represent",
                                   1e-6 * static_cast<double>(time_us - latest_us_)),
                       "Write a bag");
      latest_us_ = std::max(latest_us_, time_us);
      append(event, time_us);
    }
    file_.append(bytes_);
  }
  void write(std::size_t, std::span<const ImuSample>) final {
    throw badInput("recording", "this format cannot contain IMU samples", "Write a bag");
  }
  void finish() final { file_.finish(); }
  std::vector<std::string> streamNames() const final { return {"events"}; }
  std::int64_t origin_ns() const final { return origin_ns_.value_or(0); }

 protected:
  virtual void append(const Event& event, std::int64_t time_us) = 0;

  PartFile file_;
  std::filesystem::path path_;
  Resolution size_px_;
  std::string bytes_;

 private:
  std::optional<std::int64_t> origin_ns_;
  std::int64_t latest_us_ = 0;
};

// EVT 3.0: words of 16 bits, written only if their value changes. Vectors of events are not used.
class RawWriter final : public EventFileWriter {
 public:
  RawWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams)
      : EventFileWriter(path, streams, "RAW (EVT3)", 1 << 11) {
    file_.append(fmt::format("% evt 3.0\n% format EVT3;height={1};width={0}\n% geometry {0}x{1}\n% end\n",
                             size_px_.width_px, size_px_.height_px));
  }

 private:
  void word(unsigned code, std::int64_t value) {
    bytes_ += numberBytes(static_cast<std::uint16_t>(code << 12 | (static_cast<unsigned>(value) & 0xFFFU)));
  }
  // The 24-bit counter overflows. Each value of its upper half is written, so that readers can count the
  // overflows.
  void append(const Event& event, std::int64_t time_us) override {
    constexpr int kLowBits = 12;
    time_us = std::max(time_us, last_us_);  // times cannot decrease: slightly late events get the latest time
    const std::int64_t high = time_us >> kLowBits;
    const bool moved = high != high_;
    while (high_ < high) word(0x8, ++high_);
    if (moved || time_us != last_us_) word(0x6, time_us);
    if (event.y_px != y_px_) word(0x0, event.y_px);
    word(0x2, event.x_px | (event.brighter ? 0x800 : 0));
    last_us_ = time_us;
    y_px_ = event.y_px;
  }

  std::int64_t high_ = -1, last_us_ = -1;
  int y_px_ = -1;
};

class DatWriter final : public EventFileWriter {
 public:
  DatWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams)
      : EventFileWriter(path, streams, "DAT", 1 << 14) {
    constexpr char kContrast = 0x0C, kEvent_bytes = 8;
    file_.append(fmt::format("% Data file containing CD events.\n% Version 2\n% Width {}\n% Height {}\n",
                             size_px_.width_px, size_px_.height_px));
    file_.append(std::string{kContrast, kEvent_bytes});
  }

 private:
  void append(const Event& event, std::int64_t time_us) override {
    constexpr int kYFrom = 14, kPolarityFrom = 28;
    bytes_ += numberBytes(static_cast<std::uint32_t>(time_us));
    bytes_ += numberBytes(static_cast<std::uint32_t>(event.x_px) |
                          static_cast<std::uint32_t>(event.y_px) << kYFrom |
                          (event.brighter ? 1U << kPolarityFrom : 0U));
  }
};

}  // namespace

std::unique_ptr<RecordingWriter> createRaw(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams) {
  return std::make_unique<RawWriter>(path, streams);
}

std::unique_ptr<RecordingWriter> createDat(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams) {
  return std::make_unique<DatWriter>(path, streams);
}

}  // namespace evical
