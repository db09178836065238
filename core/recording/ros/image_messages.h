// ROS messages with pictures: sensor_msgs/Image and sensor_msgs/CompressedImage. Pixels stay encoded
// as stored.
#pragma once

#include "core/data/frame.h"
#include "core/recording/ros/message_cursor.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace evical::ros {

// Encodings and formats that can be read, for people.
inline constexpr const char* kReadableImages =
    "mono8, mono16, 8UC1, 8UC3, 8UC4, 16UC1, rgb8, bgr8, rgba8, bgra8, bayer_*8 and bayer_*16";
inline constexpr const char* kReadablePackedImages = "jpeg and png";

bool isReadableImage(std::string_view encoding);      // "mono8"
bool isReadablePackedImage(std::string_view format);  // "jpeg", "bgr8; png compressed bgr8"; true if empty

// A message's picture and its properties; the views point into it.
struct ImageMessage {
  std::int64_t stamp_ns = 0;
  Resolution size_px;         // of packed pictures: from their header, if stated
  std::string_view encoding;  // or the format of a packed one
  bool big_endian = false;
  std::size_t row_bytes = 0;
  std::string_view bytes;
};

// False if the bytes do not fit the stated sizes.
bool parseImage(std::string_view message, Serialization serialization, ImageMessage& image);
bool parsePackedImage(std::string_view message, Serialization serialization, ImageMessage& image);

// A step that is shorter than a row; complete: the data have all rows without gaps.
struct WrongStep {
  std::uint64_t step_bytes = 0, needed_bytes = 0;
  bool complete = false;
};
std::optional<WrongStep> wrongStep(const ImageMessage& image);

// Frame of a message with a readable encoding or format; false if its numbers contradict one another, or
// packed bytes are not a picture of this format.
bool toFrame(const ImageMessage& image, Frame& frame);
bool toPackedFrame(const ImageMessage& image, Frame& frame);

// Both append a message; false, without appending, if the message cannot represent the frame: packed ones
// support JPEG and PNG only. Neither has a field for exposures.
bool encodeImage(const Frame& frame, std::uint32_t sequence, Serialization serialization,
                 std::string& message);
bool encodePackedImage(const Frame& frame, std::uint32_t sequence, Serialization serialization,
                       std::string& message);

}  // namespace evical::ros
