#include "core/base/error.h"
#include "core/base/time.h"
#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/aedat/stream_description.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

constexpr std::int64_t kAedat4PacketSpan_ns = 10'000'000;  // as of DV's cameras
constexpr std::size_t kAedat4PacketEvents = 65'536;
constexpr std::size_t kAedat4PacketSamples = 1'000;

class Aedat4Writer : public RecordingWriter {
 public:
  Aedat4Writer(const std::filesystem::path& path, const std::vector<StreamInfo>& streams,
               aedat::Compression compression)
      : path_(path.string()), file_(path), compression_(compression) {
    std::vector<aedat::StreamDescription> descriptions;
    const std::vector<aedat::DeviceName> names = aedat::deviceNames(streams);
    for (std::size_t i = 0; i < streams.size(); ++i) descriptions.push_back(describe(streams[i], names[i]));
    aedat::FileHeader header;
    header.compression = static_cast<std::int32_t>(compression);
    header.description = aedat::descriptionsXml(descriptions, aedat::compressionName(compression));
    read_names_ = aedat::uniqueNames(descriptions);
    const std::string bytes = aedat::encodeHeader(header, table_position_at_);
    table_position_at_ += aedat::kMagic.size();
    file_.append(aedat::kMagic);
    file_.append(bytes);
  }

  void write(std::size_t stream, EventSpan events) override {
    Stream& target = checked(stream, StreamType::Events);
    for (const Event& event : events) {
      if (isFull(target.events, event.time_ns, kAedat4PacketEvents)) flush(stream);
      target.events.push_back(event);
    }
  }

  void write(std::size_t stream, std::span<const ImuSample> samples) override {
    Stream& target = checked(stream, StreamType::Imu);
    for (const ImuSample& sample : samples) {
      if (isFull(target.samples, sample.time_ns, kAedat4PacketSamples)) flush(stream);
      target.samples.push_back(fromSi(sample, AccelerationUnit::Gravity, AngularRateUnit::DegreesPerSecond));
    }
  }

  void finish() override {
    for (std::size_t i = 0; i < streams_.size(); ++i) flush(i);
    const auto table_position = static_cast<std::int64_t>(file_.size());
    aedat::pack(compression_, aedat::encodeTable(table_), packed_);
    file_.append(packed_);
    file_.overwrite(table_position_at_, numberBytes(table_position));
    file_.finish();
  }

  void flush() override {
    for (std::size_t i = 0; i < streams_.size(); ++i) flush(i);
    file_.publish();
  }

  std::vector<std::string> streamNames() const override { return read_names_; }

 private:
  struct Stream {
    StreamInfo info;
    std::vector<Event> events;  // of the packet being gathered, as are the samples
    std::vector<RawImuSample> samples;
  };

  template <class Element>
  static bool isFull(const std::vector<Element>& elements, std::int64_t time_ns, std::size_t most) {
    if (elements.empty()) return false;
    return elements.size() >= most || time_ns - elements.front().time_ns >= kAedat4PacketSpan_ns;
  }

  aedat::StreamDescription describe(const StreamInfo& stream, const aedat::DeviceName& name) {
    const bool events = stream.type == StreamType::Events;
    if (!events && stream.type != StreamType::Imu) {
      throw badInput(path_, fmt::format("stream {} has neither events nor IMU samples", stream.name));
    }
    if (events && !stream.resolution_px.known()) {
      throw badInput(path_, fmt::format("the resolution of stream {} is unknown", stream.name),
                     "State it: AEDAT4 needs it");
    }
    aedat::StreamDescription description;
    description.id = static_cast<std::int32_t>(streams_.size());
    description.name = name.output;
    description.type = events ? "EVTS" : "IMUS";
    description.source = name.source;
    description.size_px = stream.resolution_px;
    streams_.push_back({stream, {}, {}});
    return description;
  }

  Stream& checked(std::size_t stream, StreamType type) {
    Stream& target = streams_.at(stream);
    if (target.info.type == type) return target;
    throw calibrationFailed(path_,
                            fmt::format("stream {} was given samples of another type", target.info.name));
  }

  void flush(std::size_t stream) {
    Stream& source = streams_[stream];
    if (!source.events.empty()) {
      append(stream, aedat::encodeEvents(source.events), source.events.size(), source.events.front().time_ns,
             source.events.back().time_ns);
    }
    if (!source.samples.empty()) {
      append(stream, aedat::encodeImu(source.samples), source.samples.size(), source.samples.front().time_ns,
             source.samples.back().time_ns);
    }
    source.events.clear();
    source.samples.clear();
  }

  void append(std::size_t stream, const std::string& content, std::size_t count, std::int64_t first_ns,
              std::int64_t last_ns) {
    aedat::pack(compression_, content, packed_);
    aedat::TableEntry entry;
    entry.position = static_cast<std::int64_t>(file_.size());
    entry.stream = static_cast<std::int32_t>(stream);
    entry.size = static_cast<std::int32_t>(packed_.size());
    entry.count = static_cast<std::int64_t>(count);
    entry.first_us = nearestMicrosecond(first_ns);
    entry.last_us = nearestMicrosecond(last_ns);
    table_.push_back(entry);
    file_.append(numberBytes(entry.stream) + numberBytes(entry.size));
    file_.append(packed_);
  }

  std::string path_;
  PartFile file_;
  aedat::Compression compression_;
  std::size_t table_position_at_ = 0;
  std::vector<Stream> streams_;
  std::vector<std::string> read_names_;
  std::vector<aedat::TableEntry> table_;
  std::string packed_;
};

}  // namespace

std::unique_ptr<RecordingWriter> createAedat4(const std::filesystem::path& path,
                                              const std::vector<StreamInfo>& streams, bool zstd) {
  return std::make_unique<Aedat4Writer>(path, streams,
                                        zstd ? aedat::Compression::Zstd : aedat::Compression::Lz4);
}

}  // namespace evical
