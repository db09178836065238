#include "core/pipeline/maintain/maintained_quantities.h"

#include "core/base/nearest_name.h"
#include "core/data/quantity.h"
#include "core/geometry/so3.h"
#include "core/maintenance/maintenance_options.h"
#include "core/numerics/chi_squared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace evical {
namespace {

constexpr std::string_view kMisalignment = "accelerometer_misalignment";
constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

// Name and unit of a block of numbers.
struct BlockWords {
  QuantityId id;
  const char *name, *title, *unit;
  double factor;  // from SI units
};
constexpr std::array<BlockWords, kPairBlocks.size()> kPairWords = {
    {{QuantityId::Rotation, "rotation", "rotation", "deg", kDegPerRad},
     {QuantityId::Translation, "translation", "lever arm", "mm", 1e3},
     {QuantityId::TimeOffset, "time_offset", "time offset", "ms", 1e3},
     {QuantityId::GyroscopeBias, "gyroscope_bias", "gyroscope bias", "rad/s", 1.0},
     {QuantityId::AccelerometerBias, "accelerometer_bias", "accelerometer bias", "m/s^2", 1.0}}};
constexpr std::array<BlockWords, kAccelerometerBlocks.size()> kStopWords = {
    {{QuantityId::AccelerometerBias, "accelerometer_bias", "accelerometer bias", "m/s^2", 1.0},
     {QuantityId::AccelerometerScaleMisalignment, "accelerometer_scale", "accelerometer scale", "1", 1.0},
     {QuantityId::AccelerometerScaleMisalignment, kMisalignment.data(), "accelerometer misalignment", "1",
      1.0}}};
constexpr std::array<const char*, 3> kMisalignments = {"xy", "xz", "yz"};

// Empty if the block has only one number.
std::string partName(const BlockWords& words, Eigen::Index i, Eigen::Index count) {
  if (count == 1) return {};
  return (words.name == kMisalignment ? kMisalignments : kAxes)[static_cast<std::size_t>(i)];
}

std::string numberName(const BlockWords& words, Eigen::Index i, Eigen::Index count) {
  return count == 1 ? words.name : fmt::format("{}.{}", words.name, partName(words, i, count));
}

TrackedQuantity trackedQuantity(const BlockWords& words, Eigen::Index count) {
  TrackedQuantity tracked{words.name, words.title, words.unit, {}};
  for (Eigen::Index i = 0; i < count; ++i) tracked.numbers.push_back({partName(words, i, count), {}, {}});
  return tracked;
}

double sigmaOfNorm(const Eigen::VectorXd& step, const Eigen::MatrixXd& covariance) {
  const double norm = step.norm();
  if (norm <= 0.0) return 0.0;
  return std::sqrt(std::max(0.0, (step.transpose() * covariance * step)(0, 0))) / norm;
}

// Allowed drift and required detectability, in displayed units.
struct Asked {
  double allowed_drift, required_detectability;
};
Asked askedOf(QuantityId id, const MaintenanceOptions& options) {
  switch (id) {
    case QuantityId::Rotation:
      return {options.stability_rotation_deg, options.matters_rotation_deg};
    case QuantityId::Translation:
      return {options.stability_translation_mm, options.matters_translation_mm};
    case QuantityId::TimeOffset:
      return {options.stability_time_offset_ms, options.matters_time_offset_ms};
    case QuantityId::GyroscopeBias:
      return {options.stability_gyroscope_bias_rad_s, options.matters_gyroscope_bias_rad_s};
    case QuantityId::AccelerometerBias:
      return {options.stability_accelerometer_bias_m_s2, options.matters_accelerometer_bias_m_s2};
    default:
      return {options.stability_imu_scale, options.matters_imu_scale};
  }
}

void setWords(const BlockWords& words, Finding& finding) {
  finding.id = words.id;
  finding.quantity = words.name;
  finding.title = words.title;
  finding.unit = words.unit;
}

// Finding without numbers.
Finding findingOf(const BlockWords& words, const std::string& sensor, FindingSource source,
                  const MaintenanceOptions& options) {
  Finding finding;
  finding.sensor = sensor;
  finding.source = source;
  setWords(words, finding);
  const Asked asked = askedOf(words.id, options);
  finding.allowed_drift = asked.allowed_drift;
  finding.required_detectability = asked.required_detectability;
  return finding;
}

void setChange(const BlockWords& words, const BlockChange& change, double limit, Finding& finding) {
  finding.change = words.factor * change.step.norm();
  finding.change_sigma = words.factor * sigmaOfNorm(change.step, change.covariance);
  finding.sigmas = std::sqrt(change.chi_square);
  finding.limit_sigmas = std::sqrt(limit);
}

// Sets the result of a block tested with others: as found if it has changed, else its result alone.
// `wider`: ratio of the actual variances to those of the test.
void setTested(const BlockWords& words, const StateBlock& block, const ChangeDetector& test,
               const std::vector<FoundChange>& changes, std::size_t which, double limit, double wider,
               Finding& finding) {
  BlockChange change = test.of(block);
  for (const FoundChange& each : changes) {
    if (each.block != which) continue;
    change = each.change;
    finding.changed = true;
  }
  change.covariance *= wider;
  setChange(words, change, limit, finding);
  finding.smallest_detectable_change =
      words.factor * smallestDetectable(std::sqrt(wider) * test.worstSigma(block), limit / wider);
}

double squared(double value) {
  return std::isfinite(value) ? value * value : 0.0;
}

// At rest the gyroscope measures only its bias.
void addGyroscopeBias(const StopCalibration& found, const NamedResult& before, std::size_t imu,
                      const MaintenanceOptions& options, double false_alarms, Maintenance& maintenance) {
  constexpr BlockWords kWords = {QuantityId::GyroscopeBias, "gyroscope_bias", "gyroscope bias", "rad/s", 1.0};
  const ImuState& state = before.result->state.imus[imu];
  const Eigen::Vector3d sigma_before = before.result->uncertainty.imus[imu].gyroscope_bias_std_rad_s;
  Finding finding = findingOf(kWords, before.imus[imu].name, FindingSource::Stops, options);
  Eigen::Vector3d variance;
  for (Eigen::Index i = 0; i < 3; ++i) {
    variance[i] = squared(found.gyroscope_bias_sigma_rad_s[i]) + squared(sigma_before[i]) +
                  squared(options.stability_gyroscope_bias_rad_s);
    finding.numbers.push_back({numberName(kWords, i, 3),
                               kWords.unit,
                               {state.gyroscope_bias_rad_s[i], sigma_before[i]},
                               {found.gyroscope_bias_rad_s[i], found.gyroscope_bias_sigma_rad_s[i]}});
  }
  variance = variance.cwiseMax(1e-20);
  BlockChange change;
  change.step = found.gyroscope_bias_rad_s - state.gyroscope_bias_rad_s;
  change.covariance = variance.asDiagonal();
  change.chi_square = (change.step.array().square() / variance.array()).sum();
  const double limit = chiSquaredLimit(false_alarms, 3);
  setChange(kWords, change, limit, finding);
  finding.smallest_detectable_change = smallestDetectable(std::sqrt(variance.maxCoeff()), limit);
  finding.changed = change.chi_square > limit;
  maintenance.findings.push_back(finding);
}

// Information of one source about an accelerometer.
struct AccelerometerEvidence {
  const AccelerometerMatrix& information;  // at the old numbers
  const AccelerometerVector &score, &now;
  const AccelerometerMatrix& covariance;  // of `now`
  FindingSource source;
};

void addAccelerometer(const AccelerometerEvidence& evidence, const NamedResult& before, std::size_t imu,
                      const MaintenanceOptions& options, double false_alarms, Maintenance& maintenance) {
  const ImuUncertainty& sigma = before.result->uncertainty.imus[imu];
  const AccelerometerVector old_numbers = accelerometerNumbers(before.result->state.imus[imu]);
  const Eigen::MatrixXd known = accelerometerVariances(sigma, options).asDiagonal();
  const ChangeDetector test(evidence.information, evidence.score, known);
  const std::vector<double> limits = limitsFor(kAccelerometerBlocks, false_alarms);
  const auto changes = findChanges(evidence.information, evidence.score, known, kAccelerometerBlocks, limits);
  MaintenanceOptions exact = options;
  exact.stability_accelerometer_bias_m_s2 = exact.stability_imu_scale = 0.0;
  const AccelerometerVector sigma_before = accelerometerVariances(sigma, exact).cwiseSqrt();
  for (std::size_t b = 0; b < kAccelerometerBlocks.size(); ++b) {
    const StateBlock& block = kAccelerometerBlocks[b];
    Finding finding = findingOf(kStopWords[b], before.imus[imu].name, evidence.source, options);
    for (Eigen::Index i = 0; i < block.size; ++i) {
      const Eigen::Index n = block.first + i;
      finding.numbers.push_back({numberName(kStopWords[b], i, block.size),
                                 kStopWords[b].unit,
                                 {old_numbers[n], sigma_before[n]},
                                 {evidence.now[n], std::sqrt(std::max(evidence.covariance(n, n), 0.0))}});
    }
    setTested(kStopWords[b], block, test, changes, b, limits[b], 1.0, finding);
    maintenance.findings.push_back(finding);
  }
}

// Numbers of the corrected nominal pair; rotation as a vector.
PairVector numbersOf(const PairNominal& nominal, const PairVector& correction) {
  PairVector numbers = correction;
  numbers.head<3>() =
      quaternionLog(quaternionExp(correction.head<3>()) * nominal.reference_from_imu.rotation);
  numbers.segment<3>(3) += nominal.reference_from_imu.translation_m;
  numbers[6] += nominal.time_offset_s;
  return numbers;
}

// Old result relative to the nominal pair.
PairVector beforeFrom(const TrackedPair& pair) {
  PairVector state = PairVector::Zero();
  state.head<3>() = quaternionLog(pair.before.reference_from_imu.rotation *
                                  pair.nominal.reference_from_imu.rotation.conjugate());
  state.segment<3>(3) =
      pair.before.reference_from_imu.translation_m - pair.nominal.reference_from_imu.translation_m;
  state[6] = pair.before.time_offset_s - pair.nominal.time_offset_s;
  return state;
}

PairVector sigmasBefore(const TrackedPair& pair, const NamedResult& before) {
  const ImuUncertainty &own = before.result->uncertainty.imus[pair.imu],
                       &reference = before.result->uncertainty.imus[pair.reference];
  const auto together = [](double a, double b) { return std::sqrt(squared(a) + squared(b)); };
  PairVector sigma;
  for (Eigen::Index i = 0; i < 3; ++i) {
    sigma[i] = together(own.rotation_std_rad[i], reference.rotation_std_rad[i]);
    sigma[3 + i] = together(own.translation_std_m[i], reference.translation_std_m[i]);
    sigma[7 + i] = together(own.gyroscope_bias_std_rad_s[i], reference.gyroscope_bias_std_rad_s[i]);
    sigma[10 + i] = together(own.accelerometer_bias_std_m_s2[i], reference.accelerometer_bias_std_m_s2[i]);
  }
  sigma[6] = together(own.time_offset_std_s, reference.time_offset_std_s);
  return sigma;
}

void addSteps(const TrackedPair& pair, const NamedResult& before, Maintenance& maintenance) {
  for (const PairStep& found : pair.track.steps) {
    const BlockWords& words = kPairWords[found.block];
    const StateBlock& block = kPairBlocks[found.block];
    MaintenanceStep step;
    step.sensor = before.imus[pair.imu].name;
    step.against = before.imus[pair.reference].name;
    step.source = FindingSource::OtherImu;
    setWords(words, step);
    step.changed = true;
    step.at_s = found.at_s;
    step.noticed_s = found.noticed_s;
    setChange(words, found.change, found.limit, step);
    for (Eigen::Index i = 0; i < block.size; ++i)
      step.numbers.emplace_back(ComparedNumber{numberName(words, i, block.size), words.unit}).change = {
          words.factor * found.change.step[i],
          words.factor * std::sqrt(std::max(found.change.covariance(i, i), 0.0))};
    for (const std::size_t other : found.alternatives)
      step.alternatives.emplace_back(kPairWords[other].title);
    maintenance.steps.push_back(step);
  }
}

void addTrack(const TrackedPair& pair, const NamedResult& before, Maintenance& maintenance) {
  MaintenanceTrack track;
  track.sensor = before.imus[pair.imu].name;
  track.against = before.imus[pair.reference].name;
  track.times_s = pair.track.times_s;
  for (std::size_t b = 0; b < kPairBlocks.size(); ++b) {
    track.quantities.push_back(trackedQuantity(kPairWords[b], kPairBlocks[b].size));
    for (Eigen::Index i = 0; i < kPairBlocks[b].size; ++i) {
      TrackedNumber& number = track.quantities.back().numbers[static_cast<std::size_t>(i)];
      const Eigen::Index n = kPairBlocks[b].first + i;
      const double at_nominal = numbersOf(pair.before, PairVector::Zero())[n];
      for (std::size_t k = 0; k < track.times_s.size(); ++k) {
        // Rotations and lever arms are differences from the old result.
        const double now = b == 0 ? (pair.track.values[k] - beforeFrom(pair))[n]
                                  : numbersOf(pair.nominal, pair.track.values[k])[n] - at_nominal;
        number.values.push_back(kPairWords[b].factor * now);
        number.sigmas.push_back(kPairWords[b].factor * pair.track.sigmas[k][n]);
      }
    }
  }
  maintenance.tracks.push_back(std::move(track));
}

std::string changeText(const Finding& finding) {
  std::string text =
      fmt::format("{} of {}{} by {:.3g}", finding.title, finding.sensor,
                  finding.against.empty() ? "" : " against " + finding.against, finding.change);
  if (finding.unit != "1") text += " " + finding.unit;
  return finding.alternatives.empty() ? text : fmt::format("{} (or {})", text, joined(finding.alternatives));
}

// Quantities between IMUs if there are several; otherwise those of the single IMU.
bool isAsked(const Finding& finding, bool several) {
  const QuantityId id = finding.id;
  if (several)
    return finding.source == FindingSource::OtherImu &&
           (id == QuantityId::Rotation || id == QuantityId::Translation || id == QuantityId::TimeOffset);
  return id == QuantityId::AccelerometerBias ||
         (id == QuantityId::AccelerometerScaleMisalignment && finding.quantity != kMisalignment) ||
         (id == QuantityId::GyroscopeBias && finding.source == FindingSource::Stops);
}

void setChanged(Maintenance& maintenance) {
  maintenance.verdict = Verdict::Changed;
  std::string since, on_the_way;
  for (const Finding& finding : maintenance.findings)
    if (finding.changed) since += (since.empty() ? "" : "; ") + changeText(finding);
  for (const MaintenanceStep& step : maintenance.steps)
    on_the_way +=
        fmt::format("{}at {:.1f} s: {}", on_the_way.empty() ? "" : "; ", step.at_s, changeText(step));
  if (!since.empty()) maintenance.reason = "since the calibration: " + since;
  if (!on_the_way.empty()) maintenance.reason += (since.empty() ? "" : "; ") + on_the_way;
}

}  // namespace

