#include "core/frontend/normal_flow.h"

#include <cmath>

namespace evical {

ActiveEventSurface::ActiveEventSurface(const BurstWindow& window, int border_px)
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
    if (burst.time_s > time_s) time_s = burst.time_s;
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
bool fitPlane(const float* centre, int stride, int least_inliers, const NormalFlowOptions& options,
              Plane& plane) {
  PlaneSums sums;
  const int radius = options.plane_radius_px;
  visitNeighbours(centre, stride, radius, [&](int dx, int dy, double t) { sums.add(dx, dy, t); });
  if (sums.n < least_inliers || !sums.solve(plane)) return false;
  for (int refit = 0; refit < kPlaneRefits; ++refit) {
    const double largest_error_s = options.largest_plane_error_px * plane.slope_s_px();
    const int before = sums.n;
    sums = PlaneSums{};
    visitNeighbours(centre, stride, radius, [&](int dx, int dy, double t) {
      if (plane.error_s(dx, dy, t) <= largest_error_s) sums.add(dx, dy, t);
    });
    if (sums.n < least_inliers) return false;
    if (sums.n == before && refit > 0) break;
    if (!sums.solve(plane)) return false;
  }
  return plane.error_s(0, 0, 0.0) <= options.largest_plane_error_px * plane.slope_s_px();
}

}  // namespace

NormalFlowField estimateNormalFlow(const ActiveEventSurface& surface, const NormalFlowOptions& options) {
  const int side = 2 * options.plane_radius_px + 1;
  const int least_inliers = static_cast<int>(std::ceil(options.least_plane_inliers * side * side - 1e-9));
  NormalFlowField field;
  for (const ActivePixel& pixel : surface.pixels()) {
    const float* const centre = surface.at(pixel.leading, pixel.x_px, pixel.y_px);
    Plane plane;
    if (!fitPlane(centre, surface.stride(), least_inliers, options, plane)) continue;
    const double slope2 = plane.a * plane.a + plane.b * plane.b;
    if (slope2 * options.fastest_px_s * options.fastest_px_s < 1.0) continue;
    field.push_back({pixel.x_px, pixel.y_px, pixel.leading, *centre,
                     Eigen::Vector2d(plane.a / slope2, plane.b / slope2).cast<float>()});
  }
  return field;
}

}  // namespace evical
