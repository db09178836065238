#include "core/pipeline/rig/residual_consistency.h"

#include "core/data/unfit_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace evical {
namespace {

constexpr double kMinSigma = 1e-150;

// True if gyroscope and accelerometer have separate stamps.
bool areApart(const ImuData& imu) {
  return std::any_of(imu.samples.begin(), imu.samples.end(),
                     [](const ImuSample& sample) { return sample.measured_by != MeasuredBy::Both; });
}

// A ratio with its bounds and the text that reports it.
struct Measure {
  double size, doubtful, failed;
  std::string words;
};

std::vector<Measure> measuresOf(const CalibrationInput& input, const BatchSolution& solution,
                                const VerdictOptions& options) {
  std::vector<Measure> all;
  for (std::size_t k = 0; k < input.cameras.size(); ++k) {
    const std::string& name = input.cameras[k].name;
    const double spread = solution.scales.circles[k];
    all.push_back(
        {spread, options.doubtful_circle_misfit, options.failed_circle_misfit,
         fmt::format("{}: residuals of points are {:.2g} times their sigmas: the board is not flat, "
                     "or the lens model does not fit",
                     name, spread)});
    const CameraFit& fit = solution.cameras[k];
    const double outliers =
        static_cast<double>(fit.circles_rejected) / std::max(1, fit.circles_rejected + fit.circles_used);
    all.push_back(
        {outliers, options.doubtful_outliers, options.failed_outliers,
         fmt::format("{}: {:.0f} % of the points contradict the others and were rejected as outliers", name,
                     100.0 * outliers)});
  }
  for (std::size_t k = 0; k < input.imus.size(); ++k) {
    const auto add = [&](double times, const char* what) {
      all.push_back(
          {times, options.doubtful_imu_misfit, options.failed_imu_misfit,
           fmt::format("{}: residuals of the {} are {:.2g} times those expected from the noise density",
                       input.imus[k].name, what, times)});
    };
    add(solution.scales.gyroscopes[k], "angular rates");
    add(solution.scales.accelerometers[k], "accelerations");
  }
  return all;
}

// Texts of the measures beyond their bound, the worst first.
std::string wordsBeyond(const std::vector<Measure>& measures, double Measure::*bound) {
  std::vector<const Measure*> beyond;
  for (const Measure& each : measures)
    if (each.size > each.*bound) beyond.push_back(&each);
  std::sort(beyond.begin(), beyond.end(), [&](const Measure* a, const Measure* b) {
    return a->size / (a->*bound) > b->size / (b->*bound);
  });
  std::string words;
  for (const Measure* each : beyond) words += (words.empty() ? "" : "; ") + each->words;
  return words;
}

}  // namespace

MisfitVerdict judgeMisfit(const CalibrationInput& input, const BatchSolution& solution,
                          const VerdictOptions& options) {
  const std::vector<Measure> measures = measuresOf(input, solution, options);
  return {wordsBeyond(measures, &Measure::failed), wordsBeyond(measures, &Measure::doubtful)};
}

std::string scatteringStampsIn(const CalibrationInput& input, const BatchSolution& solution,
                               const std::vector<RecordingFault>& faults, const VerdictOptions& options) {
  std::string found;
  for (std::size_t k = 0; k < input.imus.size(); ++k) {
    const double misfit = std::max(solution.scales.gyroscopes[k], solution.scales.accelerometers[k]);
    if (misfit < options.scattering_stamps_misfit) continue;
    const std::string& name = input.imus[k].name;
    for (const RecordingFault& fault : faults) {
      if (fault.kind != FaultKind::Jitter || fault.stream != name) continue;
      found += fmt::format("{}{}: {}", found.empty() ? "" : "; ", name, fault.text);
    }
  }
  return found;
}