MaintainedImu maintainedImu(const StopCalibration& found) {
  MaintainedImu imu;
  for (std::size_t s = 0; s < found.stops.size(); ++s)
    imu.stops.push_back({found.stops[s].from_s, found.stops[s].to_s, found.stops[s].force_m_s2,
                         found.stops[s].rate_rad_s, found.residuals_m_s2[s], found.sigmas_m_s2[s],
                         found.used[s] != 0});
  imu.weakest = found.weakest;
  imu.weakest_sigma = found.weakest_sigma;
  imu.misfit = found.misfit;
  return imu;
}

void addStopQuantities(const StopCalibration& found, const NamedResult& before, std::size_t imu,
                       const MaintenanceOptions& options, double false_alarms, Maintenance& maintenance) {
  if (found.stops.empty()) return;
  addAccelerometer({found.information, found.score, found.now, found.covariance, FindingSource::Stops},
                   before, imu, options, false_alarms, maintenance);
  addGyroscopeBias(found, before, imu, options, false_alarms, maintenance);
}

void addTrajectoryQuantities(const std::vector<LagEstimate>& lags, const LagSum& sum,
                             const NamedResult& before, std::size_t imu, const MaintenanceOptions& options,
                             double false_alarms, Maintenance& maintenance) {
  if (lags.empty()) return;
  addAccelerometer({sum.information, sum.score, sum.now, sum.covariance, FindingSource::Trajectory}, before,
                   imu, options, false_alarms, maintenance);
  MaintenanceTrack track;
  track.sensor = before.imus[imu].name;
  const AccelerometerVector old_numbers = accelerometerNumbers(before.result->state.imus[imu]);
  for (const LagEstimate& lag : lags) track.times_s.push_back(0.5 * (lag.from_s + lag.to_s));
  for (std::size_t b = 0; b < kAccelerometerBlocks.size(); ++b) {
    track.quantities.push_back(trackedQuantity(kStopWords[b], kAccelerometerBlocks[b].size));
    for (Eigen::Index i = 0; i < kAccelerometerBlocks[b].size; ++i) {
      const Eigen::Index n = kAccelerometerBlocks[b].first + i;
      TrackedNumber& number = track.quantities.back().numbers[static_cast<std::size_t>(i)];
      for (const LagEstimate& lag : lags) {
        number.values.push_back(lag.now[n] - old_numbers[n]);
        number.sigmas.push_back(std::sqrt(std::max(sum.inflation * lag.covariance(n, n), 0.0)));
      }
    }
  }
  maintenance.tracks.push_back(std::move(track));
}

