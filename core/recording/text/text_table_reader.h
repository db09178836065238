// Text as in the RPG event camera data set: "events.txt" with lines "t x y p", "imu.txt" with "t ax ay az gx
// gy gz"; t in s, read exactly to the ns, m/s^2, rad/s. Also one such file alone. Lines starting with '#' are
// comments; a header line that names the columns of an IMU file decides their order.
#pragma once

#include "core/recording/recording_reader.h"
#include "core/recording/text/text_lines.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace evical {

class TextTableReader : public RecordingReader {
 public:
  // A folder or a file; see isTextRecording.
  explicit TextTableReader(const std::filesystem::path& path);

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return "text"; }

 private:
  struct Source {
    TextLines lines;
    StreamType type;
    bool wanted = true;
    bool finished = false;
    std::int64_t last_ns;
    std::size_t time_column = 0, acceleration_column = 1, rate_column = 4;
    bool columns_known = false;
    Event next_event{};  // read, but it belongs to the next packet
    bool has_next_event = false;
  };

  void addSource(const std::filesystem::path& path, StreamType type);
  void fillEvents(Source& source, std::size_t stream, std::vector<Event>& events);
  void fillImu(Source& source, std::size_t stream, std::vector<ImuSample>& samples);
  bool parseImu(Source& source, std::string_view line, ImuSample& sample);
  void addBadLine(const Source& source, std::size_t stream);

  std::vector<Source> sources_;  // one a stream
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
};

// Whether a text file's first bytes look like a table of events or IMU samples; Other if not.
StreamType textTableType(std::string_view first_bytes);

}  // namespace evical
