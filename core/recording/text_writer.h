// Plain text as the RPG event camera data set has it (text_reader.h), times with nine digits behind the
// point.
#pragma once

#include "core/recording/output_file.h"
#include "core/recording/recording_writer.h"

#include <filesystem>
#include <memory>
#include <string>

namespace evical {

class TextWriter : public RecordingWriter {
 public:
  explicit TextWriter(const std::filesystem::path& directory);

  std::size_t addEventStream(const std::string& name, Resolution resolution_px) override;
  std::size_t addImuStream(const std::string& name) override;
  void write(std::size_t stream, EventSpan events) override;
  void write(std::size_t stream, const ImuSample& sample) override;
  void finish() override;

 private:
  std::filesystem::path directory_;
  std::unique_ptr<OutputFile> events_, imu_;
  std::size_t streams_ = 0;
  std::string text_;
};

}  // namespace evical