void addPairQuantities(const TrackedPair& pair, const NamedResult& before, const MaintenanceOptions& options,
                       double false_alarms, Maintenance& maintenance) {
  const PairVector old_state = beforeFrom(pair), sigma_before = sigmasBefore(pair, before);
  PairVector variance = sigma_before.cwiseAbs2() + pairStability(options), of_stamps = PairVector::Zero();
  of_stamps[6] = pair.stamp_error_s * pair.stamp_error_s;  // constant, and in no residual
  variance += of_stamps;
  const Eigen::MatrixXd covariance = variance.asDiagonal();
  const Eigen::MatrixXd information = pair.track.start_information;
  const Eigen::VectorXd score = pair.track.start_score - pair.track.start_information * old_state;
  const ChangeDetector test(information, score, covariance);
  std::vector<double> limits = limitsFor(kPairBlocks, false_alarms);
  for (std::size_t b = 0; b < limits.size(); ++b)
    limits[b] = pair.track.colours[b].limit(limits[b], kPairBlocks[b].size, pair.track.colours[b].ofMany());
  const auto changes = findChanges(information, score, covariance, kPairBlocks, limits);
  const PairVector numbers_before = numbersOf(pair.before, PairVector::Zero()),
                   numbers_now = numbersOf(pair.nominal, pair.track.start);
  for (std::size_t b = 0; b < kPairBlocks.size(); ++b) {
    const StateBlock& block = kPairBlocks[b];
    Finding finding = findingOf(kPairWords[b], before.imus[pair.imu].name, FindingSource::OtherImu, options);
    finding.against = before.imus[pair.reference].name;
    for (Eigen::Index i = 0; i < block.size; ++i) {
      const Eigen::Index n = block.first + i;
      finding.numbers.push_back(
          {numberName(kPairWords[b], i, block.size),
           kPairWords[b].unit,
           {kPairWords[b].factor * numbers_before[n], kPairWords[b].factor * sigma_before[n]},
           {kPairWords[b].factor * numbers_now[n],
            kPairWords[b].factor *
                std::sqrt(std::max(pair.track.start_covariance(n, n), 0.0) + of_stamps[n])}});
    }
    setTested(kPairWords[b], block, test, changes, b, limits[b], pair.track.colours[b].ofMany(), finding);
    maintenance.findings.push_back(finding);
  }
  addSteps(pair, before, maintenance);
  addTrack(pair, before, maintenance);
}

