// HDF5 in the layouts of data sets; see hdf5_layouts.h. TUM-VIE is a folder: a file "...-events_left.h5" or
// "...-events_right.h5" per camera, and "imu_data.txt".
#pragma once

#include "core/recording/block_reader.h"
#include "core/recording/recording_reader.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical {

class Hdf5Reader : public RecordingReader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path, ColumnNames names = {});
  ~Hdf5Reader() override;

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return "hdf5"; }

 private:
  struct Source;

  void addFile(const std::filesystem::path& path, const std::string& camera);
  void addImuText(const std::filesystem::path& path);
  bool fill(Source& source, Packet& packet);
  bool fillEvents(Source& source, std::vector<Event>& events);
  bool fillFrames(Source& source, std::vector<Frame>& frames);
  void noteProblem(const Source& source, const std::string& problem);
  void noteOrder(const Source& source);
  void addFault(const std::string& stream, FaultKind kind, std::string text);

  ColumnNames names_;  // datasets of streams in other layouts
  std::vector<StreamInfo> streams_;
  std::vector<std::unique_ptr<Source>> sources_;  // one per stream
  std::vector<RecordingFault> faults_;
};

// True if a folder has TUM-VIE's files of events.
bool isTumVieFolder(const std::filesystem::path& folder);
bool hasTumVieImu(const std::filesystem::path& folder);  // may exist without them

}  // namespace evical
