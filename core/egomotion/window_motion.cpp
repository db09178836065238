#include "core/egomotion/window_motion.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr double kMadToSigma = 1.4826;
constexpr double kCauchySigmas = 2.385;                    // 95 % of least squares' efficiency
constexpr double kInlierSigmas = 3.0, kInlierError = 0.3;  // of the speed, or so many sigmas

struct Row {
  Eigen::Vector2d place, slope;  // slope: s by place
  Eigen::Matrix2d variance;      // of the slope
  std::size_t patch = 0;
  double time_s = 0.0;
  double depth_variance = 0.0;  // of g . u, from depths that differ within the patch
  ImageMotion by_rotation, by_translation;
};

struct Motion {
  Vector6d twist = Vector6d::Zero();  // w, v by the mean depth
  std::vector<double> log_nearness;   // by patch: of the mean depth by its own
};

// One row's residual (g . u - 1) / sqrt(u' V u): how much the slope along the motion differs from one over the speed,
// in sigmas. Divided by what u makes of the slope's noise, it has no bias from noise in g (total least squares).
struct Residual {
  double value = 0.0;
  double error = 0.0;  // g . u - 1
  Eigen::Vector2d by_flow = Eigen::Vector2d::Zero();
  Eigen::Vector2d translational = Eigen::Vector2d::Zero();  // part of the flow
  double nearness = 1.0;
};

Residual residualOf(const Row& row, const Motion& motion) {
  Residual out;
  out.nearness = std::exp(motion.log_nearness[row.patch]);
  out.translational = out.nearness * (row.by_translation * motion.twist.tail<3>());
  const Eigen::Vector2d flow = row.by_rotation * motion.twist.head<3>() + out.translational;
  const Eigen::Vector2d noisy = row.variance * flow;
  constexpr double kLeastVariance = 1e-12;
  const double sigma = std::sqrt(flow.dot(noisy) + row.depth_variance + kLeastVariance);
  const double error = row.slope.dot(flow) - 1.0;
  out.error = error;
  out.value = error / sigma;
  out.by_flow = row.slope / sigma - error / (sigma * sigma * sigma) * noisy;
  return out;
}

class WindowFit {
 public:
  WindowFit(std::vector<Row> rows, std::size_t patches, const EgomotionOptions& options)
      : rows_(std::move(rows)), patches_(patches), options_(options) {
    motion_.log_nearness.assign(patches, 0.0);
  }

  // Least squares of g . u - 1, robust: a start that needs none.
  bool start(bool translates) {
    translates_ = translates;
    constexpr int kIterations = 6;
    constexpr double kScale = 0.4;
    motion_.twist.setZero();
    std::fill(motion_.log_nearness.begin(), motion_.log_nearness.end(), 0.0);
    for (int k = 0; k < kIterations; ++k) {
      Matrix6d normal = Matrix6d::Identity() * 1e-6;
      Vector6d right = Vector6d::Zero();
      for (const Row& row : rows_) {
        Vector6d j;
        j << row.by_rotation.transpose() * row.slope, row.by_translation.transpose() * row.slope;
        const double error = j.dot(motion_.twist) - 1.0;
        const double weight = k == 0 ? 1.0 : cauchyWeight(error * error / (kScale * kScale));
        normal += weight * j * j.transpose();
        right += weight * j;
      }
      if (!translates) normal.bottomRightCorner<3, 3>().diagonal().array() += kHeld;
      motion_.twist = normal.ldlt().solve(right);
      if (!motion_.twist.allFinite()) return false;
    }
    return true;
  }

  // Gauss-Newton from there.
  void refine() {
    constexpr int kIterations = 8;
    rescale();
    double cost = costOf(motion_);
    for (int k = 0; k < kIterations; ++k) {
      build();
      double damping = 0.0;
      bool better = false;
      for (int attempt = 0; attempt < 4 && !better; ++attempt) {
        const Motion tried = stepped(damping);
        const double new_cost = costOf(tried);
        if (new_cost < cost) {
          better = true;
          motion_ = tried;
          cost = new_cost;
        }
        damping = damping == 0.0 ? 1e-2 : 30.0 * damping;
      }
      if (!better) break;
      if (k == 1 || k == 3) {
        rescale();
        cost = costOf(motion_);
      }
    }
    rescale();
    build();
  }

  const Motion& motion() const { return motion_; }
  const std::vector<Row>& rows() const { return rows_; }
  double scale() const { return scale_; }

  // With the depths eliminated; slopes that share their neighbourhood tell little more than one.
  Matrix6d covariance(double shared) const {
    Matrix6d information = reduced();
    if (!translates_) information.bottomRightCorner<3, 3>().diagonal().array() += kHeld;
    information += 1e-9 * Matrix6d::Identity();
    return shared * information.inverse();
  }