void judge(Maintenance& maintenance) {
  const std::vector<Finding>& findings = maintenance.findings;
  const auto isChanged = [](const Finding& finding) { return finding.changed; };
  if (!maintenance.steps.empty() || std::any_of(findings.begin(), findings.end(), isChanged)) {
    setChanged(maintenance);
    return;
  }
  const bool several = maintenance.imus.size() > 1;
  std::string untold;
  bool any = false;
  for (const Finding& finding : findings) {
    if (!isAsked(finding, several)) continue;
    // Another source may be conclusive.
    const auto better = [&](const Finding& other) {
      return other.quantity == finding.quantity && other.sensor == finding.sensor && other.isConclusive();
    };
    any = true;
    if (std::any_of(findings.begin(), findings.end(), better)) continue;
    const std::string name = fmt::format("{} of {}", finding.title, finding.sensor);
    if (untold.find(name) == std::string::npos) untold += (untold.empty() ? "" : ", ") + name;
  }
  maintenance.verdict = any && untold.empty() ? Verdict::Unchanged : Verdict::CannotTell;
  if (maintenance.verdict == Verdict::Unchanged)
    maintenance.reason = "no change was detected, and a relevant change would have been detected";
  else if (maintenance.reason.empty())  // otherwise the reason is already set
    maintenance.reason = any ? "the log does not sufficiently constrain " + untold
                             : "the log has neither stops nor a second IMU nor a trajectory for a comparison";
}

