// Reads files with a header and then packed events, in blocks of a fixed size: one stream of events, and one
// each of IMU samples, frames and triggers if the format has them. Faults report anomalies and the byte at
// which each began.
#pragma once

#include "core/recording/block_decoder.h"
#include "core/recording/live/growth.h"
#include "core/recording/recording_reader.h"

#include "core/data/event.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace evical {

struct BlockFormat {
  std::string name;                   // of the family: "prophesee_raw"
  std::vector<StreamInfo> streams;    // events first, if any; then IMU samples, frames, triggers
  std::uint64_t data_offset = 0;      // after the header
  std::vector<RecordingFault> notes;  // faults of the header
};

class BlockReader : public RecordingReader {
 public:
  BlockReader(const std::filesystem::path& path, BlockFormat format, std::unique_ptr<BlockDecoder> decoder);

  const std::vector<StreamInfo>& streams() const override { return format_.streams; }
  void select(const std::vector<std::size_t>& streams) override;
  bool read(Packet& packet) override;
  bool follow(const std::shared_ptr<Growth>& growth) override;
  double fractionRead() const override;
  const std::vector<RecordingFault>& faults() const override { return faults_; }
  std::string format() const override { return format_.name; }

 private:
  bool decodeBlock();
  std::size_t readBlock(char* bytes);
  bool handOut(Packet& packet);
  bool handOutSamples(Packet& packet);
  bool handOutFrames(Packet& packet);
  std::size_t streamOf(StreamType type) const;  // the number of streams if there is none
  void finish();
  void addFault(FaultKind kind, std::string text);

  BlockFormat format_;
  std::unique_ptr<BlockDecoder> decoder_;
  std::ifstream file_;
  std::shared_ptr<Growth> growth_;
  std::uint64_t file_size_ = 0, position_ = 0;  // of bytes_'s end in the file
  std::string bytes_;                           // read, not yet decoded
  std::vector<Event> decoded_;
  std::size_t handed_out_ = 0;  // of decoded_
  std::vector<RecordingFault> faults_;
  std::size_t imu_stream_ = 0, frames_stream_ = 0;
  bool events_wanted_ = true, imu_wanted_ = true, finished_ = false;
  bool frames_wanted_ = false;  // until they are selected
  std::uint64_t disordered_ = 0;
  std::int64_t largest_disorder_ns_ = 0;
};

// Sorts the events of one stream into the order that packets guarantee, and counts the corrections.

// Largest step back in time that readers sort.
inline constexpr std::int64_t kLargestSorted_ns = 10'000'000;

class EventOrder {
 public:
  // Keeps in `events` those of the next packet: they are sorted if time steps back a little; the packet ends
  // before a large step back, since sorting would hide it, and the events after it replace `rest`.
  void split(std::vector<Event>& events, std::vector<Event>& rest);

  bool changedAnything() const { return disordered_ > 0; }
  std::string text() const;  // one sentence for people

 private:
  std::size_t arrange(std::span<Event> events);  // number of first events in the packet

  std::uint64_t disordered_ = 0;
  std::int64_t largest_ns_ = 0;
};

// Random access to a file's bytes, read in large blocks.
class RandomAccessFile {
 public:
  // Throws CalibrationError (BadInput) if the file cannot be opened.
  explicit RandomAccessFile(const std::filesystem::path& path);

  // At opening; of a file that grows, when it was last looked at.
  std::uint64_t size() const { return size_; }

  void follow(std::shared_ptr<Growth> growth) { growth_ = std::move(growth); }
  // Whether the file has so many bytes. Waits for them in a file that grows, unless they are implausibly
  // many.
  bool reaches(std::uint64_t bytes);
  // Waits until a file that grows has ended.
  void awaitEnd();

  // Bytes, valid until the next call; false unless all of them exist.
  bool read(std::uint64_t position, std::uint64_t count, std::string_view& bytes);

 private:
  void look(std::uint64_t bytes);

  std::ifstream file_;
  std::shared_ptr<Growth> growth_;
  std::uint64_t size_ = 0;
  std::string block_;
  std::uint64_t block_position_ = 0;
};

}  // namespace evical
