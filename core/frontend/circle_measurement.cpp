#include "core/frontend/circle_measurement.h"

#include "core/base/time.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <bit>
#include <cmath>

namespace evical {
namespace {

constexpr int kMeasureIterations = 4;
constexpr double kUnknownSigma_px = 10.0;  // of a corner, along an edge without bursts across it

struct EdgePoint {
  Eigen::Vector2d at_middle;  // ideal pixels, moved to the window's middle
  double time_s, scale, weight;
  double leads;         // +1 at leading edges, -1 at trailing ones
  std::uint32_t burst;  // index into the window
  std::uint8_t outline;
  bool used = false;  // in the last iteration of the fit
};

// Bursts near one outline of a point.
void gatherEdgePoints(const BurstWindow& window, const OutlineImage& outline, std::uint8_t number,
                      const BoardMotion& motion, double half_slot_s, const TrackingOptions& options,
                      std::vector<EdgePoint>& points) {
  constexpr double kTurns = 0.1;  // by acceleration
  const Eigen::Vector2d velocity = motion.velocityAt(outline.centre_px);
  const double lead = usefulLead(outline, velocity, kTurns, options);
  if (lead == 0.0) return;
  const Eigen::Vector2d acceleration = motion.accelerationAt(outline.centre_px);
  const double speed = velocity.norm() + 0.5 * half_slot_s * acceleration.norm();
  // Limit of gates: the fit's last gate plus the largest deviation of a circle from the board's fit.
  const double gate_px = options.last_gate_px + 0.5 * options.max_centre_shift_px;
  const Eigen::Vector2d reach =
      outline.sensor_reach_px.array() + gate_px + speed * half_slot_s / outline.scale();
  const Eigen::Vector2d& middle = outline.sensor_centre_px;
  const auto visit = [&](std::uint32_t i) {
    const WindowBurst& burst = window.bursts()[i];
    const double time_s = burst.time_s;
    if (std::abs(time_s) > half_slot_s || burst.lead * lead < 0.0) return;
    const Eigen::Vector2d pixel(burst.ideal_x_px, burst.ideal_y_px);
    const Eigen::Vector2d at_middle = pixel - motion.travel(pixel, time_s);
    const EdgeDistance edge = distanceToEdge(outline, at_middle);
    const double scale = burst.stretch.across(edge.normal);
    if (!(std::abs(edge.distance_px / scale - motion.radius_offset_px) < gate_px)) return;
    const Eigen::Vector2d velocity_then = velocity + time_s * acceleration;
    const double leads = burst.lead * edge.normal.dot(velocity_then) / (velocity_then.norm() + 1e-9);
    const double weight = crossingWeight(leads, burst.events, motion.typical_events, options);
    if (weight > 0.0) points.push_back({at_middle, time_s, scale, weight, burst.lead, i, number});
  };
  window.visitBox(middle.x() - reach.x(), middle.x() + reach.x(), middle.y() - reach.y(),
                  middle.y() + reach.y(), visit);
}

struct CentreFit {
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();    // centre x, y in ideal pixels; radius offset in pixels
  Eigen::Vector3d by_lead = Eigen::Vector3d::Zero();  // derivative of the shift by an edge localisation bias
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double weight = 0.0, squares = 0.0, time_s = 0.0;
  int points = 0, inliers = 0;
  unsigned sectors = 0;  // of a circle; of a corner: its edges
};

// Residuals are linear in the shift if it is small compared with the radius; a few iterations settle the
// weights.
CentreFit fitCentre(const PointImage& start, const BoardMotion& motion, const TrackingOptions& options,
                    std::vector<EdgePoint>& points) {
  CentreFit fit;
  PointImage point_image = start;
  const double prior = 1.0 / (options.radius_offset_sigma_px * options.radius_offset_sigma_px);
  const double unknown = 1.0 / (kUnknownSigma_px * kUnknownSigma_px * start.scale * start.scale);
  const double noise2 = std::max(motion.residual_rms_px * motion.residual_rms_px, 1e-3);
  const double inverse_scale2 = 1.0 / (options.robust_scale_px * options.robust_scale_px);
  for (int iteration = 0; iteration < kMeasureIterations; ++iteration) {
    for (std::size_t k = 0; k < start.outlines.size(); ++k)
      point_image.outlines[k].centre_px = start.outlines[k].centre_px + fit.shift.head<2>();
    const double offset_px = motion.radius_offset_px + fit.shift.z();
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero(), by_lead = Eigen::Vector3d::Zero();
    // A corner keeps its place along an edge without bursts across it; the sigma says that it is unknown.
    if (start.is_corner) {
      matrix.topLeftCorner<2, 2>().diagonal().setConstant(unknown * noise2);
      vector.head<2>() = -unknown * noise2 * fit.shift.head<2>();
    }
    matrix(2, 2) = prior * noise2;
    vector(2) = -prior * noise2 * fit.shift.z();
    fit.weight = fit.squares = fit.time_s = 0.0;
    fit.points = fit.inliers = 0;
    fit.sectors = 0;
    for (EdgePoint& point : points) {
      const OutlineImage& outline = point_image.outlines[point.outline];
      const EdgeDistance edge = distanceToEdge(outline, point.at_middle);
      const double r = edge.distance_px / point.scale - offset_px;
      point.used = !(std::abs(r) >= options.last_gate_px);
      if (!point.used) continue;
      const double w = point.weight / (1.0 + r * r * inverse_scale2);
      const Eigen::Vector3d row(-edge.normal.x() / point.scale, -edge.normal.y() / point.scale, -1.0);
      matrix += w * row * row.transpose();
      vector -= w * r * row;
      by_lead -= w * point.leads * row;
      fit.weight += w;
      fit.squares += w * r * r;
      fit.time_s += w * point.time_s;
      ++fit.points;
      fit.inliers += std::abs(r) < options.robust_scale_px;
      fit.sectors |= 1u << (start.is_corner ? point.outline : outlineSector(edge.normal));
    }
    if (fit.points < options.min_circle_bursts) return fit;
    const Eigen::LDLT<Eigen::Matrix3d> solver(matrix);
    fit.shift += solver.solve(vector);
    fit.by_lead = solver.solve(by_lead);
    fit.information = matrix;
  }
  fit.time_s /= fit.weight;
  return fit;
}

CircleObservation observation(const PointImage& point, const CentreFit& fit, const BoardMotion& motion,
                              double noise2, std::int64_t start_ns) {
  CircleObservation out;
  out.circle = point.point;
  const Eigen::Vector2d centre = point.centre_px + fit.shift.head<2>();
  out.velocity_px_s = motion.velocityAt(centre) + fit.time_s * motion.accelerationAt(centre);
  out.time_s = secondsSince(start_ns, motion.time_ns) + fit.time_s;
  out.centre_px = centre + motion.travel(centre, fit.time_s);
  out.edge_localisation_bias_effect = fit.by_lead.head<2>();
  out.covariance_px2 = noise2 * fit.information.inverse().topLeftCorner<2, 2>();
  out.events = fit.points;
  out.residual_rms_px = std::sqrt(fit.squares / fit.weight);
  if (point.is_corner) return out;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(point.outlines[0].shape);
  const double outside_px = (motion.radius_offset_px + fit.shift.z()) * point.scale;
  out.semi_axes_px = eigen.eigenvalues().cwiseSqrt().cwiseInverse().array() +
                     outside_px;  // ascending shape: major axis first
  out.angle_rad = std::atan2(eigen.eigenvectors()(1, 0), eigen.eigenvectors()(0, 0));
  return out;
}

// True if one of a corner's two lines has bursts on all its edges that are long enough: a line that ends
// there is not the corner's.
bool hasLine(const PointImage& point, unsigned edges) {
  constexpr unsigned kAlongX = 0b0011, kAlongY = 0b1100;
  unsigned shown = 0;
  for (std::size_t k = 0; k < point.shown.size(); ++k) shown |= point.shown[k] ? 1u << k : 0u;
  const auto has = [&](unsigned line) {
    return (shown & line) != 0 && (edges & shown & line) == (shown & line);
  };
  return has(kAlongX) || has(kAlongY);
}

CircleVerdict judge(const PointImage& point, const CentreFit& fit, std::size_t points,
                    const TrackingOptions& options) {
  if (fit.points < options.min_circle_bursts) return CircleVerdict::TooFewBursts;
  if (fit.inliers < options.min_inliers * static_cast<double>(points)) return CircleVerdict::TooFewInliers;
  const bool enough = point.is_corner ? hasLine(point, fit.sectors)
                                      : std::popcount(fit.sectors) >= options.min_arc * kOutlineSectors;
  if (!enough) return CircleVerdict::TooShortArc;
  if (!(fit.shift.head<2>().norm() < options.max_centre_shift_px * point.scale))
    return CircleVerdict::OffTheBoard;
  return CircleVerdict::Measured;
}

// Measures one circle after the other; reuses the memory.
class CircleMeter {
 public:
  CircleMeter(const BurstWindow& window, const BoardMotion& motion, const MeasuredSlot& slot,
              const TrackingOptions& options)
      : window_(window), motion_(motion), slot_(slot), options_(options) {}

