#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <iterator>

namespace evical {
namespace {

// Parameters of the kinds of text.
struct TextStyle {
  const char *events_file, *imu_file;
  const char *events_header, *imu_header;
  char separator;
  bool in_seconds;  // otherwise ns
  bool rate_first;  // otherwise the specific force
};
constexpr TextStyle kPlain{"events.txt", "imu.txt", "", "", ' ', true, false};
// The IMU's header and order are those of EuRoC.
constexpr TextStyle kCsv{
    "events.csv",
    "imu.csv",
    "t_ns,x,y,p\n",
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
    "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n",
    ',',
    false,
    true};

class TextWriter : public RecordingWriter {
 public:
  TextWriter(const std::filesystem::path& folder, const std::vector<StreamInfo>& streams,
             const TextStyle& style)
      : style_(style) {
    for (const StreamInfo& stream : streams) {
      const bool events = stream.type == StreamType::Events;
      if (!events && stream.type != StreamType::Imu) {
        throw badInput(folder.string(),
                       fmt::format("stream {} has neither events nor IMU samples", stream.name));
      }
      for (const auto& [type, file] : files_) {
        if (type == stream.type)
          throw badInput(folder.string(), "text can only contain one stream of each type", "Write a bag");
      }
      files_.emplace_back(stream.type,
                          std::make_unique<PartFile>(folder / (events ? style.events_file : style.imu_file)));
      files_.back().second->append(events ? style.events_header : style.imu_header);
    }
  }

  void write(std::size_t stream, EventSpan events) override {
    text_.clear();
    for (const Event& event : events) {
      appendTime(event.time_ns);
      fmt::format_to(std::back_inserter(text_), "{0}{1}{0}{2}{0}{3}\n", style_.separator, event.x_px,
                     event.y_px, event.brighter ? 1 : 0);
    }
    files_.at(stream).second->append({text_.data(), text_.size()});
  }

  void write(std::size_t stream, std::span<const ImuSample> samples) override {
    text_.clear();
    for (const ImuSample& sample : samples) {
      appendTime(sample.time_ns);
      appendVector(style_.rate_first ? sample.angular_rate_rad_s : sample.specific_force_m_s2);
      appendVector(style_.rate_first ? sample.specific_force_m_s2 : sample.angular_rate_rad_s);
      text_.push_back('\n');
    }
    files_.at(stream).second->append({text_.data(), text_.size()});
  }

  void finish() override {
    for (auto& [type, file] : files_) file->finish();
  }

  std::vector<std::string> streamNames() const override {
    std::vector<std::string> names;
    for (const auto& [type, file] : files_)
      names.emplace_back(type == StreamType::Events ? style_.events_file : style_.imu_file);
    return names;
  }

 private:
  void appendTime(std::int64_t time_ns) {
    if (!style_.in_seconds) {
      fmt::format_to(std::back_inserter(text_), "{}", time_ns);
      return;
    }
    const char* sign = time_ns < 0 ? "-" : "";
    const std::int64_t size_ns = time_ns < 0 ? -time_ns : time_ns;
    fmt::format_to(std::back_inserter(text_), "{}{}.{:09}", sign, size_ns / kSecond_ns, size_ns % kSecond_ns);
  }

  // {} writes as many digits as needed to read the same number back.
  void appendVector(const Eigen::Vector3d& vector) {
    for (const double value : vector)
      fmt::format_to(std::back_inserter(text_), "{}{}", style_.separator, value);
  }

  const TextStyle& style_;
  std::vector<std::pair<StreamType, std::unique_ptr<PartFile>>> files_;
  fmt::memory_buffer text_;
};

}  // namespace

std::unique_ptr<RecordingWriter> createText(const std::filesystem::path& folder,
                                            const std::vector<StreamInfo>& streams) {
  return std::make_unique<TextWriter>(folder, streams, kPlain);
}

std::unique_ptr<RecordingWriter> createCsv(const std::filesystem::path& folder,
                                           const std::vector<StreamInfo>& streams) {
  return std::make_unique<TextWriter>(folder, streams, kCsv);
}

}  // namespace evical
