// ROS 1 bags, format 2.0, chunks plain, lz4 or bz2, without ROS: events from dvs_msgs/EventArray and its
// copies, IMU samples from sensor_msgs/Imu. Damaged bags give what is whole.
#pragma once

#include "core/recording/bag_chunk.h"
#include "core/recording/bag_layout.h"
#include "core/recording/fault_log.h"
#include "core/recording/input_file.h"
#include "core/recording/recording_reader.h"
#include "core/recording/ros_message.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

namespace evical {

class RosbagReader : public RecordingReader {
 public:
  explicit RosbagReader(const std::filesystem::path& path);

  std::string format() const override { return "rosbag"; }
  const std::vector<StreamInfo>& streams() const override { return streams_; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_.list(); }

 private:
  // What reading needs to know of a stream.
  struct StreamState {
    RosMessage message = RosMessage::Other;
    bool selected = true;
    bool uses_record_time = false;  // all its own stamps are zero
    std::int64_t first_ns = -1;
    // From looking ahead, at opening:
    int messages_seen = 0;
    bool only_zero_stamps = true;
  };
  // A long message is handed out in pieces.
  struct PendingEvents {
    std::size_t stream = 0;
    Bytes bytes;
    std::int64_t record_time_ns = 0;
  };

  void makeStreams();
  void lookAhead();
  void lookAhead(const BagRecord& record);
  bool lookAheadDone(std::size_t stream) const;

  template <class Predicate>
  bool chunkHas(const BagChunk& chunk, Predicate wanted) const;
  bool loadNextChunk();
  void reportChunk();
  bool readMessage(const BagRecord& record, Packet& packet);
  bool readImu(std::size_t stream, Bytes message, std::int64_t record_time_ns, Packet& packet);
  bool readEvents(std::size_t stream, Bytes message, std::int64_t record_time_ns, Packet& packet);
  bool readPendingEvents(Packet& packet);
  void reportMessage(std::size_t stream, std::int64_t record_time_ns);
  double sinceFirst(std::size_t stream, std::int64_t time_ns) const;

  InputFile file_;
  FaultLog faults_;
  BagLayout layout_;
  std::vector<StreamInfo> streams_;
  std::vector<StreamState> states_;
  std::unordered_map<std::uint32_t, std::size_t> stream_of_connection_;
  BagChunkReader chunk_;
  std::size_t next_chunk_ = 0;  // index into layout_.chunks; the one before is in chunk_
  bool chunk_loaded_ = false;
  std::uint64_t messages_in_chunk_ = 0;
  PendingEvents pending_;
};

}  // namespace evical
