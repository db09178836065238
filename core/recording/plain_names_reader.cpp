#include "core/recording/plain_names_reader.h"

#include "core/base/plain_text.h"

#include <algorithm>
#include <utility>

namespace evical {
namespace {

bool hasHostileName(const StreamInfo& stream) {
  return hasControl(stream.name) || hasControl(stream.source);
}

class PlainNamesReader : public RecordingReader {
 public:
  explicit PlainNamesReader(std::unique_ptr<RecordingReader> reader) : reader_(std::move(reader)) {
    std::vector<std::size_t> all(reader_->streams().size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    std::erase_if(all, [this](std::size_t i) {
      const StreamType type = reader_->streams()[i].type;
      return type != StreamType::Events && type != StreamType::Imu && type != StreamType::Points;
    });
    select(all);
  }

  const std::vector<StreamInfo>& streams() const override {
    streams_ = reader_->streams();
    for (StreamInfo& stream : streams_)
      if (hasHostileName(stream)) {
        stream.name = visible(stream.name);
        stream.source = visible(stream.source);
        stream.type = StreamType::Other;
        stream.readable = false;
      }
    return streams_;
  }

  void select(const std::vector<std::size_t>& streams) override {
    std::vector<std::size_t> wanted;
    for (const std::size_t i : streams)
      if (!hasHostileName(reader_->streams().at(i))) wanted.push_back(i);
    reader_->select(wanted);
  }

  bool read(Packet& packet) override { return reader_->read(packet); }
  bool follow(const std::shared_ptr<Growth>& growth) override { return reader_->follow(growth); }
  double fractionRead() const override { return reader_->fractionRead(); }
  std::string format() const override { return reader_->format(); }

  const std::vector<RecordingFault>& faults() const override {
    faults_ = reader_->faults();
    for (RecordingFault& fault : faults_) fault.stream = visible(fault.stream);
    for (const StreamInfo& stream : reader_->streams())
      if (hasHostileName(stream))
        faults_.push_back({visible(stream.name), FaultKind::Unreadable, 0.0,
                           "The name has a control character, so this stream is not read. Rename it in the "
                           "recording."});
    return faults_;
  }

 private:
  std::unique_ptr<RecordingReader> reader_;
  mutable std::vector<StreamInfo> streams_;
  mutable std::vector<RecordingFault> faults_;
};

}  // namespace

std::unique_ptr<RecordingReader> withPlainNames(std::unique_ptr<RecordingReader> reader) {
  const std::vector<StreamInfo>& streams = reader->streams();
  if (std::none_of(streams.begin(), streams.end(), hasHostileName)) return reader;
  return std::make_unique<PlainNamesReader>(std::move(reader));
}

}  // namespace evical
