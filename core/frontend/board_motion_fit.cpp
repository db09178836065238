// The joint fit of all outlines in a window. Bursts are summed by outline and sector of it: within
// a sector the normals agree to a few degrees, so the normal equations (25 unknowns) are built from a few
// hundred sectors instead of thousands of bursts. Gradients use every burst's own normal, so the optimum is
// unchanged.
#include "core/frontend/board_motion.h"

#include "core/numerics/robust.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

constexpr int kFlowTerms = 8;
constexpr int kUnknowns = 3 * kFlowTerms + 1;  // shift, velocity, acceleration, radius offset
constexpr double kSquare = 0.8;                // cosine
// During the fit of a board of squares: how far edges move, and by how much cosines between motion and
// normals change.
constexpr double kEdgeMoves_px = 1.0, kTurns = 0.25;
using NormalMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using NormalVector = Eigen::Matrix<double, kUnknowns, 1>;

struct NormalEquations {
  NormalMatrix matrix = NormalMatrix::Zero();
  NormalVector vector = NormalVector::Zero();
  double weighted_squares = 0.0, weight = 0.0;
  int bursts = 0;
  std::vector<double> square_events;  // of bursts at edges that move along their normals
};

// Sums of w t^k, of w r t^k n, and of w r over the bursts of one sector.
struct SectorSums {
  std::array<double, 5> w = {};
  std::array<Eigen::Vector2d, 3> wrn = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                        Eigen::Vector2d::Zero()};
  Eigen::Vector2d wn = Eigen::Vector2d::Zero(), wx = Eigen::Vector2d::Zero();
  double wr = 0.0;
};

struct FitPoint {
  double x, y, t, inverse_scale, events, lead;
};

// The priors only fix directions that the bursts do not determine. Perspective terms are the least certain
// and the least important.
NormalVector priorSigmas(const TrackingOptions& options) {
  NormalVector sigmas;
  for (int i = 0; i < kFlowTerms; ++i) {
    const double factor = i < 6 ? 1.0 : 0.5;
    sigmas(i) = factor * options.prediction_sigma_px;
    sigmas(kFlowTerms + i) = factor * options.velocity_sigma_px_s;
    sigmas(2 * kFlowTerms + i) = factor * options.acceleration_sigma_px_s2;
  }
  sigmas(kUnknowns - 1) = 1.0;
  return sigmas;
}

void addPriors(const NormalVector& sigmas, const NormalVector& from_prior, double noise2,
               NormalEquations& equations) {
  // Bursts are weighted in units of the robust scale, so the priors are, too.
  const NormalVector weights = noise2 * sigmas.cwiseAbs2().cwiseInverse();
  equations.matrix.diagonal() += weights;
  equations.vector -= weights.cwiseProduct(from_prior);
}

// One outline and its motion: the field to first order around its centre.
struct OutlineMotion {
  OutlineImage outline;
  Eigen::Vector2d velocity, acceleration;
  Eigen::Matrix2d velocity_gradient, acceleration_gradient;  // per px

  OutlineMotion(const OutlineImage& projected, const BoardMotion& motion)
      : outline(projected),
        velocity(motion.velocityAt(projected.centre_px)),
        acceleration(motion.accelerationAt(projected.centre_px)),
        velocity_gradient(motion.frame.gradient(motion.velocity_px_s, projected.centre_px)),
        acceleration_gradient(motion.frame.gradient(motion.acceleration_px_s2, projected.centre_px)) {}
};