  double inlierShare() const {
    double inliers = 0.0;
    for (const Row& row : rows_) {
      const Residual r = residualOf(row, motion_);
      inliers += std::abs(r.error) < kInlierError || std::abs(r.value) < kInlierSigmas;
    }
    return inliers / static_cast<double>(rows_.size());
  }
  double medianSquare() const {
    std::vector<double> squares;
    for (const Row& row : rows_) {
      const double value = residualOf(row, motion_).value;
      squares.push_back(value * value);
    }
    return medianOf(std::move(squares));
  }
  double weightOf(const Row& row) const {
    const double value = residualOf(row, motion_).value / (kCauchySigmas * scale_);
    return cauchyWeight(value * value);
  }

 private:
  static constexpr double kHeld = 1e9;

  // How well translation is known of each edge, and how well motion explains them all.
  void rescale() {
    for (Row& row : rows_) {
      const double by_translation = translates_ ? row.slope.dot(residualOf(row, motion_).translational) : 0.0;
      const double size = options_.depth_error * by_translation;
      row.depth_variance = size * size;
    }
    scale_ = robustScale();
  }

  double robustScale() const {
    std::vector<double> sizes;
    for (const Row& row : rows_) sizes.push_back(std::abs(residualOf(row, motion_).value));
    return std::max(kMadToSigma * medianOf(std::move(sizes)), 1e-6);
  }

  double costOf(const Motion& motion) const {
    double cost = 0.0;
    const double unit = kCauchySigmas * scale_;
    for (const Row& row : rows_) {
      const double value = residualOf(row, motion).value / unit;
      cost += unit * unit / (scale_ * scale_) * std::log1p(value * value);
    }
    for (const double log_nearness : motion.log_nearness)
      cost += log_nearness * log_nearness / (options_.depth_spread * options_.depth_spread);
    return cost;
  }

  // Normal equations in arrow form: twist, and one depth a patch.
  void build() {
    twist_normal_.setZero();
    twist_right_.setZero();
    cross_.assign(patches_, Vector6d::Zero());
    const double prior = 1.0 / (options_.depth_spread * options_.depth_spread);
    depth_normal_.assign(patches_, prior);
    depth_right_.resize(patches_);
    for (std::size_t k = 0; k < patches_; ++k) depth_right_[k] = -prior * motion_.log_nearness[k];
    for (const Row& row : rows_) {
      const Residual r = residualOf(row, motion_);
      const double scaled = r.value / (kCauchySigmas * scale_);
      const double weight = cauchyWeight(scaled * scaled) / (scale_ * scale_);
      Vector6d j;
      j << row.by_rotation.transpose() * r.by_flow, r.nearness * (row.by_translation.transpose() * r.by_flow);
      const double d = r.translational.dot(r.by_flow);
      twist_normal_ += weight * j * j.transpose();
      twist_right_ -= weight * r.value * j;
      if (!translates_) continue;
      cross_[row.patch] += weight * d * j;
      depth_normal_[row.patch] += weight * d * d;
      depth_right_[row.patch] -= weight * r.value * d;
    }
    if (!translates_) twist_normal_.bottomRightCorner<3, 3>().diagonal().array() += kHeld;
  }

  Matrix6d reduced() const {
    Matrix6d information = twist_normal_;
    for (std::size_t k = 0; k < patches_; ++k)
      information -= cross_[k] * cross_[k].transpose() / depth_normal_[k];
    return information;
  }

  Motion stepped(double damping) const {
    Matrix6d normal = twist_normal_;
    Vector6d right = twist_right_;
    for (std::size_t k = 0; k < patches_; ++k) {
      const double own = depth_normal_[k] * (1.0 + damping);
      normal -= cross_[k] * cross_[k].transpose() / own;
      right -= cross_[k] * depth_right_[k] / own;
    }
    normal.diagonal() += (damping * twist_normal_.diagonal().array() + 1e-9).matrix();
    const Vector6d step = normal.ldlt().solve(right);
    Motion next = motion_;
    next.twist += step;
    constexpr double kLargestStep = 1.0;
    for (std::size_t k = 0; k < patches_; ++k) {
      const double own = depth_normal_[k] * (1.0 + damping);
      next.log_nearness[k] +=
          std::clamp((depth_right_[k] - cross_[k].dot(step)) / own, -kLargestStep, kLargestStep);
    }
    return next;
  }

  std::vector<Row> rows_;
  std::size_t patches_;
  const EgomotionOptions& options_;
  bool translates_ = true;
  Motion motion_;
  double scale_ = 1.0;
  Matrix6d twist_normal_ = Matrix6d::Zero();
  Vector6d twist_right_ = Vector6d::Zero();
  std::vector<Vector6d> cross_;
  std::vector<double> depth_normal_, depth_right_;
};

