#include "core/base/error.h"
#include "core/recording/part_file.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <iterator>

namespace evical {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

void appendSeconds(fmt::memory_buffer& text, std::int64_t time_ns) {
  const char* sign = time_ns < 0 ? "-" : "";
  const std::int64_t size_ns = time_ns < 0 ? -time_ns : time_ns;
  fmt::format_to(std::back_inserter(text), "{}{}.{:09}", sign, size_ns / kSecond_ns, size_ns % kSecond_ns);
}

class TextWriter : public RecordingWriter {
 public:
  TextWriter(const std::filesystem::path& folder, const std::vector<StreamInfo>& streams) {
    for (const StreamInfo& stream : streams) {
      const bool events = stream.type == StreamType::Events;
      if (!events && stream.type != StreamType::Imu) {
        throw badInput(folder.string(),
                       fmt::format("stream {} holds neither events nor IMU samples", stream.name));
      }
      for (const auto& [type, file] : files_) {
        if (type == stream.type)
          throw badInput(folder.string(), "text holds one stream of each type only", "Write a bag.");
      }
      files_.emplace_back(stream.type,
                          std::make_unique<PartFile>(folder / (events ? "events.txt" : "imu.txt")));
    }
  }

  void write(std::size_t stream, EventSpan events) override {
    text_.clear();
    for (const Event& event : events) {
      appendSeconds(text_, event.time_ns);
      fmt::format_to(std::back_inserter(text_), " {} {} {}\n", event.x_px, event.y_px,
                     event.brighter ? 1 : 0);
    }
    files_.at(stream).second->append({text_.data(), text_.size()});
  }

  void write(std::size_t stream, std::span<const ImuSample> samples) override {
    text_.clear();
    for (const ImuSample& sample : samples) {
      appendSeconds(text_, sample.time_ns);
      // {} writes as many digits as bring the same number back.
      for (const double value : sample.specific_force_m_s2)
        fmt::format_to(std::back_inserter(text_), " {}", value);
      for (const double value : sample.angular_rate_rad_s)
        fmt::format_to(std::back_inserter(text_), " {}", value);
      text_.push_back('\n');
    }
    files_.at(stream).second->append({text_.data(), text_.size()});
  }

  void finish() override {
    for (auto& [type, file] : files_) file->finish();
  }

 private:
  std::vector<std::pair<StreamType, std::unique_ptr<PartFile>>> files_;
  fmt::memory_buffer text_;
};

}  // namespace

std::unique_ptr<RecordingWriter> createText(const std::filesystem::path& folder,
                                            const std::vector<StreamInfo>& streams) {
  return std::make_unique<TextWriter>(folder, streams);
}

}  // namespace evical
