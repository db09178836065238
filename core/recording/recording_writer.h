// Writers of recordings that Evical and other programs can read. A file gets its name only when it is
// complete: until finish(), or flush(), it has another name in the same folder; it is removed after errors or
// without finish().
#pragma once

#include "core/data/recording.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

class RecordingWriter {
 public:
  virtual ~RecordingWriter() = default;

  // `stream` is an index into the streams given at creation; times should not decrease within a stream,
  // and streams should be written alternately, some 10 ms each. IMU samples are given in SI units; a
  // writer converts them to the units of its format. All throw CalibrationError (CalibrationFailed),
  // e.g. on a full disk.
  virtual void write(std::size_t stream, EventSpan events) = 0;
  virtual void write(std::size_t stream, std::span<const ImuSample> samples) = 0;
  // Encoded or not; all frames of a stream alike. Only if RecordingFormat::frames allows it.
  virtual void writeFrame(std::size_t stream, const Frame& frame);
  virtual void finish() = 0;
  // Everything so far is in the file, which has its name from now on and remains without finish(). For
  // recordings of live streams, if RecordingFormat::live allows it.
  virtual void flush();

  // Time of 0 in the file, after the first write. Not 0 only for formats that cannot represent
  // the times.
  virtual std::int64_t origin_ns() const { return 0; }

  // Names of the given streams in the written file, in their order: not every format keeps
  // names.
  virtual std::vector<std::string> streamNames() const = 0;
};

// ROS 1 bag with dvs_msgs/EventArray, sensor_msgs/Imu and, for frames, Image or (for JPEG and PNG files)
// CompressedImage, without exposures; a stream's name is its topic, an event stream needs its resolution.
// Times must be within [0, 2^32) s.
std::unique_ptr<RecordingWriter> createBag(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams, bool lz4);

// AEDAT4 with lz4 or zstd, readable by DV; times are rounded to the us, IMU samples become 32 bit numbers.
// Event streams need their resolution. Streams are numbered in the given order, and named for dv-processing
// if a camera has one of a type ("events", "imu"); see RecordingWriter::streamNames.
std::unique_ptr<RecordingWriter> createAedat4(const std::filesystem::path& path,
                                              const std::vector<StreamInfo>& streams, bool zstd);

// HDF5 in DSEC's layout: one camera and, in a group "imu" that DSEC does not have, one IMU in SI
// units. Times are rounded to the us and at most 71 minutes after the first event; none is before it.
std::unique_ptr<RecordingWriter> createDsec(const std::filesystem::path& path,
                                            const std::vector<StreamInfo>& streams);

// MCAP file as ROS 2 records it, with the same messages in CDR, ros2msg schemas and a summary. Times
// must be within [0, 2^31) s.
enum class McapCompression { None, Lz4, Zstd };
std::unique_ptr<RecordingWriter> createMcap(const std::filesystem::path& path,
                                            const std::vector<StreamInfo>& streams,
                                            McapCompression compression);

// "events.txt" and "imu.txt" in an existing folder; at most one stream of each type.
std::unique_ptr<RecordingWriter> createText(const std::filesystem::path& folder,
                                            const std::vector<StreamInfo>& streams);

// "events.csv" with the columns t_ns, x, y, p and "imu.csv" in EuRoC's format, in an existing folder; at most
// one stream of each type.
std::unique_ptr<RecordingWriter> createCsv(const std::filesystem::path& folder,
                                           const std::vector<StreamInfo>& streams);

// Prophesee's RAW (EVT 3.0) and DAT: the events of one camera with a known resolution. Times are rounded down
// to 1 us. They count from the first event if it is later than one hour.
std::unique_ptr<RecordingWriter> createRaw(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams);
std::unique_ptr<RecordingWriter> createDat(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams);

// A writable format; the table is in open_recording.cpp.
struct RecordingFormat {
  const char* name;         // as users choose it: "bag"
  const char* extension;    // ".bag"; empty: the recording is a folder
  const char* description;  // for people
  std::unique_ptr<RecordingWriter> (*create)(const std::filesystem::path& path,
                                             const std::vector<StreamInfo>& streams);
  bool frames = false;      // also has frames
  bool one_camera = false;  // supports the events of one camera only
  bool live = false;        // can be read while it is written
  bool isFolder() const { return *extension == '\0'; }
};
std::span<const RecordingFormat> recordingFormats();

// Throws CalibrationError (BadInput) that lists the formats.
const RecordingFormat& recordingFormat(std::string_view name);

// The format by the path's extension; throws CalibrationError (BadInput) for unknown ones.
const RecordingFormat& recordingFormatOf(const std::filesystem::path& path);

// A folder must exist. Throws like the format's own function.
std::unique_ptr<RecordingWriter> createRecording(const std::filesystem::path& path, const std::string& format,
                                                 const std::vector<StreamInfo>& streams);

// An output file that gets its name when it is complete.

// A number's bytes in the machine's byte order, which is that of the files: little endian.
template <class Number>
std::string numberBytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// Writes next to `path`, under another name that begins with `path`'s; finish() flushes it to the disk and
// renames it, the destructor removes it without finish(). If several write to one path, the last one to
// finish remains, complete. All functions throw CalibrationError with path and reason: BadInput if something
// other than a file exists at `path`, otherwise CalibrationFailed.
class PartFile {
 public:
  explicit PartFile(std::filesystem::path path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  void append(std::string_view bytes);
  void overwrite(std::uint64_t position,
                 std::string_view bytes);  // replaces written bytes; append() continues at the end
  std::uint64_t size() const { return size_; }
  void finish();
  // Gives the file its name already. It is not removed any more.
  void publish();

  // Path of the content until then, for libraries that write it themselves.
  const std::filesystem::path& partPath() const { return part_path_; }

 private:
  [[noreturn]] void fail(const char* what);
  void takeName();
  void close();

  std::filesystem::path path_, part_path_;
  std::FILE* file_ = nullptr;
  std::uint64_t size_ = 0;
  bool published_ = false;
};

}  // namespace evical
