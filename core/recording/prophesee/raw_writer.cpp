#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/part_file.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace evical {
namespace {

// Prophesee's files count from the camera's start: what begins later than a counter's turn is counted from its first event.
constexpr std::int64_t kLatestStart_ns = (std::int64_t{1} << 24) * kMicrosecond_ns;

// One event stream as the words of a coding.
class EventFileWriter : public RecordingWriter {
 public:
  EventFileWriter(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
                  const char* format, int largest_side_px)
      : file_(path) {
    if (streams.size() != 1 || streams.front().type != StreamType::Events)
      throw badInput(path.string(), fmt::format("{} holds the events of one camera and nothing else", format),
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
      if (!origin_ns_) origin_ns_ = event.time_ns > kLatestStart_ns || event.time_ns < 0 ? event.time_ns : 0;
      // What is out of order by so much that it is before the first event has no time here.
      const std::int64_t time_us = std::max<std::int64_t>((event.time_ns - *origin_ns_) / kMicrosecond_ns, 0);
      append(event, time_us);
    }
    file_.append(bytes_);
  }
  void write(std::size_t, std::span<const ImuSample>) final {
    throw badInput("recording", "this format holds no IMU samples", "Write a bag");
  }
  void finish() final { file_.finish(); }
  std::vector<std::string> streamNames() const final { return {"events"}; }

 protected:
  virtual void append(const Event& event, std::int64_t time_us) = 0;

  PartFile file_;
  Resolution size_px_;
  std::string bytes_;

 private:
  std::optional<std::int64_t> origin_ns_;
};

// EVT 3.0: words of 16 bits, of which only those are written that change. A vector of events is never made.
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
  // The counter of 24 bits turns: each of its upper halves is said once, so that readers count the turns.
  void append(const Event& event, std::int64_t time_us) override {
    constexpr int kLowBits = 12;
    time_us = std::max(time_us, last_us_);  // there is no way back, for what is a little out of order
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
