// Background of the board: a periodic picture of overlapping flat objects on a cloudy ground, like a room.
#pragma once

#include <cstdint>
#include <vector>

namespace evical {

struct ClutterTextureOptions {
  std::uint64_t seed = 1;
  double contrast = 0.5;       // sigma of the log reflectance
  double object_share = 0.5;   // of the variance: flat objects with sharp outlines; the rest is cloudy
  double round_share = 0.0;    // of the objects: discs, the others are rectangles
  double square_texels = 0.0;  // side of the squares of other checkerboards in front of it; 0: none
  double blur_texels = 0.6;    // sigma of the optics' point spread
};

class ClutterTexture {
 public:
  explicit ClutterTexture(const ClutterTextureOptions& options);
  // The same picture with additional blur.
  ClutterTexture(const ClutterTexture& sharper, double blur_texels);

  // Log reflectance, bilinear; finite coordinates within +-kReach texels, beyond them the border's.
  float operator()(float x_texels, float y_texels) const {
    constexpr float kReach = 4000.0f;
    const float u = clamped(x_texels, kReach) + kOffset, v = clamped(y_texels, kReach) + kOffset;
    const int x = static_cast<int>(u), y = static_cast<int>(v);
    const float fx = u - static_cast<float>(x), fy = v - static_cast<float>(y);
    const float* upper = texels_.data() + (y & (kSize - 1)) * kStride + (x & (kSize - 1));
    const float* lower = texels_.data() + ((y + 1) & (kSize - 1)) * kStride + (x & (kSize - 1));
    const float above = upper[0] + fx * (upper[1] - upper[0]), below = lower[0] + fx * (lower[1] - lower[0]);
    return above + fy * (below - above);
  }

 private:
  static constexpr int kSize = 1024;              // texels per side, a power of two
  static constexpr int kStride = kSize + 1;       // repeats the first column, so that neighbours are adjacent
  static constexpr float kOffset = 4.0f * kSize;  // makes coordinates positive: truncation is floor

  static float clamped(float value, float reach) {
    return value < -reach ? -reach : (value < reach ? value : reach);  // NaN becomes reach
  }

  void takeLog(const std::vector<float>& reflectance);

  std::vector<float> texels_;
};

}  // namespace evical
