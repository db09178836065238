// Text and CSV, one table per file: events, IMU samples, or points of a board that another program found.
// Columns are identified by the names in the header line or in the session (text_columns.h). A folder with
// "events.txt" and "imu.txt" as in the RPG event camera data set, or "events.csv" and "imu.csv", or one such
// file alone. Times are read exactly to the ns. Lines starting with '#' or '%' are comments. Files may be
// packed with gzip.
#pragma once

#include "core/recording/recording_reader.h"
#include "core/recording/text/text_columns.h"
#include "core/recording/text/text_lines.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

class TextTableReader : public RecordingReader {
 public:
  // A folder or a file. Throws CalibrationError (BadInput) if the columns of one cannot be identified.
  explicit TextTableReader(const std::filesystem::path& path, const ColumnNames& names = {});

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  bool follow(const std::shared_ptr<Growth>& growth) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return format_; }

 private:
  struct Source {
    TextLines lines;
    TextColumns columns;
    std::size_t width;  // columns that a line must have
    bool wanted = true;
    bool finished = false;
    std::int64_t last_ns;
    Event next_event{};  // already read; belongs to the next packet
    bool has_next_event = false;
    std::optional<MeasuredPoint> next_point = {};  // as next_event
    std::uint64_t other_types = 0;                 // lines of other types than events
    std::uint64_t bad_lines = 0;                   // left out
    std::optional<std::int64_t> clock_ns = {};     // the last time of day
    std::int64_t days_ns = 0;                      // whole days since the first one
  };

  void addTable(const std::filesystem::path& path, const std::string& names);
  void addSource(const std::filesystem::path& path, TextColumns columns);
  void addUnreadSensors(const std::filesystem::path& folder, const ColumnNames& names);
  static void addDay(Source& source, std::int64_t& time_ns);
  void fillEvents(Source& source, std::size_t stream, std::vector<Event>& events);
  void fillImu(Source& source, std::size_t stream, std::vector<RawImuSample>& samples);
  void fillPoints(Source& source, std::size_t stream, std::vector<MeasuredPoint>& points);
  void finish(Source& source, std::size_t stream);
  bool parsePoint(const Source& source, std::string_view line, MeasuredPoint& point);
  bool parseEvent(const Source& source, std::string_view line, Event& event);
  bool parseImu(const Source& source, std::string_view line, RawImuSample& sample);
  bool isOtherType(const Source& source) const;
  bool isNoRow(const Source& source, std::string_view line) const;
  void addBadLine(Source& source, std::size_t stream);

  std::vector<Source> sources_;  // one per stream
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
  std::string format_ = "text";
  std::vector<std::string_view> parts_;  // of a line
};

// True if a file, packed or not, is a table of events, IMU samples or points, or one with unidentified
// columns.
bool isTextTable(const std::filesystem::path& file);

// True if a folder has files that this reader recognises by name.
bool isTextFolder(const std::filesystem::path& folder);

// True if a folder has other tables of IMUs, or of a gyroscope or an accelerometer, or tables with these
// names.
bool hasImuTables(const std::filesystem::path& folder, const ColumnNames& names);

}  // namespace evical
