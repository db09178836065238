// Decoder of the pairs of address and time after the header of an AEDAT 2.0 file.
#pragma once

#include "core/recording/aedat/aps_frames.h"
#include "core/recording/block_decoder.h"

#include <array>
#include <cstdint>

namespace evical::aedat {

enum class AddressLayout { Dvs128, Davis };

class Aedat2Decoder : public BlockDecoder {
 public:
  // `imu_ranges`: the IMU's full scales as multiples of 4 g and 500 deg/s.
  Aedat2Decoder(AddressLayout layout, const Resolution& size_px, double imu_ranges = 1.0)
      : layout_(layout), size_px_(size_px), imu_ranges_(imu_ranges), aps_(size_px) {}

  std::size_t decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) override;
  std::vector<Frame>* frames() override { return &aps_.frames(); }
  void finish() override;

 private:
  void addApsSample(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte);
  void addLostSamples(std::uint64_t count);
  std::int64_t unwrapped_us(std::int32_t time_us, std::uint64_t byte);
  void addDvs128(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte, EventAppender& events);
  void addDavis(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte, EventAppender& events);
  void addEvent(unsigned x, unsigned y, bool brighter, std::int64_t time_ns, std::uint64_t byte,
                EventAppender& events);
  void addImuWord(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte);

  AddressLayout layout_;
  Resolution size_px_;
  double imu_ranges_;
  ApsFrames aps_;
  std::uint64_t frame_byte_ = 0;  // where the incomplete frame begins
  bool started_ = false;
  std::int32_t last_us_ = 0;
  std::int64_t wrapped_us_ = 0;  // sum of all wraps
  std::array<double, 7> imu_words_{};
  unsigned next_imu_word_ = 0;
};

inline constexpr std::size_t kAedat2Record_bytes = 8;
std::uint32_t bigEndian32(const char* bytes);

bool isDavisImuWord(std::uint32_t address);
// Number of the word: 0 to 2 are x, y and z of the acceleration.
unsigned davisImuCode(std::uint32_t address);
// Acceleration at a full scale of 4 g.
double davisAcceleration_g(std::uint32_t address);
// Coordinates of a DAVIS event in the address: from the bottom right.
bool isDavisEvent(std::uint32_t address);
unsigned davisX(std::uint32_t address);
unsigned davisY(std::uint32_t address);

}  // namespace evical::aedat
