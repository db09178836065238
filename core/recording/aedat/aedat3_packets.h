// Packets of an AEDAT 3.1 file: a header of 28 bytes, and events of one type and size. Times are us since the
// device began. Source: iniVation's "AEDAT file formats", libcaer.
#pragma once

#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/data/imu_units.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::aedat3 {

inline constexpr std::size_t kHeader_bytes = 28;
enum class Type : std::int16_t { Special, Polarity, Frame, Imu6, Imu9, Other };

struct PacketHeader {
  Type type = Type::Other;
  int source = 0;
  std::uint64_t event_bytes = 0;
  std::int64_t overflow = 0;  // of the events' 31 bits of time
  std::uint64_t events = 0;   // including invalid ones
  std::uint64_t valid = 0;
  std::uint64_t dataBytes() const { return event_bytes * events; }
};

// nullopt if the numbers contradict one another.
std::optional<PacketHeader> decodeHeader(std::string_view bytes);

// All append, from the packet's bytes after its header; false if there are invalid times, or frames larger
// than their declared size: these are skipped.
bool decodePolarity(const PacketHeader& header, std::string_view bytes, std::vector<Event>& events);
bool decodeImu(const PacketHeader& header, std::string_view bytes, std::vector<RawImuSample>& samples);
// `unusable` completes a sentence on frames that are intact but skipped; empty otherwise.
bool decodeFrames(const PacketHeader& header, std::string_view bytes, std::vector<Frame>& frames,
                  std::string& unusable);

struct SpecialCounts {
  std::uint64_t triggers = 0, resets = 0;  // of the clock
};
SpecialCounts countSpecial(const PacketHeader& header, std::string_view bytes);

}  // namespace evical::aedat3
