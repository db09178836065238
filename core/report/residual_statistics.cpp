#include "core/report/residual_statistics.h"

#include "core/base/time.h"
#include "core/data/imu_prediction.h"
#include "core/geometry/camera_model.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>

namespace evical {
namespace {

constexpr double kHistogramReach = 5.0;  // sigmas
constexpr int kBins = 50, kCellColumns = 16;

void addMoments(ResidualStatistics& statistics) {
  const auto n = static_cast<double>(statistics.used.size());
  double sum = 0.0, sum2 = 0.0;
  for (const CircleResidual& residual : statistics.used) {
    statistics.mean_px += residual.residual_px / n;
    const Eigen::Array2d normalised = residual.residual_px.array() / residual.sigma_px.array();
    sum += normalised.sum();
    sum2 += normalised.square().sum();
  }
  for (const CircleResidual& residual : statistics.used) {
    const Eigen::Vector2d d = residual.residual_px - statistics.mean_px;
    statistics.covariance_px2 += d * d.transpose() / n;
  }
  statistics.normalised_mean = sum / (2.0 * n);
  statistics.normalised_std =
      std::sqrt(std::max(0.0, sum2 / (2.0 * n) - statistics.normalised_mean * statistics.normalised_mean));
}

// Bins cover five times the spread; larger residuals count in the density but have no bin.
void addHistogram(ResidualStatistics& statistics) {
  const double reach = kHistogramReach * std::max(1.0, statistics.normalised_std);
  statistics.bin_width = 2.0 * reach / kBins;
  statistics.bin_density.assign(kBins, 0.0);
  for (int bin = 0; bin < kBins; ++bin)
    statistics.bin_middle.push_back((bin + 0.5) * statistics.bin_width - reach);
  const double one = 1.0 / (2.0 * static_cast<double>(statistics.used.size()) * statistics.bin_width);
  for (const CircleResidual& residual : statistics.used) {
    for (int axis = 0; axis < 2; ++axis) {
      const double bin =
          std::floor((residual.residual_px[axis] / residual.sigma_px[axis] + reach) / statistics.bin_width);
      if (bin >= 0.0 && bin < kBins) statistics.bin_density[static_cast<std::size_t>(bin)] += one;
    }
  }
}

void addWindows(ResidualStatistics& statistics) {
  std::map<int, WindowResidual> by_view;
  for (const CircleResidual& residual : statistics.used) {
    WindowResidual& window = by_view[residual.view];
    window.view = residual.view;
    window.time_s += residual.time_s;
    window.rms_px += residual.residual_px.squaredNorm();
    ++window.circles;
  }
  for (auto& [view, window] : by_view) {
    window.time_s /= window.circles;
    window.rms_px = std::sqrt(window.rms_px / window.circles);
    statistics.windows.push_back(window);
  }
}

void addCells(ResidualStatistics& statistics, const CameraIntrinsics& intrinsics) {
  const Resolution size = intrinsics.resolution_px;
  if (!size.known()) return;
  statistics.resolution_px = size;
  statistics.columns = kCellColumns;
  const double cell_px = static_cast<double>(size.width_px) / kCellColumns;
  statistics.rows = std::max(1, static_cast<int>(std::lround(size.height_px / cell_px)));
  const Eigen::Array2d cell(cell_px, static_cast<double>(size.height_px) / statistics.rows);
  statistics.cells.resize(static_cast<std::size_t>(statistics.columns * statistics.rows));
  for (int row = 0; row < statistics.rows; ++row) {
    for (int column = 0; column < statistics.columns; ++column)
      statistics.cells[static_cast<std::size_t>(row * statistics.columns + column)].middle_px =
          Eigen::Vector2d((column + 0.5) * cell.x(), (row + 0.5) * cell.y());
  }
  for (const CircleResidual& residual : statistics.used) {
    const Eigen::Vector2d pixel = pixelFromIdeal(intrinsics, residual.centre_px);
    const int column = std::clamp(static_cast<int>(pixel.x() / cell.x()), 0, statistics.columns - 1);
    const int row = std::clamp(static_cast<int>(pixel.y() / cell.y()), 0, statistics.rows - 1);
    auto& here = statistics.cells[static_cast<std::size_t>(row * statistics.columns + column)];
    ++here.count;
    here.mean_px += idealPixelScale(intrinsics, residual.centre_px).inverse() * residual.residual_px;
  }
  for (auto& here : statistics.cells) {
    if (here.count > 0) here.mean_px /= here.count;
  }
}

}  // namespace

ResidualStatistics residualStatistics(const std::vector<CircleResidual>& residuals, int camera,
                                      const std::optional<CameraIntrinsics>& intrinsics) {
  ResidualStatistics statistics;
  for (const CircleResidual& residual : residuals) {
    if (residual.camera == camera) (residual.used ? statistics.used : statistics.dropped).push_back(residual);
  }
  const auto byX = [](const CircleResidual& a, const CircleResidual& b) {
    return a.residual_px.x() < b.residual_px.x();
  };
  std::sort(statistics.used.begin(), statistics.used.end(), byX);
  std::sort(statistics.dropped.begin(), statistics.dropped.end(), byX);
  if (statistics.used.empty()) return statistics;
  addMoments(statistics);
  addHistogram(statistics);
  addWindows(statistics);
  if (intrinsics) addCells(statistics, *intrinsics);
  return statistics;
}

std::vector<Eigen::Vector2d> sigmaEllipse(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                                          double sigmas) {
  constexpr int kPoints = 90;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Eigen::Matrix2d axes =
      sigmas * solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k <= kPoints; ++k) {
    const double angle = 2.0 * M_PI * k / kPoints;
    points.push_back(mean + axes * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

namespace {

void add(double time_s, const Eigen::Vector3d& measured, const Eigen::Vector3d& predicted,
         SensorSignal& signal) {
  signal.time_s.push_back(time_s);
  signal.measured.push_back(measured);
  signal.predicted.push_back(predicted);
}

}  // namespace

SignalPrediction predictSignals(const ImuData& data, std::int64_t start_ns, const CalibrationState& state,
                                std::size_t imu, const RunContext& context) {
  constexpr std::size_t kSamplesBetweenStops = 1024;
  const ImuState& imu_state = state.imus[imu];
  SignalPrediction prediction;
  for (std::size_t k = 0; k < data.samples.size(); ++k) {
    if (k % kSamplesBetweenStops == 0) context.throwIfStopped();
    const ImuSample& sample = data.samples[k];
    const double stamp_s = secondsSince(start_ns, sample.time_ns);
    const auto rate = predictedRate_rad_s(state, imu_state, stamp_s);
    const auto force = predictedForce_m_s2(state, imu_state, stamp_s);
    if (!rate || !force) continue;
    if (measuresRate(sample)) add(stamp_s, sample.angular_rate_rad_s, *rate, prediction.rate_rad_s);
    if (measuresForce(sample)) add(stamp_s, sample.specific_force_m_s2, *force, prediction.force_m_s2);
  }
  return prediction;
}

}  // namespace evical
