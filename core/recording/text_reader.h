// Plain text as in the RPG event camera data set (Mueggler et al., IJRR 2017): events.txt "t x y p", imu.txt
// "t ax ay az gx gy gz", t in seconds. One of them alone, or a directory with one or both, merged by time.
#pragma once

#include "core/recording/fault_log.h"
#include "core/recording/recording_reader.h"
#include "core/recording/text_table.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

class TextReader : public RecordingReader {
 public:
  // A file, or a directory that holds events.txt or imu.txt.
  explicit TextReader(const std::filesystem::path& path);
  ~TextReader() override;

  std::string format() const override { return "text"; }
  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_.list(); }

  static bool directoryHolds(const std::filesystem::path& directory);

 private:
  struct Source;  // one file

  void addFile(const std::filesystem::path& path);
  void fill(Source& source);

  FaultLog faults_;
  std::vector<StreamInfo> streams_;
  std::vector<std::unique_ptr<Source>> sources_;  // one a stream, in the same order
};

}  // namespace evical
