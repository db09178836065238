#include "core/frontend/event_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

constexpr std::uint32_t kNoCluster = static_cast<std::uint32_t>(-1);

Eigen::Vector2d place(const NormalFlow& flow) {
  return {flow.x_px, flow.y_px};
}

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
  return u.x() * v.y() - u.y() * v.x();
}

// Index of the flow at each pixel and polarity, with a border as wide as a cluster's steps.
class FlowImage {
 public:
  FlowImage(const NormalFlowField& field, Resolution resolution_px, int reach_px)
      : reach_px_(reach_px), stride_(resolution_px.width_px + 2 * reach_px) {
    const auto cells = static_cast<std::size_t>(stride_ * (resolution_px.height_px + 2 * reach_px));
    for (std::vector<std::uint32_t>& plane : planes_) plane.assign(cells, kNoCluster);
    for (std::uint32_t i = 0; i < field.size(); ++i) planes_[field[i].leading][cellOf(field[i])] = i;
  }

  // The flow at the pixel and all flow connected to it, removed from the image; empty if it was removed
  // before.
  std::vector<std::uint32_t> takeConnected(const NormalFlowField& field, std::uint32_t first) {
    std::vector<std::uint32_t>& plane = planes_[field[first].leading];
    std::vector<std::uint32_t> flows;
    const auto take = [&](std::size_t cell) {
      if (plane[cell] == kNoCluster) return;
      flows.push_back(plane[cell]);
      plane[cell] = kNoCluster;
    };
    take(cellOf(field[first]));
    for (std::size_t next = 0; next < flows.size(); ++next) {
      const std::size_t centre = cellOf(field[flows[next]]);
      for (int dy = -reach_px_; dy <= reach_px_; ++dy) {
        for (int dx = -reach_px_; dx <= reach_px_; ++dx) {
          take(static_cast<std::size_t>(static_cast<std::ptrdiff_t>(centre) + dy * stride_ + dx));
        }
      }
    }
    return flows;
  }

 private:
  std::size_t cellOf(const NormalFlow& flow) const {
    return static_cast<std::size_t>((flow.y_px + reach_px_) * stride_ + flow.x_px + reach_px_);
  }

  int reach_px_, stride_;
  std::array<std::vector<std::uint32_t>, 2> planes_;
};

// Nearest of the three patterns of [flow left, right of the mean] x [point left, right of the line].
ClusterKind kindOf(const EventCluster& cluster, const NormalFlowField& field) {
  std::array<double, 4> counts = {};
  for (const std::uint32_t i : cluster.flows) {
    const bool flow_left = cross(cluster.direction, field[i].velocity_px_s.cast<double>()) < 0.0;
    const bool point_left = cross(cluster.direction, place(field[i]) - cluster.centroid_px) < 0.0;
    counts[static_cast<std::size_t>(2 * flow_left + point_left)] += 1.0;
  }
  const double norm = std::sqrt(counts[0] * counts[0] + counts[1] * counts[1] + counts[2] * counts[2] +
                                counts[3] * counts[3]);
  // All have norm 1, so the nearest is the one with the largest product.
  const double run = std::sqrt(0.5) * (counts[0] + counts[3]) / norm;
  const double chase = std::sqrt(0.5) * (counts[1] + counts[2]) / norm;
  const double other = 0.5 * (counts[0] + counts[1] + counts[2] + counts[3]) / norm;
  if (run > chase && run > other) return ClusterKind::Run;
  return chase > other ? ClusterKind::Chase : ClusterKind::Other;
}

}  // namespace

std::vector<EventCluster> clusterFlow(const NormalFlowField& field, Resolution resolution_px,
                                      const NormalFlowOptions& options) {
  // Two pixels whose squares touch once both are dilated.
  FlowImage image(field, resolution_px, 2 * options.dilation_px + 1);
  std::vector<EventCluster> clusters;
  for (std::uint32_t first = 0; first < field.size(); ++first) {
    EventCluster cluster;
    cluster.leading = field[first].leading;
    cluster.flows = image.takeConnected(field, first);
    if (cluster.flows.size() < static_cast<std::size_t>(options.least_cluster_px)) continue;
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    for (const std::uint32_t i : cluster.flows) {
      cluster.centroid_px += place(field[i]);
      direction += field[i].velocity_px_s.cast<double>().normalized();
    }
    if (direction.norm() < 1e-9) continue;
    cluster.centroid_px /= static_cast<double>(cluster.flows.size());
    cluster.direction = direction.normalized();
    cluster.kind = kindOf(cluster, field);
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

}  // namespace evical