std::vector<Row> rowsOf(std::span<const EdgeSlope> slopes, const LensRays& lens, WindowTime time,
                        const EgomotionOptions& options) {
  std::vector<Row> rows;
  rows.reserve(slopes.size());
  const Resolution size = lens.resolution_px();
  const std::size_t step = 1 + slopes.size() / static_cast<std::size_t>(options.most_slopes);
  for (std::size_t k = 0; k < slopes.size(); k += step) {
    const EdgeSlope& slope = slopes[k];
    const LensRays::Ray& ray = lens.at(slope.x_px, slope.y_px);
    if (!ray.known) continue;
    Row row;
    const Eigen::Matrix2d px_per_place = ray.px_per_place.cast<double>();
    row.place = ray.place.cast<double>();
    row.slope = px_per_place.transpose() * slope.slope_s_px.cast<double>();
    const double time_s = options.time_noise_s,
                 passing_s = options.place_noise_px * static_cast<double>(slope.slope_s_px.norm());
    row.variance = (time_s * time_s + passing_s * passing_s) *
                   (px_per_place.transpose() * slope.shape.cast<double>() * px_per_place);
    const int column = slope.x_px * options.depth_columns / size.width_px,
              line = slope.y_px * options.depth_rows / size.height_px;
    row.patch = static_cast<std::size_t>(line * options.depth_columns + column);
    row.time_s = secondsSince(time.begin_ns, slope.time_ns);
    row.by_rotation = rotationalMotion(row.place);
    row.by_translation = translationalMotion(row.place);
    rows.push_back(row);
  }
  return rows;
}

// When in the window what it tells was told.
void weighParts(const WindowFit& fit, double window_s, WindowMotion& out) {
  double sum = 0.0;
  for (const Row& row : fit.rows()) {
    const double part = row.time_s / window_s * static_cast<double>(WindowMotion::kParts);
    const auto k =
        static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(WindowMotion::kParts) - 0.5));
    const Eigen::Vector2d by_flow = residualOf(row, fit.motion()).by_flow;
    const double weight = fit.weightOf(row) * by_flow.squaredNorm();
    out.part_weights[k] += weight;
    sum += weight;
  }
  for (double& weight : out.part_weights) weight /= sum;
}

double medianSpeed_px_s(const WindowFit& fit, double focal_length_px) {
  std::vector<double> speeds;
  const Motion& motion = fit.motion();
  for (const Row& row : fit.rows())
    speeds.push_back(
        (row.by_rotation * motion.twist.head<3>() +
         std::exp(motion.log_nearness[row.patch]) * (row.by_translation * motion.twist.tail<3>()))
            .norm());
  return focal_length_px * medianOf(std::move(speeds));
}

}  // namespace

ImageMotion rotationalMotion(const Eigen::Vector2d& place) {
  const double x = place.x(), y = place.y();
  ImageMotion motion;
  motion << x * y, -(1.0 + x * x), y, 1.0 + y * y, -x * y, -x;
  return motion;
}

ImageMotion translationalMotion(const Eigen::Vector2d& place) {
  ImageMotion motion;
  motion << -1.0, 0.0, place.x(), 0.0, -1.0, place.y();
  return motion;
}

const char* windowUseWords(WindowUse use) {
  static constexpr std::array<const char*, kWindowUses> kWords = {
      "used",
      "too few edges with a speed",
      "the image hardly moves",
      "most edges do not move as in a scene that stands still",
      "the rotation is not told",
      "no gyroscope samples at that time",
      "contradicts the other windows"};
  return kWords.at(static_cast<std::size_t>(use));
}

WindowMotion estimateWindowMotion(std::span<const EdgeSlope> slopes, const LensRays& lens, WindowTime time,
                                  const EgomotionOptions& options) {
  WindowMotion out;
  out.begin_s = secondsSince(time.start_ns, time.begin_ns);
  out.end_s = out.begin_s + options.window_s;
  std::vector<Row> rows = rowsOf(slopes, lens, time, options);
  out.slopes = rows.size();
  if (static_cast<int>(rows.size()) < options.least_slopes) return out;
  WindowFit fit(std::move(rows), static_cast<std::size_t>(options.depth_columns * options.depth_rows),
                options);
  if (!fit.start(false)) return out;
  fit.refine();
  const double alone = fit.medianSquare();
  out.turning_alone_rad_s = fit.motion().twist.head<3>();
  if (!fit.start(true)) return out;
  fit.refine();
  // As well, up to what three numbers more explain by chance.
  constexpr double kAsWell = 1.05, kNegligible = 0.01;  // squares of sigmas
  out.rotation_alone = alone <= kAsWell * fit.medianSquare() + kNegligible;
  out.inliers = fit.inlierShare();
  out.rate_rad_s = fit.motion().twist.head<3>();
  out.velocity_1_s = fit.motion().twist.tail<3>();
  constexpr double kShared = 12.0;  // slopes that have most of their neighbours in common
  out.covariance = fit.covariance(kShared).topLeftCorner<3, 3>();
  weighParts(fit, options.window_s, out);
  const double least_sigma_rad_s = std::sqrt(std::max(0.0, out.covariance.diagonal().minCoeff()));
  if (medianSpeed_px_s(fit, lens.focalLength_px()) < options.least_speed_px_s) {
    out.use = WindowUse::HardlyMoving;
  } else if (out.inliers < options.least_inliers) {
    out.use = WindowUse::NotExplained;
  } else if (!(least_sigma_rad_s < options.largest_sigma_rad_s) || !out.covariance.allFinite()) {
    out.use = WindowUse::Uncertain;
  } else {
    out.use = WindowUse::Used;
  }
  return out;
}

}  // namespace evical