namespace {

constexpr double kTogether_s = 3.0;  // accuracy of the times of steps

bool isAlike(const MaintenanceStep& a, const MaintenanceStep& b) {
  return a.quantity == b.quantity && a.against == b.against && std::abs(a.at_s - b.at_s) <= kTogether_s;
}

std::set<std::string> sensorsAgainst(const Maintenance& maintenance, const std::string& reference) {
  std::set<std::string> sensors;
  for (const MaintenanceTrack& track : maintenance.tracks)
    if (track.against == reference) sensors.insert(track.sensor);
  return sensors;
}

// The step that was detected first, with the most accurate size.
MaintenanceStep stepOfReference(const std::vector<MaintenanceStep>& alike) {
  MaintenanceStep step = *std::min_element(alike.begin(), alike.end(), [](const auto& a, const auto& b) {
    return a.change_sigma < b.change_sigma;
  });
  for (const MaintenanceStep& each : alike) step.noticed_s = std::min(step.noticed_s, each.noticed_s);
  step.sensor = step.against;
  step.against.clear();
  step.numbers.clear();
  return step;
}

}  // namespace

void nameChangedReference(Maintenance& maintenance) {
  std::vector<MaintenanceStep> left = maintenance.steps, named;
  while (!left.empty()) {
    const MaintenanceStep first = left.front();
    const auto others = std::stable_partition(left.begin(), left.end(),
                                              [&](const auto& step) { return isAlike(step, first); });
    const std::vector<MaintenanceStep> alike(left.begin(), others);
    left.erase(left.begin(), others);
    std::set<std::string> sensors;
    for (const MaintenanceStep& step : alike) sensors.insert(step.sensor);
    const std::set<std::string> all = sensorsAgainst(maintenance, first.against);
    if (all.size() > 1 && sensors == all)
      named.push_back(stepOfReference(alike));
    else
      named.insert(named.end(), alike.begin(), alike.end());
  }
  maintenance.steps = named;
}

}  // namespace evical
