// Decoder of the pairs of address and time after the header of an AEDAT 2.0 file.
#pragma once

#include "core/data/frame.h"
#include "core/recording/block_decoder.h"

#include <array>
#include <cstdint>
#include <vector>

// A DAVIS's frames in AEDAT 2.0: each pixel's voltage is read once after its reset and once after its
// exposure, and the frame is the difference (as jAER's DavisBaseCamera reads it).

namespace evical::aedat {

bool isApsSample(std::uint32_t address);

class ApsFrames {
 public:
  explicit ApsFrames(const Resolution& size_px) : size_px_(size_px) {}

  // Number of samples, this one or earlier ones, that belong to no complete frame.
  std::uint64_t add(std::uint32_t address, std::int64_t time_ns);
  // Number of samples of a frame that is cut by the file's end.
  std::uint64_t left() const { return read_; }

  // Complete frames since the vector was last emptied: at the middle of their exposures, brighter is larger.
  std::vector<Frame>& frames() { return frames_; }
  std::uint64_t rolling() const {
    return rolling_;
  }  // frames whose pixels are exposed one column after the other

 private:
  struct Pixel {
    std::int64_t reset_ns = 0;
    std::uint64_t order = 0;  // of its reset among all samples
    std::uint16_t reset = 0;
    bool has_reset = false, has_signal = false;
  };
  void begin();
  // The next frame began before this one was complete: with the resets since the last signal, if they belong
  // to it.
  std::uint64_t beginAnew(const Pixel& read_again);
  void takeReset(std::size_t at, std::uint16_t value, std::int64_t time_ns);
  void takeSignal(std::size_t at, std::uint16_t value, std::int64_t time_ns);
  void finish();

  Resolution size_px_;
  std::vector<Pixel> pixels_;  // row by row
  std::vector<std::uint16_t> values_;
  std::uint64_t read_ = 0;  // samples of the incomplete frame
  std::size_t signals_ = 0;
  std::uint64_t order_ = 0, last_signal_order_ = 0;
  std::int64_t last_reset_ns_ = 0, first_signal_ns_ = 0;
  double exposures_s_ = 0.0, middles_s_ = 0.0;  // sums; middles after the first reset
  std::int64_t first_reset_ns_ = 0;
  std::vector<Frame> frames_;
  std::uint64_t rolling_ = 0;
};

}  // namespace evical::aedat

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