// Bursts that may be near the circle's edge at any time of the fit.
void gatherPoints(const BurstWindow& window, const OutlineMotion& moving, double half_window_s,
                  double slack_px, double lead, std::vector<FitPoint>& points) {
  points.clear();
  const OutlineImage& outline = moving.outline;
  const double speed = moving.velocity.norm() + 0.5 * half_window_s * moving.acceleration.norm();
  const Eigen::Vector2d reach =
      outline.sensor_reach_px.array() + slack_px + speed * half_window_s / outline.scale();
  const Eigen::Vector2d& middle = outline.sensor_centre_px;
  OutlineImage longer = outline;  // the ends of an edge may be as far from their places as its bursts
  if (outline.isStraight()) longer.max_radius_px += slack_px * outline.scale();
  window.visitBox(middle.x() - reach.x(), middle.x() + reach.x(), middle.y() - reach.y(),
                  middle.y() + reach.y(), [&](auto i) {
                    const WindowBurst& burst = window.bursts()[i];
                    const double t = burst.time_s;
                    if (std::abs(t) > half_window_s || burst.lead * lead < 0.0) return;
                    const Eigen::Vector2d pixel(burst.ideal_x_px, burst.ideal_y_px);
                    const Eigen::Vector2d at_middle =
                        pixel - t * (moving.velocity + 0.5 * t * moving.acceleration);
                    const EdgeDistance edge = distanceToEdge(longer, at_middle);
                    const double scale = burst.stretch.across(edge.normal);
                    if (!(std::abs(edge.distance_px) < slack_px * scale)) return;
                    points.push_back({pixel.x(), pixel.y(), t, 1.0 / scale, burst.events, burst.lead});
                  });
}

void sumSectors(const OutlineMotion& moving, const std::vector<FitPoint>& points, const BoardMotion& motion,
                double gate_px, const TrackingOptions& options,
                std::array<SectorSums, kOutlineSectors>& sectors, NormalEquations& equations) {
  const double inverse_noise2 = 1.0 / (options.robust_scale_px * options.robust_scale_px);
  for (const FitPoint& point : points) {
    const Eigen::Vector2d pixel(point.x, point.y);
    const double t = point.t;
    Eigen::Vector2d at_middle = pixel - t * (moving.velocity + 0.5 * t * moving.acceleration);
    const Eigen::Vector2d beside = at_middle - moving.outline.centre_px;
    at_middle -= t * (moving.velocity_gradient * beside + 0.5 * t * (moving.acceleration_gradient * beside));
    const EdgeDistance edge = distanceToEdge(moving.outline, at_middle);
    const double r = edge.distance_px * point.inverse_scale - motion.radius_offset_px;
    if (!(std::abs(r) < gate_px)) continue;
    const Eigen::Vector2d velocity_then = moving.velocity + t * moving.acceleration;
    const double leads = point.lead * edge.normal.dot(velocity_then) / (velocity_then.norm() + 1e-9);
    const double w =
        crossingWeight(leads, point.events, motion.typical_events, options) / (1.0 + r * r * inverse_noise2);
    if (leads > kSquare) equations.square_events.push_back(point.events);
    if (w <= 0.0) continue;
    SectorSums& sums = sectors[sectorOf(moving.outline, edge.normal, at_middle)];
    // Rows carry 1 / scale; it is folded into the normal.
    const Eigen::Vector2d n = edge.normal * point.inverse_scale;
    double wt = w;
    for (int k = 0; k < 5; ++k, wt *= t) sums.w[static_cast<std::size_t>(k)] += wt;
    const Eigen::Vector2d wrn = w * r * n;
    sums.wrn[0] += wrn;
    sums.wrn[1] += t * wrn;
    sums.wrn[2] += t * t * wrn;
    sums.wn += w * n;
    sums.wx += w * at_middle;
    sums.wr += w * r;
    equations.weighted_squares += w * r * r;
    equations.weight += w;
    ++equations.bursts;
  }
}