  CircleVerdict measure(const PointImage& point, CircleObservation& out) {
    if (!insideImage(point, window_.resolution_px())) return CircleVerdict::OutsideImage;
    points_.clear();
    for (std::size_t k = 0; k < point.outlines.size(); ++k)
      if (point.shown[k])
        gatherEdgePoints(window_, point.outlines[k], static_cast<std::uint8_t>(k), motion_, slot_.half_s,
                         options_, points_);
    if (static_cast<int>(points_.size()) < options_.min_circle_bursts) return CircleVerdict::TooFewBursts;
    const CentreFit fit = fitCentre(point, motion_, options_, points_);
    const CircleVerdict verdict = judge(point, fit, points_.size(), options_);
    if (verdict != CircleVerdict::Measured) return verdict;
    // Scatter of the whole window: a dozen points of one circle do not determine their noise.
    const double noise2 = std::max(motion_.residual_rms_px * motion_.residual_rms_px, 1e-3);
    out = observation(point, fit, motion_, noise2, slot_.start_ns);
    const double largest_variance = options_.max_centre_sigma_px * options_.max_centre_sigma_px;
    const Eigen::Matrix2d& c = out.covariance_px2;
    // A corner is useful if it is known across one of its edges.
    const double variance = point.is_corner
                                ? Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(c).eigenvalues().x()
                                : 0.5 * c.trace();
    return variance < largest_variance * point.scale * point.scale ? verdict : CircleVerdict::TooUnsure;
  }

