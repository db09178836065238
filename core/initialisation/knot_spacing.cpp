#include "core/initialisation/knot_spacing.h"

#include "core/base/time.h"
#include "core/data/unfit_samples.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/spline_basis.h"
#include "core/numerics/band_cholesky.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace evical {
namespace {

// From the closest to the widest.
constexpr std::array kSpacings_s = {kClosestKnots_s, 0.003, 0.0035, 0.004, 0.005,         0.006, 0.007,
                                    0.008,           0.009, 0.010,  0.012, 0.014,         0.016, 0.018,
                                    0.020,           0.023, 0.026,  0.030, 0.035,         0.040, 0.045,
                                    0.050,           0.060, 0.070,  0.085, kWidestKnots_s};
// A spline with fewer samples per knot follows their noise.
constexpr double kMinSamples_a_knot = 2.5;
// Allowed ratios of missed motion to the noise of a sample and to the precision of one view: missed motion
// repeats with the motion, and does not average out as noise does.
constexpr double kMissedOfNoise = 0.1, kMissedOfView = 0.04;
constexpr std::size_t kMinSamples = 50;

// The spline derivative that a sensor measures: its weights are those of a spline of lower degree.
enum class Felt { Velocity, Acceleration };

struct Signal {
  Felt felt;
  std::vector<double> times_s;
  std::vector<Eigen::Vector3d> values;

  std::size_t size() const { return values.size(); }
};

// Weights of the differences of control points, first or second ones.
using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1>;
Weights weightsOf(Felt felt, double u) {
  if (felt == Felt::Velocity) return cumulativeWeights(u, 1.0).first_s;
  return Eigen::Vector2d(1.0 - u, u);
}

// Residual of the best spline with some spacing for a signal.
struct Fit {
  std::vector<double> squares;  // by sample, of all three axes
  double points = 0.0;          // number of determined points
};

Fit fitSplines(const Signal& signal, double spacing_s) {
  const double begin_s = signal.times_s.front();
  const int segments = segmentsToCover(begin_s, signal.times_s.back(), spacing_s);
  const Eigen::Index degree = signal.felt == Felt::Velocity ? 2 : 1;
  const Eigen::Index count = segments + degree;
  BandCholesky normal(count, degree);
  Eigen::MatrixX3d points = Eigen::MatrixX3d::Zero(count, 3);
  std::vector<bool> seen(static_cast<std::size_t>(count), false);
  const auto visit = [&](auto&& use) {
    for (std::size_t i = 0; i < signal.size(); ++i) {
      const SplinePlace place = placeInSpline(begin_s, spacing_s, segments, signal.times_s[i]);
      use(i, static_cast<Eigen::Index>(place.segment), weightsOf(signal.felt, place.u));
    }
  };
  visit([&](std::size_t i, Eigen::Index first, const Weights& weights) {
    normal.addOuter(first, weights, 1.0);
    points.middleRows(first, degree + 1).noalias() += weights * signal.values[i].transpose();
    std::fill_n(seen.begin() + first, degree + 1, true);
  });
  normal.factorise();  // points without samples stay 0
  Eigen::MatrixXd solved = points;
  normal.solveInPlace(solved);
  Fit fit;
  visit([&](std::size_t i, Eigen::Index first, const Weights& weights) {
    const Eigen::Vector3d value = solved.middleRows(first, degree + 1).transpose() * weights;
    fit.squares.push_back((signal.values[i] - value).squaredNorm());
  });
  fit.points = static_cast<double>(std::count(seen.begin(), seen.end(), true));
  return fit;
}

// Mean by sample and axis, without the intervals with the largest means: splines need not follow knocks.
double typicalMean(const Signal& signal, const std::vector<double>& squares) {
  constexpr double kStretch_s = 0.5, kKnocks = 0.05;
  struct Stretch {
    double sum = 0.0, count = 0.0;
  };
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const auto at = static_cast<std::size_t>((signal.times_s[i] - signal.times_s.front()) / kStretch_s);
    if (at >= stretches.size()) stretches.resize(at + 1);
    stretches[at].sum += squares[i];
    stretches[at].count += 3.0;
  }
  std::erase_if(stretches, [](const Stretch& stretch) { return stretch.count == 0.0; });
  std::sort(stretches.begin(), stretches.end(),
            [](const Stretch& a, const Stretch& b) { return a.sum * b.count < b.sum * a.count; });
  stretches.resize(stretches.size() -
                   static_cast<std::size_t>(std::ceil(kKnocks * static_cast<double>(stretches.size() - 1))));
  Stretch all;
  for (const Stretch& stretch : stretches) all = {all.sum + stretch.sum, all.count + stretch.count};
  return all.sum / all.count;
}

