// Packed or nested contents of recordings, without the enclosing file, which random bytes seldom pass:
// event_camera_msgs payloads, chunks of Metavision's ECF, packets of AEDAT4, CDR messages, headers of images.
#include "core/format/picture_header.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/hdf5/hdf5_filters.h"
#include "core/recording/ros/event_packet_decoder.h"
#include "core/recording/ros/image_messages.h"
#include "core/recording/ros/ros_messages.h"

#include <array>

namespace {

using namespace evical;

// Two packets of one topic, to test a decoder's state, too.
void eventPacket(std::string_view bytes) {
  static constexpr std::array<std::string_view, 6> kEncodings = {"evt3",    "mono",        "trigger",
                                                                 "libcaer", "libcaer_cmp", "x"};
  if (bytes.size() < 2) return;
  const auto first = static_cast<unsigned char>(bytes[0]), second = static_cast<unsigned char>(bytes[1]);
  ros::EventPacket packet;
  packet.encoding = kEncodings[first % kEncodings.size()];
  packet.stamp_ns = packet.time_base_ns = 1'700'000'000'000'000'000;
  if (first & 0x80) packet.resolution_px = {64, 48};
  ros::EventPacketDecoder decoder;
  std::vector<Event> events;
  const std::string_view payload = bytes.substr(2);
  packet.events = payload.substr(0, payload.size() * second / 256);
  decoder.decode(packet, events);
  ++packet.sequence;
  packet.events = payload.substr(packet.events.size());
  decoder.decode(packet, events);
}

void message(std::string_view bytes, ros::Serialization serialization) {
  std::vector<Event> events;
  std::vector<RawImuSample> samples;
  Resolution resolution_px;
  ros::EventPacket packet;
  ros::decodeEventArray(bytes, serialization, events, resolution_px);
  ros::decodeImu(bytes, serialization, samples);
  ros::ImageMessage image;
  Frame frame;
  if (ros::parseImage(bytes, serialization, image)) ros::toFrame(image, frame);
  if (ros::parsePackedImage(bytes, serialization, image)) ros::toPackedFrame(image, frame);
  if (!ros::parseEventPacket(bytes, serialization, packet)) return;
  ros::EventPacketDecoder().decode(packet, events);
}

void aedatPacket(std::string_view bytes) {
  std::vector<Event> events;
  std::vector<RawImuSample> samples;
  aedat::decodeHeader(bytes);
  aedat::decodeTable(bytes);
  aedat::decodeEvents(bytes, events);
  aedat::decodeImu(bytes, samples);
  Frame frame;
  std::string unusable;
  aedat::decodeFrame(bytes, frame, unusable);
  aedat::countTriggers(bytes);
  aedat::packetType(bytes);
}

}  // namespace

// The first byte selects the kind of the others.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return -1;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  std::vector<hdf5::EcfEvent> events;
  switch (data[0]) {
    case 0:
      eventPacket(bytes);
      return 0;
    case 1:
      hdf5::decodeEcf(bytes, events);
      return 0;
    case 2:
      aedatPacket(bytes);
      return 0;
    case 3:
      message(bytes, ros::Serialization::Ros1);
      return 0;
    case 4:
      message(bytes, ros::Serialization::Cdr);
      return 0;
    case 5:
      pictureSize(bytes);
      return 0;
    default:
      return -1;
  }
}