  // Inliers of the last measured circle.
  void addInliers(std::vector<EdgeInlier>& inliers) const {
    for (const EdgePoint& point : points_) {
      if (!point.used) continue;
      const WindowBurst& burst = window_.bursts()[point.burst];
      inliers.push_back({{burst.x_px, burst.y_px}, burst.lead > 0.0f});
    }
  }

 private:
  const BurstWindow& window_;
  const BoardMotion& motion_;
  MeasuredSlot slot_;
  const TrackingOptions& options_;
  std::vector<EdgePoint> points_;
};

}  // namespace

const char* circleVerdictName(CircleVerdict verdict) {
  switch (verdict) {
    case CircleVerdict::Measured:
      return "measured";
    case CircleVerdict::OutsideImage:
      return "outside the image";
    case CircleVerdict::TooFewBursts:
      return "too few bursts";
    case CircleVerdict::TooFewInliers:
      return "too few bursts on its edge";
    case CircleVerdict::TooShortArc:
      return "outline too incomplete";
    case CircleVerdict::OffTheBoard:
      return "too far from the board's fit";
    case CircleVerdict::TooUnsure:
      break;
  }
  return "centre too uncertain";
}

std::vector<CircleObservation> measureCircles(const BurstWindow& window, const BoardMotion& motion,
                                              const BoardScene& scene, const MeasuredSlot& slot,
                                              const TrackingOptions& options, MeasurementTrace* trace) {
  std::vector<CircleObservation> circles;
  circles.reserve(
      static_cast<std::size_t>(scene.board.pointCount()));  // reserved exactly, since views are kept
  CircleMeter meter(window, motion, slot, options);
  if (trace)
    trace->verdicts.assign(static_cast<std::size_t>(scene.board.pointCount()), CircleVerdict::OutsideImage);
  for (int index = 0; index < scene.board.pointCount(); ++index) {
    const std::optional<PointImage> point = imageOfPoint(motion.ideal_from_board, scene, index);
    if (!point) continue;
    CircleObservation out;
    const CircleVerdict verdict = meter.measure(*point, out);
    if (verdict == CircleVerdict::Measured) circles.push_back(out);
    if (!trace) continue;
    trace->verdicts[static_cast<std::size_t>(index)] = verdict;
    if (verdict == CircleVerdict::Measured) meter.addInliers(trace->inliers);
  }
  return circles;
}

}  // namespace evical