// One sensor's samples, compared with splines of any spacing.
class Demand {
 public:
  // `given_noise`: sigma of a sample; `view`: precision of one view for the signal's first or second
  // integral.
  Demand(Signal signal, double closest_s, double given_noise, double view)
      : signal_(std::move(signal)), view_(view), closest_(fitSplines(signal_, closest_s)) {
    constexpr double kMinFree = 0.05;
    const double free = std::max(kMinFree, 1.0 - closest_.points / size());
    const double found = std::sqrt(typicalMean(signal_, closest_.squares) / free);
    // A filter in the sensor reduces noise at high frequencies. But a given density with a large margin must
    // not hide the motion.
    constexpr double kMax = 5.0, kMin = 0.1;
    noise_ = std::max({found, std::min(given_noise, kMax * found), kMin * given_noise});
  }

  KnotDemand widest(std::span<const double> spacings_s) const {
    // Wider spacings miss more.
    const auto far = std::partition_point(spacings_s.begin(), spacings_s.end(),
                                          [&](double spacing_s) { return isEnough(spacing_s); });
    const double spacing_s = far == spacings_s.begin() ? spacings_s.front() : *std::prev(far);
    return {spacing_s, noise_, std::sqrt(missed2(spacing_s))};
  }

 private:
  double size() const { return static_cast<double>(signal_.size()); }

  bool isEnough(double spacing_s) const {
    // Missed motion has at least half a period per knot, which bounds its integrals.
    const double frequency_rad_s = std::numbers::pi / spacing_s;
    const double moves = signal_.felt == Felt::Velocity ? frequency_rad_s : frequency_rad_s * frequency_rad_s;
    const double allowed = std::min(kMissedOfNoise * noise_, kMissedOfView * view_ * moves);
    return missed2(spacing_s) <= allowed * allowed;
  }

  // The larger of the residual at this spacing, and of the extrapolation from a wider one, whose residual
  // exceeds the noise: errors of linear splines grow with the square of the spacing, those of parabolas with
  // its third power.
  double missed2(double spacing_s) const {
    constexpr double kWider = 3.0;
    const double growth = std::pow(kWider, signal_.felt == Felt::Velocity ? 3.0 : 2.0);
    return std::max({0.0, seen2(spacing_s), seen2(kWider * spacing_s) / (growth * growth)});
  }

  // Residual minus the noise that more knots would have followed, and minus its scatter.
  double seen2(double spacing_s) const {
    const Fit fit = fitSplines(signal_, spacing_s);
    std::vector<double> more;
    for (std::size_t i = 0; i < fit.squares.size(); ++i) more.push_back(fit.squares[i] - closest_.squares[i]);
    constexpr double kCertain_sigmas = 3.0;
    const double followed = closest_.points - fit.points;
    const double scatter = kCertain_sigmas * std::sqrt(2.0 / 3.0 * std::max(0.0, followed));
    return typicalMean(signal_, more) - noise_ * noise_ * (followed + scatter) / size();
  }

  Signal signal_;
  double view_;
  double noise_ = 0.0;
  Fit closest_;
};

// Uses the samples in `fit`. Forces are in a non-rotating frame, in which they are accelerations minus
// gravity.
std::array<Signal, 2> signalsOf(const ImuData& imu, const SampleSelection& fit, std::int64_t start_ns,
                                TimeRange range, const GyroRotation& rotation) {
  std::array<Signal, 2> signals = {Signal{Felt::Velocity, {}, {}}, Signal{Felt::Acceleration, {}, {}}};
  const auto add = [](Signal& signal, double time_s, const Eigen::Vector3d& value) {
    signal.times_s.push_back(time_s);
    signal.values.push_back(value);
  };
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    const ImuSample& sample = imu.samples[i];
    const double time_s = secondsSince(start_ns, sample.time_ns);
    if (time_s < range.begin_s || time_s > range.end_s) continue;
    if (fit.gyroscope[i]) add(signals[0], time_s, sample.angular_rate_rad_s);
    if (fit.accelerometer[i]) add(signals[1], time_s, rotation.at(time_s) * sample.specific_force_m_s2);
  }
  return signals;
}

