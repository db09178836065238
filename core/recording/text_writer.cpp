#include "core/recording/text_writer.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <iterator>

namespace evical {
namespace {

void appendInteger(std::string& text, std::int64_t value) {
  std::array<char, 24> digits;
  text.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

// Seconds with nine digits, exact.
void appendSeconds(std::string& text, std::int64_t time_ns) {
  constexpr std::uint64_t kSecond_ns = 1'000'000'000;
  if (time_ns < 0) text += '-';
  const std::uint64_t magnitude =
      time_ns < 0 ? -static_cast<std::uint64_t>(time_ns) : static_cast<std::uint64_t>(time_ns);
  appendInteger(text, static_cast<std::int64_t>(magnitude / kSecond_ns));
  text += '.';
  std::array<char, 9> digits;
  std::uint64_t rest = magnitude % kSecond_ns;
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit, rest /= 10)
    *digit = static_cast<char>('0' + rest % 10);
  text.append(digits.data(), digits.size());
}

CalibrationError onlyOne(const std::filesystem::path& directory, const char* what) {
  return badInput(directory.string(), fmt::format("a text recording holds one {} at most", what),
                  "Write a ROS bag");
}

}  // namespace

TextWriter::TextWriter(const std::filesystem::path& directory) : directory_(directory) {
  makeOutputFolder(directory);
}

std::size_t TextWriter::addEventStream(const std::string&, Resolution) {
  if (events_) throw onlyOne(directory_, "camera");
  events_ = std::make_unique<OutputFile>(directory_ / "events.txt");
  return streams_++;
}

std::size_t TextWriter::addImuStream(const std::string&) {
  if (imu_) throw onlyOne(directory_, "IMU");
  imu_ = std::make_unique<OutputFile>(directory_ / "imu.txt");
  return streams_++;
}

void TextWriter::write(std::size_t, EventSpan events) {
  text_.clear();
  for (const Event& event : events) {
    appendSeconds(text_, event.time_ns);
    text_ += ' ';
    appendInteger(text_, event.x_px);
    text_ += ' ';
    appendInteger(text_, event.y_px);
    text_ += event.brighter ? " 1\n" : " 0\n";
  }
  events_->append(text_);
}

void TextWriter::write(std::size_t, const ImuSample& sample) {
  text_.clear();
  appendSeconds(text_, sample.time_ns);
  const Eigen::Vector3d &a = sample.specific_force_m_s2, &w = sample.angular_rate_rad_s;
  fmt::format_to(std::back_inserter(text_), " {} {} {} {} {} {}\n", a.x(), a.y(), a.z(), w.x(), w.y(), w.z());
  imu_->append(text_);
}

void TextWriter::finish() {
  for (OutputFile* file : {events_.get(), imu_.get()})
    if (file != nullptr) file->close();
  for (OutputFile* file : {events_.get(), imu_.get()})
    if (file != nullptr) file->rename();
}

std::unique_ptr<RecordingWriter> createTextRecording(const std::filesystem::path& directory) {
  return std::make_unique<TextWriter>(directory);
}

}  // namespace evical