// row = (-a, -t a, -t^2 / 2 a, -1) with a = n^T basis.
void addSector(const SectorSums& sums, const ImageFrame& frame, NormalEquations& equations) {
  const double weight = sums.w[0];
  if (weight <= 0.0) return;
  const PlaneFlowBasis basis = frame.basis(sums.wx / weight);
  const PlaneFlow a = basis.transpose() * (sums.wn / weight);
  const Eigen::Matrix<double, 8, 8> aa = a * a.transpose();
  constexpr std::array<double, 3> kTaylor = {1.0, 1.0, 0.5};
  for (int p = 0; p < 3; ++p) {
    const auto row = static_cast<Eigen::Index>(p * kFlowTerms);
    const double factor = kTaylor[static_cast<std::size_t>(p)];
    for (int q = 0; q <= p; ++q) {
      const double both =
          factor * kTaylor[static_cast<std::size_t>(q)] * sums.w[static_cast<std::size_t>(p + q)];
      // By column: compilers unroll these, but not a whole block.
      for (int col = 0; col < kFlowTerms; ++col)
        equations.matrix.block<kFlowTerms, 1>(row, q * kFlowTerms + col) += both * aa.col(col);
    }
    equations.matrix.block<1, 8>(kUnknowns - 1, row) +=
        factor * sums.w[static_cast<std::size_t>(p)] * a.transpose();
    equations.vector.segment<8>(row) += factor * basis.transpose() * sums.wrn[static_cast<std::size_t>(p)];
  }
  equations.matrix(kUnknowns - 1, kUnknowns - 1) += weight;
  equations.vector(kUnknowns - 1) += sums.wr;
}

void apply(const NormalVector& step, BoardMotion& motion) {
  motion.ideal_from_board = warped(motion.ideal_from_board, motion.frame, step.head<kFlowTerms>());
  motion.velocity_px_s += step.segment<kFlowTerms>(kFlowTerms);
  motion.acceleration_px_s2 += step.segment<kFlowTerms>(2 * kFlowTerms);
  motion.radius_offset_px += step(kUnknowns - 1);
}

}  // namespace

std::optional<BoardMotion> fitBoardMotion(const BurstWindow& window, const BoardMotion& start,
                                          const BoardScene& scene, double first_gate_px,
                                          const TrackingOptions& options) {
  constexpr double kSettled_px = 0.01;
  BoardMotion motion = start;
  const NormalVector sigmas = priorSigmas(options);
  // The prediction is the prior of shift and velocity; the prior of acceleration is zero.
  NormalVector from_prior = NormalVector::Zero();
  from_prior.segment<kFlowTerms>(2 * kFlowTerms) = motion.acceleration_px_s2;
  const double half_window_s = fitHalfWindow_s(boardSpeed_px_s(motion, scene), options);
  std::vector<std::vector<FitPoint>> points(static_cast<std::size_t>(scene.outlineCount()));
  double gate_px = first_gate_px;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    NormalEquations equations;
    for (const OutlineImage& outline : projectBoard(motion.ideal_from_board, scene)) {
      const OutlineMotion moving(outline, motion);
      std::vector<FitPoint>& near = points[static_cast<std::size_t>(outline.index)];
      if (iteration == 0) {
        // Edges of squares are close to each other. Single events determine their motion less well.
        const bool few = !outline.isStraight() || scene.single_events;
        const double slack_px = few ? 2.0 * first_gate_px : first_gate_px + kEdgeMoves_px;
        const double lead = few ? NAN : usefulLead(outline, moving.velocity, kTurns, options);
        if (lead != 0.0) gatherPoints(window, moving, half_window_s, slack_px, lead, near);
      }
      std::array<SectorSums, kOutlineSectors> sectors;
      sumSectors(moving, near, motion, gate_px, options, sectors, equations);
      for (const SectorSums& sums : sectors) addSector(sums, motion.frame, equations);
    }
    if (equations.bursts < 3 * kUnknowns) return std::nullopt;
    addPriors(sigmas, from_prior, options.robust_scale_px * options.robust_scale_px, equations);
    const NormalVector step = equations.matrix.selfadjointView<Eigen::Lower>().ldlt().solve(equations.vector);
    if (!step.allFinite()) return std::nullopt;
    from_prior += step;
    apply(step, motion);
    motion.residual_rms_px = std::sqrt(equations.weighted_squares / equations.weight);
    motion.bursts = equations.bursts;
    motion.typical_events = medianOf(std::move(equations.square_events));
    const bool at_last_gate = gate_px <= options.last_gate_px;
    if (at_last_gate && step.head<kFlowTerms>().cwiseAbs().maxCoeff() < kSettled_px) break;
    gate_px = std::max(gate_px * options.gate_ratio, options.last_gate_px);
  }
  return motion;
}

}  // namespace evical
