// AEDAT4, as iniVation's DV records it: events, IMU samples (in g and deg/s), frames and triggers of one or
// several cameras; triggers are listed only. The table at the end is used if it is complete,
// and not required.
#pragma once

#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/aedat/stream_description.h"
#include "core/recording/block_reader.h"
#include "core/recording/recording_reader.h"
#include "core/recording/unpacking_limit.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace evical {

class Aedat4Reader : public RecordingReader {
 public:
  explicit Aedat4Reader(const std::filesystem::path& path);

  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  bool follow(const std::shared_ptr<Growth>& growth) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return "aedat4"; }

 private:
  struct PacketHeader {
    std::int32_t stream = 0;
    std::int32_t size = 0;
    std::uint64_t position = 0;
    std::uint64_t dataPosition() const { return position + aedat::kPacketHeader_bytes; }
    std::uint64_t end() const { return dataPosition() + static_cast<std::uint64_t>(size); }
  };
  enum class HeaderState { Good, Cut, Damaged, End };
  struct StreamState {
    bool selected = true;
    std::uint64_t packets = 0, elements = 0;  // of frames and triggers so far
    EventOrder order;
  };
  struct Listed {
    std::uint64_t packets = 0, elements = 0, first_position = 0;
  };

  aedat::FileHeader readFileHeader();
  std::map<std::int32_t, Listed> listFromTable(std::int64_t position);
  std::map<std::int32_t, Listed> listByScan();
  void addStreams(std::vector<aedat::StreamDescription> described,
                  const std::map<std::int32_t, Listed>& listed);
  void takeTypeOfPackets(aedat::StreamDescription& stream, const Listed& listed);
  std::string typeOfPacket(std::uint64_t position);
  HeaderState awaitHeader(PacketHeader& header);
  HeaderState readHeader(std::uint64_t position, PacketHeader& header);
  bool looksLikeData(std::uint64_t position, std::int32_t size);
  std::uint64_t scanForPacket(std::uint64_t from);
  void resumeBehind(std::uint64_t position);
  bool nextPacket(PacketHeader& header);
  bool skipDamage(const PacketHeader& header, HeaderState state);
  bool unpack(const PacketHeader& header, std::string_view& content);
  bool unpackCounted(std::string_view packed, std::string_view& content, std::size_t& used);
  bool decode(std::size_t stream, std::string_view content, Packet& packet);
  bool decodeFrame(std::size_t stream, std::string_view content, std::vector<Frame>& frames);
  void finishEvents(std::size_t stream, Packet& packet);
  void countListed(std::size_t stream, std::string_view content);
  bool handOutRest(Packet& packet);
  void addFault(const std::string& stream, FaultKind kind, const std::string& text);

  std::string path_;
  RandomAccessFile file_;
  UnpackingLimit limit_;
  bool follows_ = false;
  std::uint64_t data_position_ = 0, position_ = 0;
  std::uint64_t table_position_ = 0;  // 0: absent or damaged
  aedat::Compression compression_ = aedat::Compression::None;
  std::unique_ptr<aedat::Unpacker> unpacker_;
  std::vector<StreamInfo> streams_;
  std::vector<StreamState> states_;
  std::map<std::int32_t, std::size_t> stream_of_id_;
  std::vector<Event> rest_;  // after a large step back in time
  std::size_t rest_stream_ = 0;
  std::vector<RecordingFault> faults_;
};

}  // namespace evical