void addStampErrors(const CalibrationInput& input, const std::vector<double>& steps_s,
                    const VerdictOptions& options, CalibrationResult& result) {
  if (steps_s.empty()) return;
  UncertaintyReport& report = result.uncertainty;
  const auto variance_s2 = [&](std::size_t imu) { return 0.25 * steps_s[imu] * steps_s[imu]; };
  const double common_s2 = variance_s2(input.reference_imu);
  Eigen::MatrixXd covariance = report.covariance();
  const auto add = [&](Eigen::Index column, const QuantityAddress& number) {
    const bool own = number.owner == QuantityOwner::Imu && number.id == QuantityId::TimeOffset;
    const bool delay = number.id == QuantityId::AccelerometerDelay && areApart(input.imus[number.sensor]);
    if (own || delay) covariance(column, column) += variance_s2(number.sensor);
    if (number.id != QuantityId::TimeOffset) return;
    for (Eigen::Index k = 0; k < covariance.cols(); ++k)
      if (report.columns[static_cast<std::size_t>(k)].id == QuantityId::TimeOffset)
        covariance(column, k) += common_s2;
  };
  for (Eigen::Index k = 0; k < covariance.cols(); ++k) add(k, report.columns[static_cast<std::size_t>(k)]);
  report.standard_deviations = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd scale = report.standard_deviations.cwiseMax(kMinSigma).cwiseInverse();
  report.correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  report.correlation.diagonal().setOnes();
  for (std::size_t k = 0; k < report.columns.size(); ++k) {
    const QuantityAddress& number = report.columns[k];
    const double sigma = report.standard_deviations[static_cast<Eigen::Index>(k)];
    if (number.id == QuantityId::AccelerometerDelay)
      report.imus[number.sensor].accelerometer_delay_std_s = sigma;
    if (number.id != QuantityId::TimeOffset) continue;
    (number.owner == QuantityOwner::Camera ? report.cameras[number.sensor].time_offset_std_s
                                           : report.imus[number.sensor].time_offset_std_s) = sigma;
  }
  for (std::size_t k = 0; k < steps_s.size() && options.judge_sigmas; ++k)
    if (const double uncertain_ms = 0.5e3 * steps_s[k]; uncertain_ms > options.needed_time_offset_ms)
      flagDoubtful(
          fmt::format("the time stamps of {} have steps of {:.3g} ms, which leave an error of {:.2g} ms in "
                      "the time offset (needed: {:.2g}): record the sensor's own stamps in us",
                      input.imus[k].name, 2.0 * uncertain_ms, uncertain_ms, options.needed_time_offset_ms),
          result, "coarse_stamps");
}

std::string doubtOfHalves(const SplitHalfCheck& validation, const VerdictOptions& options) {
  if (!validation.failure.empty() || validation.rms_sigmas <= options.doubtful_halves_sigmas) return {};
  const QuantityDifference* worst = nullptr;
  for (const QuantityDifference& each : validation.quantities)
    if (worst == nullptr || std::abs(each.normalised()) > std::abs(worst->normalised())) worst = &each;
  return fmt::format(
      "the two halves of the recording differ by {:.1f} sigmas (RMS), the most in {}: a sensor has moved, or "
      "the session is incorrect",
      validation.rms_sigmas, worst->name);
}

std::vector<std::string> notesOnSlowPixels(const CalibrationInput& input, const VerdictOptions& options) {
  constexpr double kCertain_sigmas = 5.0;
  std::vector<std::string> notes;
  for (const CameraData& camera : input.cameras) {
    const auto& delay = camera.observations.polarity_delay;
    if (!delay) continue;
    const double later_ms = 1e3 * delay->later_s;
    if (!(std::abs(later_ms) > options.slow_pixels_ms + kCertain_sigmas * 1e3 * delay->std_s)) continue;
    notes.push_back(
        fmt::format("{}: edges that {} the image are seen {:.1f} ms later than those that {} it: the pixels "
                    "are slow. The time offset includes their delay at this light level. Record in brighter "
                    "light or with faster biases",
                    camera.name, later_ms > 0.0 ? "brighten" : "darken", std::abs(later_ms),
                    later_ms > 0.0 ? "darken" : "brighten"));
  }
  return notes;
}

QualityWarning saturationIn(const CalibrationInput& input, const VerdictOptions& options,
                            double heavy_share) {
  std::string words;
  double most = 0.0;
  for (const ImuData& imu : input.imus) {
    const std::array<double, kImuAxes.size()> shares = saturatedShares(imu.samples);
    for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis) {
      const double share = shares[axis];
      if (share <= options.saturated_share) continue;
      most = std::max(most, share);
      words += fmt::format("{}{}: {} is saturated in {:.0f} % of the samples", words.empty() ? "" : ", ",
                           imu.name, kImuAxes[axis].name, 100.0 * share);
    }
  }
  if (words.empty()) return {};
  return {words + ", which were excluded: move more slowly, or increase the IMU's measuring range",
          {},
          most > heavy_share ? "heavy_saturation" : "saturation"};
}

double totalMisfit(const BatchSolution& solution) {
  double sum = 0.0;
  const auto add = [&](const std::vector<double>& scales) {
    for (const double scale : scales) sum += std::log(std::max(scale, 1.0));
  };
  add(solution.scales.circles);
  add(solution.scales.gyroscopes);
  add(solution.scales.accelerometers);
  return sum;
}

}  // namespace evical
