// Events in NumPy files, as saved by tonic, Metavision, event libraries and data sets: .npy, .npz, a
// folder of arrays of one field each (EVIMO2's dataset_events_t.npy, ..._xy.npy, ..._p.npy), or a folder of
// consecutively numbered files (vid2e, EventScape). numpy_layouts.h identifies the arrays of events; a
// warning states every guess. Python objects are never unpickled. Pictures and IMU samples in arrays are not
// read.
#pragma once

#include "core/recording/numpy/numpy_columns.h"
#include "core/recording/numpy/numpy_layouts.h"

#include "core/data/event.h"
#include "core/recording/block_decoder.h"
#include "core/recording/block_reader.h"
#include "core/recording/recording_reader.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

// Events from the columns of a layout, in order of the rows and in bounded memory.

namespace evical::numpy {

class EventTable {
 public:
  explicit EventTable(const EventLayout& layout);

  // Replaces `events` by those of the next rows, some 10k; false at the end. Some rows may have none.
  bool load(std::vector<Event>& events);

  std::uint64_t rowsRead() const { return blocks_.rowsRead(); }
  std::uint64_t rows() const { return rows_; }
  std::string problem() const { return blocks_.problem(); }

  // Number of omitted rows, and the first of them.
  const Occurrences& untimed() const { return untimed_; }
  const Occurrences& outside() const { return outside_; }
  const Occurrences& unpolarised() const { return unpolarised_; }

 private:
  void loadTimes(std::uint64_t first_row, std::vector<Event>& events);
  void loadPlaces(std::uint64_t first_row, std::vector<Event>& events);
  void loadPolarities(std::uint64_t first_row, std::vector<Event>& events);

  ColumnBlocks blocks_;
  std::uint64_t rows_;
  std::int64_t unit_ns_, offset_ns_;
  std::vector<unsigned char> bad_;  // of the rows of the block
  Occurrences untimed_, outside_, unpolarised_;
};

}  // namespace evical::numpy

namespace evical {

class NumpyReader : public RecordingReader {
 public:
  // Throws CalibrationError (BadInput) if no arrays are events.
  explicit NumpyReader(const std::filesystem::path& path);

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return "numpy"; }

 private:
  // A stream of events.
  struct Source {
    numpy::EventLayout layout;
    std::unique_ptr<numpy::EventTable> table;  // of the current file
    std::size_t next_file = 0;
    bool wanted = true, finished = false;
    std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
    std::vector<Event> rest;  // after a large step back in time
    EventOrder order;
    std::uint64_t untimed = 0, outside = 0;
  };

  void addArrays(const std::vector<numpy::Array>& arrays);
  void addStream(const numpy::EventLayout& layout);
  void noteLeftOut(const std::vector<const numpy::Array*>& others);
  [[noreturn]] void failWithNames(const std::vector<numpy::Array>& arrays,
                                  const std::vector<std::string>& problems) const;
  bool fill(Source& source, std::vector<Event>& events);
  bool openNext(Source& source);
  void closeTable(Source& source);
  void finish(Source& source);
  void addFault(const std::string& stream, FaultKind kind, const std::string& text);

  std::filesystem::path path_;
  std::vector<std::filesystem::path> files_;  // of a folder of numbered files
  std::vector<Source> sources_;               // of the streams of events, which come first
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
};

// True if a file is an array, or an archive of arrays.
bool isNumpyFile(const std::filesystem::path& path, std::string_view first_bytes);

// True if a folder's arrays are events by their names, or numbered.
bool isNumpyFolder(const std::filesystem::path& folder);

}  // namespace evical
