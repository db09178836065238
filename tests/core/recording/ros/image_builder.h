// Image messages byte by byte, for ROS 1 or as CDR, without the product's code.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace evical::test {

class MessageBuilder {
 public:
  explicit MessageBuilder(bool cdr, bool big_endian = false) : cdr_(cdr), big_endian_(big_endian) {}

  template <class Number>
  MessageBuilder& add(Number value) {
    while (cdr_ && body_.size() % sizeof value != 0) body_.push_back('\0');
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (big_endian_) std::reverse(bytes.begin(), bytes.end());
    body_ += bytes;
    return *this;
  }
  MessageBuilder& addHeader(std::int64_t stamp_ns) {
    if (!cdr_) add(std::uint32_t{0});
    add(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    add(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
    return addText("camera");
  }
  MessageBuilder& addText(std::string_view text) {
    add(static_cast<std::uint32_t>(text.size() + (cdr_ ? 1 : 0)));
    body_ += text;
    if (cdr_) body_.push_back('\0');
    return *this;
  }
  MessageBuilder& addBytes(std::string_view bytes) {
    add(static_cast<std::uint32_t>(bytes.size()));
    body_ += bytes;
    return *this;
  }
  std::string message() const {
    return cdr_ ? std::string(big_endian_ ? "\0\0\0\0" : "\0\1\0\0", 4) + body_ : body_;
  }

 private:
  bool cdr_, big_endian_;
  std::string body_;
};

struct TestImage {
  std::int64_t stamp_ns = 0;
  std::uint32_t width = 0, height = 0;
  std::string encoding;
  bool big_endian = false;
  std::uint32_t step = 0;
  std::string bytes;
};

inline std::string imageMessage(const TestImage& image, bool cdr, bool big_endian_message = false) {
  MessageBuilder builder(cdr, big_endian_message);
  builder.addHeader(image.stamp_ns).add(image.height).add(image.width).addText(image.encoding);
  builder.add(static_cast<std::uint8_t>(image.big_endian ? 1 : 0)).add(image.step).addBytes(image.bytes);
  return builder.message();
}

inline std::string compressedMessage(std::int64_t stamp_ns, std::string_view format, std::string_view bytes,
                                     bool cdr) {
  return MessageBuilder(cdr).addHeader(stamp_ns).addText(format).addBytes(bytes).message();
}

}  // namespace evical::test
