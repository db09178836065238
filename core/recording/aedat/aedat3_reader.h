// AEDAT 3.1, as cAER and jAER record it: events, IMU samples (in g and deg/s) and frames of one or several
// cameras; triggers are listed only.
#pragma once

#include "core/recording/aedat/aedat3_packets.h"
#include "core/recording/block_reader.h"
#include "core/recording/recording_reader.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace evical {

inline constexpr std::string_view kAedat3Magic = "#!AER-DAT3.1";

class Aedat3Reader : public RecordingReader {
 public:
  explicit Aedat3Reader(const std::filesystem::path& path);

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return "aedat3"; }

 private:
  using Key = std::pair<int, StreamType>;  // source, type of its data
  struct State {
    bool selected = false;
    std::uint64_t counted = 0;  // triggers
    EventOrder order;
  };

  void readFileHeader();
  void listStreams();
  void addStream(const Key& key, std::uint64_t count, bool several_sources);
  bool nextPacket(aedat3::PacketHeader& header, std::uint64_t& position, bool say);
  bool isHeaderAt(std::uint64_t position, aedat3::PacketHeader& header);
  std::uint64_t findHeader(std::uint64_t from);
  void decode(std::size_t stream, const aedat3::PacketHeader& header, std::uint64_t position, Packet& packet);
  bool decodeContent(std::size_t stream, const aedat3::PacketHeader& header, std::string_view bytes,
                     Packet& packet);
  void countSpecial(std::size_t stream, const aedat3::PacketHeader& header, std::string_view bytes);
  void putInOrder(std::size_t stream, std::vector<Event>& events);
  bool handOutRest(Packet& packet);
  void addFault(const std::string& stream, FaultKind kind, const std::string& text);

  std::string path_;
  RandomAccessFile file_;
  std::uint64_t data_position_ = 0, position_ = 0;
  std::map<int, std::string> sources_;  // "DAVIS240C", if the header names them
  std::map<Key, std::size_t> stream_of_key_;
  std::vector<StreamInfo> streams_;
  std::vector<State> states_;
  std::vector<Event> rest_;  // after a large step back in time
  std::size_t rest_stream_ = 0;
  std::uint64_t resets_ = 0;
  std::vector<RecordingFault> faults_;
};

}  // namespace evical