// The slower of the two sensors is decisive: a driver may repeat its samples.
double closestKnots_s(const ImuData& imu, const SampleSelection& fit) {
  double period_s = 0.0;
  for (const std::vector<std::uint8_t>* const taken : {&fit.gyroscope, &fit.accelerometer}) {
    std::vector<double> periods_s;
    std::optional<std::int64_t> last_ns;
    for (std::size_t i = 0; i < imu.samples.size(); ++i) {
      if (!(*taken)[i]) continue;
      if (last_ns) periods_s.push_back(secondsSince(*last_ns, imu.samples[i].time_ns));
      last_ns = imu.samples[i].time_ns;
    }
    period_s = std::max(period_s, medianOf(std::move(periods_s)));
  }
  return std::clamp(kMinSamples_a_knot * period_s, kClosestKnots_s, kWidestKnots_s);
}

}  // namespace

ViewPrecision viewPrecision(std::span<const CameraData> cameras, std::span<const AlignedCamera> aligned) {
  ViewPrecision best;
  for (const AlignedCamera& each : aligned) {
    const CameraData& camera = cameras[each.camera];
    std::vector<double> angles_rad, distances_m;
    for (const CameraPose& pose : each.poses) {
      const double circles = static_cast<double>(camera.observations.views[pose.view].circles.size());
      const double focal_px = idealFocalLength_px(*camera.lens.detection_intrinsics).mean();
      angles_rad.push_back(pose.reprojection_px / (focal_px * std::sqrt(circles)));
      distances_m.push_back(pose.world_from_camera.translation_m.norm());
    }
    const double angle_rad = medianOf(std::move(angles_rad), best.angle_rad);
    best.angle_rad = std::min(best.angle_rad, angle_rad);
    best.position_m = std::min(best.position_m, angle_rad * medianOf(std::move(distances_m), 1.0));
  }
  return best;
}

double closestKnots_s(const ImuData& imu) {
  return closestKnots_s(imu, fitSamples(imu.samples));
}

KnotSpacing knotSpacing(const ImuData& imu, std::int64_t start_ns, TimeRange range,
                        const GyroRotation& rotation, const ViewPrecision& views) {
  KnotSpacing found;
  const SampleSelection fit = fitSamples(imu.samples);
  std::array<Signal, 2> signals = signalsOf(imu, fit, start_ns, range, rotation);
  if (std::min(signals[0].size(), signals[1].size()) < kMinSamples) {
    found.rates.spacing_s = found.accelerations.spacing_s = kUsualKnot_s;
    return found;
  }
  const double closest_s = closestKnots_s(imu, fit);
  std::vector<double> spacings_s = {closest_s};
  std::copy_if(kSpacings_s.begin(), kSpacings_s.end(), std::back_inserter(spacings_s),
               [&](double spacing_s) { return spacing_s > closest_s; });
  found.rates = Demand(std::move(signals[0]), closest_s, imu.gyroscopeSigma_rad_s(), views.angle_rad)
                    .widest(spacings_s);
  found.accelerations =
      Demand(std::move(signals[1]), closest_s, imu.accelerometerSigma_m_s2(), views.position_m)
          .widest(spacings_s);
  return found;
}

std::string describe(const std::string& imu, const KnotSpacing& asked, double spacing_s) {
  const auto share = [](const KnotDemand& demand) {
    return demand.noise > 0.0 ? demand.missed / demand.noise : 0.0;
  };
  return fmt::format(
      "every {:.3g} ms; accelerations of {} allow {:.3g} ms, with missed motion of {:.2g} of a sample's "
      "noise, "
      "its rates {:.3g} ms ({:.2g})",
      1e3 * spacing_s, imu, 1e3 * asked.accelerations.spacing_s, share(asked.accelerations),
      1e3 * asked.rates.spacing_s, share(asked.rates));
}

}  // namespace evical
