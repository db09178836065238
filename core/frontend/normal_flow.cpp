#include "core/frontend/normal_flow.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {

ActiveEventSurface::ActiveEventSurface(const BurstWindow& window, int border_px, Kept kept)
    : border_px_(border_px), stride_(window.resolution_px().width_px + 2 * border_px) {
  const int rows = window.resolution_px().height_px + 2 * border_px;
  for (std::vector<float>& plane : times_s_)
    plane.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(rows), kNever_s);
  pixels_.reserve(window.bursts().size());
  for (const WindowBurst& burst : window.bursts()) {
    const int x = static_cast<int>(burst.x_px), y = static_cast<int>(burst.y_px);
    const bool leading = burst.lead > 0.0f;
    float& time_s = times_s_[leading][static_cast<std::size_t>((y + border_px) * stride_ + x + border_px)];
    if (!active(time_s))
      pixels_.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), leading});
    const bool replaces =
        kept == Kept::Last ? burst.time_s > time_s : std::abs(burst.time_s) < std::abs(time_s);
    if (replaces) time_s = burst.time_s;
  }
}

namespace {

constexpr int kPlaneRefits = 2;

// t = a x + b y + c around a pixel.
struct Plane {
  double a = 0.0, b = 0.0, c = 0.0;

  double slope_s_px() const { return std::sqrt(a * a + b * b); }
  double error_s(int x, int y, double t) const { return std::abs(t - a * x - b * y - c); }
};

struct PlaneSums {
  int n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  double t = 0.0, xt = 0.0, yt = 0.0;

  void add(int dx, int dy, double time) {
    ++n;
    x += dx;
    y += dy;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
    t += time;
    xt += dx * time;
    yt += dy * time;
  }

  // False if the pixels are collinear.
  bool solve(Plane& plane) const {
    const int cxx = n * xx - x * x, cxy = n * xy - x * y, cyy = n * yy - y * y;
    const double determinant =
        static_cast<double>(cxx) * cyy - static_cast<double>(cxy) * static_cast<double>(cxy);
    if (determinant < 0.5) return false;
    const double cxt = n * xt - x * t, cyt = n * yt - y * t;
    plane.a = (cyy * cxt - cxy * cyt) / determinant;
    plane.b = (cxx * cyt - cxy * cxt) / determinant;
    plane.c = (t - plane.a * x - plane.b * y) / n;
    return true;
  }
};

// Calls visit(dx, dy, seconds after the centre) for the active pixels around one.
template <class Visit>
void visitNeighbours(const float* centre, int stride, int radius, Visit&& visit) {
  for (int dy = -radius; dy <= radius; ++dy) {
    const float* const row = centre + dy * stride;
    for (int dx = -radius; dx <= radius; ++dx) {
      if (ActiveEventSurface::active(row[dx])) visit(dx, dy, static_cast<double>(row[dx] - *centre));
    }
  }
}

// False if too little of the neighbourhood is on a plane, or if the pixel itself is not.
bool fitPlane(const float* centre, int stride, int min_inliers, const NormalFlowOptions& options,
              Plane& plane) {
  PlaneSums sums;
  const int radius = options.plane_radius_px;
  visitNeighbours(centre, stride, radius, [&](int dx, int dy, double t) { sums.add(dx, dy, t); });
  if (sums.n < min_inliers || !sums.solve(plane)) return false;
  for (int refit = 0; refit < kPlaneRefits; ++refit) {
    const double largest_error_s = options.max_plane_error_px * plane.slope_s_px();
    const int before = sums.n;
    sums = PlaneSums{};
    visitNeighbours(centre, stride, radius, [&](int dx, int dy, double t) {
      if (plane.error_s(dx, dy, t) <= largest_error_s) sums.add(dx, dy, t);
    });
    if (sums.n < min_inliers) return false;
    if (sums.n == before && refit > 0) break;
    if (!sums.solve(plane)) return false;
  }
  return plane.error_s(0, 0, 0.0) <= options.max_plane_error_px * plane.slope_s_px();
}

}  // namespace

NormalFlowField estimateNormalFlow(const ActiveEventSurface& surface, const NormalFlowOptions& options) {
  const int side = 2 * options.plane_radius_px + 1;
  const int min_inliers = static_cast<int>(std::ceil(options.min_plane_inliers * side * side - 1e-9));
  NormalFlowField field;
  for (const ActivePixel& pixel : surface.pixels()) {
    const float* const centre = surface.at(pixel.leading, pixel.x_px, pixel.y_px);
    Plane plane;
    if (!fitPlane(centre, surface.stride(), min_inliers, options, plane)) continue;
    const double slope2 = plane.a * plane.a + plane.b * plane.b;
    if (slope2 * options.fastest_px_s * options.fastest_px_s < 1.0) continue;
    field.push_back({pixel.x_px, pixel.y_px, pixel.leading, *centre,
                     Eigen::Vector2d(plane.a / slope2, plane.b / slope2).cast<float>()});
  }
  return field;
}

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
    if (cluster.flows.size() < static_cast<std::size_t>(options.min_cluster_px)) continue;
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
