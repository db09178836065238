// Writes recordings that we and others can read. A file appears under its name only when it is complete:
// until finish() it has another name in the same folder, and it is removed when something fails or finish()
// is never called.
#pragma once

#include "core/data/recording.h"

#include <cstddef>
#include <cstdint>
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
  // writer converts them to what its format states. All throw CalibrationError (CalibrationFailed),
  // e.g. on a full disk.
  virtual void write(std::size_t stream, EventSpan events) = 0;
  virtual void write(std::size_t stream, std::span<const ImuSample> samples) = 0;
  // Encoded or not; of one stream either all encoded or none. Only if RecordingFormat::frames allows it.
  virtual void writeFrame(std::size_t stream, const Frame& frame);
  virtual void finish() = 0;

  // The time that is 0 in the file, once something has been written. Not 0 only for formats that cannot store
  // the times.
  virtual std::int64_t origin_ns() const { return 0; }

  // Names that readers will give to the streams given at creation, in their order: not every format keeps
  // names.
  virtual std::vector<std::string> streamNames() const = 0;
};

// A ROS 1 bag with dvs_msgs/EventArray, sensor_msgs/Imu and, of frames, Image or (of JPEG and PNG files) CompressedImage,
// which have no place for exposures; a stream's name is its topic, an event stream needs its resolution. Times must be
// within [0, 2^32) s.
std::unique_ptr<RecordingWriter> createBag(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams, bool lz4);

// AEDAT4 with lz4 or zstd, as DV plays it; times are rounded to the us, IMU samples become 32 bit numbers.
// Event streams need their resolution. Streams are numbered in the order given, and called as dv-processing looks for them
// where a camera has one of a type ("events", "imu"); see RecordingWriter::streamNames.
std::unique_ptr<RecordingWriter> createAedat4(const std::filesystem::path& path,
                                              const std::vector<StreamInfo>& streams, bool zstd);

// HDF5 in DSEC's layout: one camera and, in a group "imu" that DSEC itself does not have, one IMU in SI
// units. Times are rounded to the us and at most 71 minutes behind the first event; none is before it.
std::unique_ptr<RecordingWriter> createDsec(const std::filesystem::path& path,
                                            const std::vector<StreamInfo>& streams);

// An MCAP file as ROS 2 records it, of the same messages in CDR, with ros2msg schemas and a summary. Times
// must be within [0, 2^31) s.
enum class McapCompression { None, Lz4, Zstd };
std::unique_ptr<RecordingWriter> createMcap(const std::filesystem::path& path,
                                            const std::vector<StreamInfo>& streams,
                                            McapCompression compression);

// "events.txt" and "imu.txt" in an existing folder; at most one stream of each type.
std::unique_ptr<RecordingWriter> createText(const std::filesystem::path& folder,
                                            const std::vector<StreamInfo>& streams);

// "events.csv" with the columns t_ns, x, y, p and "imu.csv" as EuRoC has it, in an existing folder; at most
// one stream of each type.
std::unique_ptr<RecordingWriter> createCsv(const std::filesystem::path& folder,
                                           const std::vector<StreamInfo>& streams);

// Prophesee's RAW (EVT 3.0) and DAT: the events of one camera whose resolution is known. Times are rounded down to 1 us. They
// count from the first event if it is later than one hour.
std::unique_ptr<RecordingWriter> createRaw(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams);
std::unique_ptr<RecordingWriter> createDat(const std::filesystem::path& path,
                                           const std::vector<StreamInfo>& streams);

// One that can be written; the table is in create_recording.cpp.
struct RecordingFormat {
  const char* name;         // as people choose it: "bag"
  const char* extension;    // ".bag"; empty: the recording is a folder
  const char* description;  // for people
  std::unique_ptr<RecordingWriter> (*create)(const std::filesystem::path& path,
                                             const std::vector<StreamInfo>& streams);
  bool frames = false;      // also has frames
  bool one_camera = false;  // supports the events of one camera only
  bool isFolder() const { return *extension == '\0'; }
};
std::span<const RecordingFormat> recordingFormats();

// Throws CalibrationError (BadInput) that lists those there are.
const RecordingFormat& recordingFormat(std::string_view name);

// The format by the path's extension; throws CalibrationError (BadInput) where it is not that of one.
const RecordingFormat& recordingFormatOf(const std::filesystem::path& path);

// A folder must exist. Throws as the format's own function does.
std::unique_ptr<RecordingWriter> createRecording(const std::filesystem::path& path, const std::string& format,
                                                 const std::vector<StreamInfo>& streams);

}  // namespace evical
