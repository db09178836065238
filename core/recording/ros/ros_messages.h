// The messages of ROS 1 that carry events and IMU samples, as the bytes of a bag (no padding, little endian).
#pragma once

#include "core/data/recording.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical::ros {

struct MessageType {
  StreamType stream;
  const char* name;        // the name we write
  const char* md5;         // of the definition: equal md5, equal layout
  const char* definition;  // so that other programs can read our bags
};
const MessageType& eventArrayType();
const MessageType& imuType();

// By md5 first, then by the fields of the definition, and where there is none by the last part of the name:
// packages get renamed and copied.
StreamType streamTypeOf(std::string_view type, std::string_view md5, std::string_view definition);

// Both replace the samples; false, and none, if the bytes do not fit what they claim or a stamp is none. The
// resolution changes only where the message states one.
bool decodeEventArray(std::string_view message, std::vector<Event>& events, Resolution& resolution_px);
bool decodeImu(std::string_view message, std::vector<ImuSample>& samples);

// Both append to `message`. Times must be within [0, 2^32) s, what a ROS time can hold.
void encodeEventArray(EventSpan events, std::uint32_t sequence, Resolution resolution_px,
                      std::string& message);
void encodeImu(const ImuSample& sample, std::uint32_t sequence, std::string& message);

}  // namespace evical::ros
