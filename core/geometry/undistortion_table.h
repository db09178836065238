// Ideal pixels (camera_model.h) of every pixel of a camera, computed once.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace evical {

struct CameraIntrinsics;

// The ideal pixel of every pixel, row by row; NaN if there is none.
class UndistortionTable {
 public:
  UndistortionTable() = default;
  explicit UndistortionTable(const CameraIntrinsics& camera);

  const Eigen::Vector2f& operator()(int x_px, int y_px) const {
    return ideal_px_[static_cast<std::size_t>(y_px) * static_cast<std::size_t>(width_px_) +
                     static_cast<std::size_t>(x_px)];
  }
  bool empty() const { return ideal_px_.empty(); }

 private:
  int width_px_ = 0;
  std::vector<Eigen::Vector2f> ideal_px_;
};

}  // namespace evical
