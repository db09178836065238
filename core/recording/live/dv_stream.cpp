#include "core/recording/live/dv_stream.h"

#include "core/base/error.h"
#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/byte_cursor.h"
#include "core/recording/live/live_source.h"
#include "core/recording/live/reconnection.h"
#include "core/recording/live/socket.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

namespace evical {
namespace {

constexpr std::uint32_t kMaxHeader_bytes = 1 << 20, kMaxPacket_bytes = 1 << 26;
constexpr std::int32_t kLargestId = 9999;

class DvStream {
 public:
  DvStream(const std::string& address, Spool& spool, const std::stop_token& stop)
      : address_(address), spool_(spool), stop_(stop) {}

  void run();

 private:
  bool readHeader();
  void begin(std::string header);
  void takeHeaderless(std::string first);
  Ended readPackets();
  std::size_t checkPacket(std::string_view packet) const;
  bool readMore(std::string& bytes, std::size_t count);
  [[noreturn]] void refuse(const std::string& problem) const;

  const std::string& address_;
  Spool& spool_;
  const std::stop_token& stop_;
  Socket* socket_ = nullptr;
  std::string header_;   // of the file; empty before the first connection
  std::string pending_;  // bytes of the first packet that were read in search of a header
};

void DvStream::refuse(const std::string& problem) const {
  throw badInput(address_, problem + ": iniVation's programs send nothing like this",
                 "Give the address of dv-processing's NetworkWriter or of DV's network output");
}

// Memory follows what arrives, not what a size claims.
bool DvStream::readMore(std::string& bytes, std::size_t count) {
  constexpr std::size_t kPiece_bytes = std::size_t{1} << 20;
  while (count > 0) {
    const std::size_t piece = std::min(count, kPiece_bytes), before = bytes.size();
    bytes.resize(before + piece);
    if (!socket_->readAll(bytes.data() + before, piece)) {
      bytes.resize(before);
      return false;
    }
    count -= piece;
  }
  return true;
}

// The server repeats the header for each connection.
void DvStream::begin(std::string header) {
  if (!header_.empty() && header != header_)
    throw badInput(address_, "the server has started again with other streams", "Record again");
  if (!header_.empty()) return;
  header_ = std::move(header);
  spool_.append(aedat::kMagic);
  spool_.append(header_);
}

// False if the connection ends before.
bool DvStream::readHeader() {
  constexpr std::size_t kStart_bytes = 12;  // size, offset, type
  std::string start;
  socket_->setPatience(LivePatience::first_bytes);
  if (!readMore(start, kStart_bytes)) return false;
  if (start.substr(8) != "IOHE") {
    takeHeaderless(std::move(start));
    return true;
  }
  const auto size = ByteCursor(start).number<std::uint32_t>();
  if (size < kStart_bytes || size > kMaxHeader_bytes) refuse(fmt::format("the header states {} bytes", size));
  if (!readMore(start, size + sizeof size - kStart_bytes)) return false;
  const auto header = aedat::decodeHeader(start);
  if (!header || header->compression < 0 || header->compression >= aedat::kCompressions)
    refuse("the header is damaged");
  begin(std::move(start));
  return true;
}

// Bytes of a packet's content.
std::size_t DvStream::checkPacket(std::string_view packet) const {
  ByteCursor cursor(packet);
  const auto stream = cursor.number<std::int32_t>(), size = cursor.number<std::int32_t>();
  if (stream < 0 || stream > kLargestId || size <= 0 || static_cast<std::uint32_t>(size) > kMaxPacket_bytes)
    refuse(fmt::format("a packet of stream {} states {} bytes", stream, size));
  return static_cast<std::size_t>(size);
}

// The first packet shows how they are packed.
void DvStream::takeHeaderless(std::string first) {
  checkPacket(first);
  aedat::FileHeader header;
  const std::string_view body = std::string_view(first).substr(aedat::kPacketHeader_bytes);
  for (const auto packed : {aedat::Compression::Lz4, aedat::Compression::Zstd})
    if (body.starts_with(aedat::frameMagic(packed))) header.compression = static_cast<std::int32_t>(packed);
  pending_ = std::move(first);
  std::size_t unused = 0;
  begin(aedat::encodeHeader(header, unused));
}

Ended DvStream::readPackets() {
  for (;;) {
    std::string packet = std::exchange(pending_, {});
    const bool started = !packet.empty();
    if (packet.size() < aedat::kPacketHeader_bytes &&
        !readMore(packet, aedat::kPacketHeader_bytes - packet.size()))
      return packet.empty() ? Ended::Closed : Ended::Broken;
    const std::size_t whole = aedat::kPacketHeader_bytes + checkPacket(packet);
    if (started && packet.size() > whole) refuse("the first packet is too short");
    if (!readMore(packet, whole - packet.size())) return Ended::Broken;
    spool_.append(packet);
  }
}

void DvStream::run() {
  keepConnected<Socket>(
      spool_, stop_, [this] { return Socket(liveAddress(address_), stop_); },
      [this](Socket& socket) {
        socket_ = &socket;
        const bool has_header = readHeader();
        if (!has_header && header_.empty()) return Ended::NothingCame;
        socket.setPatience(Socket::kForever);
        return has_header ? readPackets() : Ended::Broken;
      });
}

}  // namespace

void storeDvStream(const std::string& address, Spool& spool, const std::stop_token& stop) {
  DvStream(address, spool, stop).run();
}

}  // namespace evical
