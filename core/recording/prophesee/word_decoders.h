// Decoders of RAW and DAT files, in blocks of a file. Times are us in the files, ns here; the counter's wraps
// are added.
#pragma once

#include "core/recording/block_decoder.h"
#include "core/recording/prophesee/evt3_decoder.h"
#include "core/recording/prophesee/raw_header.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace evical::prophesee {

// Counter with a fixed number of bits that wraps when it is full. Only a step from its last quarter to its
// first is a wrap; other steps back are unchanged. A step to the last quarter soon after is disorder at the
// wrap.
class WrappingCounter {
 public:
  explicit WrappingCounter(int bits) : bits_(bits) {}

  // Count including all wraps; sets `wrapped` if this is one.
  std::uint64_t unwrap(std::uint64_t count, bool& wrapped) {
    const std::uint64_t quarter = count >> (bits_ - 2), last_quarter = last_ >> (bits_ - 2);
    wrapped = last_quarter == 3 && quarter == 0;
    if (wrapped) ++wraps_;
    const bool before_wrap = wraps_ > 0 && last_quarter == 0 && quarter == 3;
    if (!before_wrap) last_ = count;
    return ((wraps_ - (before_wrap ? 1 : 0)) << bits_) + count;
  }

 private:
  int bits_;
  std::uint64_t last_ = 0, wraps_ = 0;
};

class Evt2Decoder : public BlockDecoder {
 public:
  explicit Evt2Decoder(const Resolution& size_px) : area_(size_px) {}
  std::size_t decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) override;

 private:
  void other(std::uint32_t word, std::uint64_t byte);

  SensorArea area_;
  WrappingCounter high_{28};
  bool has_time_ = false;
  std::int64_t high_ns_ = 0;
};

class Evt21Decoder : public BlockDecoder {
 public:
  Evt21Decoder(const Resolution& size_px, bool halves_exchanged)
      : area_(size_px), halves_exchanged_(halves_exchanged) {}
  std::size_t decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) override;

 private:
  void other(std::uint64_t word, std::uint64_t byte);
  void vector(std::uint64_t word, std::uint64_t byte, EventAppender& events);

  SensorArea area_;
  bool halves_exchanged_;
  WrappingCounter high_{28};
  bool has_time_ = false;
  std::int64_t high_ns_ = 0;
};

// True if the first words of the data are more plausible with their halves exchanged.
bool looksExchanged(std::string_view data);

class Evt3BlockDecoder : public BlockDecoder {
 public:
  explicit Evt3BlockDecoder(const Resolution& size_px) : decoder_(size_px) {}
  std::size_t decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) override;

 private:
  Evt3Decoder decoder_;
};

class DatDecoder : public BlockDecoder {
 public:
  explicit DatDecoder(const FileHeader& header)
      : area_(header.resolution_px), old_(header.version < 2), triggers_(header.event_type == 14) {}
  std::size_t decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) override;

 private:
  SensorArea area_;
  bool old_, triggers_;
  WrappingCounter time_{32};
};

}  // namespace evical::prophesee
