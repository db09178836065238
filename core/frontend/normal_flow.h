// Motion of edges along their normals, from planes through the times of neighbouring pixels
// (docs/maths.md, 5.2; R. Benosman et al., "Event-based visual flow", TNNLS 2014).
#pragma once

#include "core/frontend/burst_window.h"
#include "core/frontend/detection_options.h"

#include "core/geometry/resolution.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

namespace evical {

// Surface of active events (docs/maths.md, 5.2): for each pixel and polarity, the time at which the last edge
// of a window passed.
struct ActivePixel {
  std::uint16_t x_px, y_px;
  bool leading;  // passed by a circle's leading edge, according to the polarity
};

class ActiveEventSurface {
 public:
  static constexpr float kNever_s = -1e9f;
  static bool active(float time_s) { return time_s > kNever_s; }

  // The last edge of the window, or the one nearest to its middle.
  enum class Kept { Last, Nearest };

  // Neighbours up to border_px away can be read at every pixel of the image.
  ActiveEventSurface(const BurstWindow& window, int border_px, Kept kept = Kept::Last);

  const std::vector<ActivePixel>& pixels() const { return pixels_; }
  int stride() const { return stride_; }

  // Time since the window's middle, or kNever_s; the neighbour (dx, dy) is at dy * stride() + dx.
  const float* at(bool leading, int x_px, int y_px) const {
    return times_s_[leading].data() + (y_px + border_px_) * stride_ + x_px + border_px_;
  }

 private:
  int border_px_, stride_;
  std::array<std::vector<float>, 2> times_s_;
  std::vector<ActivePixel> pixels_;
};

struct NormalFlow {
  std::uint16_t x_px, y_px;
  bool leading;
  float time_s;                   // since the window's middle
  Eigen::Vector2f velocity_px_s;  // of the edge, along its normal
};

using NormalFlowField = std::vector<NormalFlow>;

// Flow (a, b) / (a^2 + b^2) at pixels where a plane t = a x + b y + c fits the neighbourhood. The surface
// needs a border of at least plane_radius_px. Deviations from the plane are compared with the distance that
// the edge travels in that time, so slow and fast edges are treated alike.
NormalFlowField estimateNormalFlow(const ActiveEventSurface& surface, const NormalFlowOptions& options);

// Connected regions of normal flow, classified as parts of a moving circle (docs/maths.md, 5.2; S.
// Chen et al., "eKalibr", 2501.05688).
enum class ClusterKind {
  Run,    // flows diverge: leading arc
  Chase,  // flows converge: trailing arc
  Other,
};

struct EventCluster {
  bool leading = false;              // by polarity
  std::vector<std::uint32_t> flows;  // indices into the field
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // of the mean flow, unit
  ClusterKind kind = ClusterKind::Other;
};

std::vector<EventCluster> clusterFlow(const NormalFlowField& field, Resolution resolution_px,
                                      const NormalFlowOptions& options);

}  // namespace evical
