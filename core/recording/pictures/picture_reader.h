// Folders of pictures as streams of encoded frames; see picture_lists.h. Names and times of all pictures are
// in memory (some 100 bytes each), and the content of one picture at a time.
#pragma once

#include "core/recording/pictures/picture_lists.h"
#include "core/recording/recording_reader.h"

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

class PictureReader : public RecordingReader {
 public:
  explicit PictureReader(std::vector<pictures::PictureList> lists);

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return "pictures"; }

 private:
  struct Source {
    pictures::PictureList list;
    bool wanted = false;  // frames are not read by default
    std::size_t next = 0;
    bool finished() const { return !wanted || next >= list.pictures.size(); }
  };

  bool load(std::size_t stream, const pictures::Picture& picture, Frame& frame);
  void addFault(std::size_t stream, FaultKind kind, std::string text);

  std::vector<Source> sources_;  // one per stream
  std::vector<StreamInfo> streams_;
  std::vector<RecordingFault> faults_;
};

}  // namespace evical
