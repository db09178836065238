// Several readers as one recording, for folders with files of several formats: pictures, events, an IMU.
#pragma once

#include "core/recording/recording_reader.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace evical {

class JoinedReader : public RecordingReader {
 public:
  struct Part {
    std::unique_ptr<RecordingReader> reader;
    std::string name;  // of a reader's only stream; empty: unchanged
  };
  // Requires at least one part.
  explicit JoinedReader(std::vector<Part> parts);

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override;

 private:
  struct State {
    Part part;
    std::size_t first_stream = 0;
    bool wanted = true, finished = false;
    std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
    bool isRenamed() const { return !part.name.empty() && part.reader->streams().size() == 1; }
  };

  void takeStreams(const State& state);
  void gatherFaults();

  std::vector<State> states_;
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
};

}  // namespace evical
