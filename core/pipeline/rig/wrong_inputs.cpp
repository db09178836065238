#include "core/pipeline/rig/wrong_inputs.h"

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/projection_difference.h"
#include "core/initialisation/agreement_check.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/rotation_rates.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/numerics/robust.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/recording/imu_statistics.h"
#include "core/recording/inspection.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace evical {
namespace {

double readAsRate_rad_s(const SessionImu* imu) {
  return imu == nullptr
             ? 1.0
             : imu->angular_rate_factor *
                   radiansPerSecond(imu->angular_rate_unit.value_or(AngularRateUnit::RadiansPerSecond));
}

double readAsForce_m_s2(const SessionImu* imu) {
  return imu == nullptr
             ? 1.0
             : imu->acceleration_factor * std::abs(metresPerSecond2(imu->acceleration_unit.value_or(
                                              AccelerationUnit::MetresPerSecond2)));
}

// "3.2 times too large", "57 times too small"
std::string timesWords(double times) {
  return times >= 1.0 ? fmt::format("{:.3g} times too large", times)
                      : fmt::format("{:.3g} times too small", 1.0 / times);
}

struct WrongRates {
  CalibrationError error;
  bool certain;  // a unit explains the ratio
};

// Rates of all gyroscopes are compared with those of the first camera.
std::optional<WrongRates> wrongRates(const Session& session, const CalibrationInput& input,
                                     const RunContext& context) {
  const CameraData& camera = input.cameras.front();
  const InitialisationOptions& options = *session.options.initialisation;
  if (!camera.lens.detection_intrinsics) return std::nullopt;
  for (std::size_t k = 0; k < std::min(input.imus.size(), session.imus.size()); ++k) {
    const ImuData& imu = input.imus[k];
    const std::optional<RateRatio> found =
        rateRatio(camera, input.boardAt(camera.board), imu, input.start_ns, options, context);
    if (!found || std::abs(std::log(found->ratio)) < std::log(options.wrong_rate_ratio)) continue;
    const LikelyUnit unit = likelyUnitOfRates(&session.imus[k], found->ratio, options.rate_unit_tolerance);
    std::string problem = fmt::format("the gyroscope's rates are {} compared with the rotation of {}",
                                      timesWords(found->ratio), camera.name);
    if (!unit.words.empty()) problem += ": their unit seems to be " + unit.words;
    const double read_as = readAsRate_rad_s(&session.imus[k]);
    CalibrationError error = calibrationFailed(
        imu.name, problem,
        unit.words.empty()
            ? fmt::format("Check the gyroscope's scale (its measuring range), and the lens's focal lengths; "
                          "angular_rate_unit: {:.4g} rad/s would agree",
                          read_as / found->ratio)
            : fmt::format("Set angular_rate_unit: {} for this IMU", unit.setting));
    if (unit.only)
      error = std::move(error).repairedBy(Repair{"imus." + imu.name + ".angular_rate_unit", unit.setting});
    return WrongRates{error, !unit.words.empty()};
  }
  return std::nullopt;
}

// Accelerations whose norm is not gravity's, neither at the median nor as the mean in a frame that does not
// rotate.
std::optional<CalibrationError> wrongForces(const Session& session, const CalibrationInput& input) {
  const InspectionOptions limits;
  const InitialisationOptions& options = *session.options.initialisation;
  for (std::size_t k = 0; k < std::min(input.imus.size(), session.imus.size()); ++k) {
    const ImuData& imu = input.imus[k];
    if (deadAxis(imu) != nullptr) continue;  // this is the cause
    std::vector<ImuSample> forces;           // without those of separate gyroscopes
    std::ranges::copy_if(imu.samples, std::back_inserter(forces), measuresForce<ImuSample>);
    const double norm = medianForceNorm(forces);
    if (forces.empty() || isGravity(norm, limits) ||
        std::abs(std::log(norm / input.gravity_norm_m_s2)) < std::log(options.wrong_force_ratio) ||
        isGravity(steadyForceNorm(forces).value_or(norm), limits))
      continue;
    const LikelyUnit unit =
        likelyUnitOfForces(&session.imus[k], norm / input.gravity_norm_m_s2, options.force_unit_tolerance);
    return calibrationFailed(
        imu.name,
        fmt::format("the median norm of the accelerations is {:.3g} m/s^2 instead of about {:.3g}{}{}", norm,
                    input.gravity_norm_m_s2, unit.words.empty() ? "" : ": the unit seems to be ", unit.words),
        "Check acceleration_unit, the accelerometer's measuring range, and that gravity was not removed");
  }
  return std::nullopt;
}

const char* const kCorrectLens =
    "Remove intrinsics of this camera from the session, or give those of this lens at this resolution";

// Words for a given lens that differs from the recording's; empty if the difference is small.
std::string wrongLensWords(const CameraIntrinsics& given, const CameraIntrinsics& found, double sigma_px,
                           const InitialisationOptions& options) {
  const double diagonal_px = std::hypot(found.resolution_px.width_px, found.resolution_px.height_px);
  const ProjectionDifference difference = projectionDifference(found, given);
  const Eigen::Vector2d focal_px = idealFocalLength_px(found), given_px = idealFocalLength_px(given);
  const double times = std::sqrt((given_px.array() / focal_px.array()).prod());
  const double off_px =
      difference.places > 0 ? difference.rms_px : std::abs(std::log(times)) * 0.5 * diagonal_px;
  if (off_px < std::max(options.wrong_lens_share * diagonal_px, options.wrong_lens_sigmas * sigma_px))
    return {};
  const Eigen::Vector2d centre_px = found.principal_point_px;
  const double centre_times = given.principal_point_px.norm() / std::max(centre_px.norm(), 1.0);
  constexpr double kNoticeable = 1.05, kAlike = 0.1;
  std::string text = fmt::format(
      "the given lens differs from that of the recording by {} px (RMS over the image): focal lengths of "
      "{:.4g} and {:.4g} px agree, the given ones ({:.4g} and {:.4g} px) are {}",
      off_px < 10.0 ? fmt::format("{:.2g}", off_px) : fmt::format("{:.0f}", off_px),
      found.focal_length_px.x(), found.focal_length_px.y(), given.focal_length_px.x(),
      given.focal_length_px.y(),
      std::abs(std::log(times)) > std::log(kNoticeable)
          ? timesWords(times)
          : std::string("similar, so the distortion, its model or the principal point is wrong"));
  if (std::abs(std::log(times)) > std::log(kNoticeable) && std::abs(centre_times / times - 1.0) < kAlike)
    text += ", and the principal point alike: the lens seems to be that of another resolution";
  return text;
}

// True if a number of the lens differs by more than its sigma explains: a recording may not determine the
// lens.
bool differs(const CameraIntrinsics& given, const CameraIntrinsics& found,
             const std::optional<std::array<double, 9>>& sigmas, double limit_sigmas) {
  if (!sigmas || given.model != found.model) return true;
  std::array<double, 9> a{}, b{};
  writeIntrinsics(given, a.data());
  writeIntrinsics(found, b.data());
  for (std::size_t k = 0; k < a.size(); ++k)
    if ((*sigmas)[k] > 0.0 && std::abs(a[k] - b[k]) > limit_sigmas * (*sigmas)[k]) return true;
  return false;
}

// True if rows of circles are visible in some windows. With a wrong lens they are, but they do not fit the
// board.
bool showsLattices(const BoardObservations& seen) {
  const auto isLattice = [](const WindowReport& window) {
    return window.outcome != WindowOutcome::TooFewEvents && window.outcome != WindowOutcome::TooFewCircles &&
           window.outcome != WindowOutcome::NoLattice && window.outcome != WindowOutcome::Unreadable;
  };
  constexpr std::ptrdiff_t kOneIn = 5;
  return kOneIn * std::ranges::count_if(seen.windows, isLattice) > std::ssize(seen.windows);
}

// The lens from the views alone; if these do not determine it, from the recording.
std::optional<IntrinsicsResult> lensAlone(const Session& session, const CalibrationInput& input,
                                          std::size_t camera, bool recording_is_there,
                                          const RunContext& context) {
  const CameraData& data = input.cameras[camera];
  const RunContext quiet{silentProgress(), context.stop};
  try {
    return estimateIntrinsics({input.boardAt(data.board), data.lens.detection_intrinsics->resolution_px,
                               data.observations, data.lens.detection_intrinsics, std::nullopt},
                              *session.options.intrinsics, quiet);
  } catch (const CalibrationError&) {
    if (!recording_is_there || !showsLattices(data.observations)) return std::nullopt;
  }
  try {
    return calibrateIntrinsics(session, camera, quiet).result;
  } catch (const CalibrationError&) {
    return std::nullopt;  // the recording does not determine this lens
  }
}

std::optional<CalibrationError> wrongLens(const Session& session, const CalibrationInput& input,
                                          bool recording_is_there, const RunContext& context) {
  for (std::size_t k = 0; k < input.cameras.size(); ++k) {
    if (!session.cameras[k].intrinsics || session.sensorOf(k) != k) continue;
    const std::optional<IntrinsicsResult> found = lensAlone(session, input, k, recording_is_there, context);
    if (!found) continue;
    const std::string& name = session.cameras[k].name;
    const std::string problem = wrongLensWords(*session.cameras[k].intrinsics, found->intrinsics,
                                               found->image.rms_px, *session.options.initialisation);
    if (!problem.empty()) return calibrationFailed(name, problem, kCorrectLens);
  }
  return std::nullopt;
}

// Radius of the circles by their edges, in units of the given one; empty if no view shows it.
std::optional<double> seenRadius(const CameraData& camera, const Board& board) {
  constexpr std::size_t kMinCircles = 8, kMinViews = 10;
  std::vector<double> ratios;
  for (const BoardView& view : camera.observations.views) {
    if (view.circles.size() < kMinCircles) continue;
    // Affine map from the board to the image, by least squares.
    Eigen::MatrixX3d places(static_cast<Eigen::Index>(view.circles.size()), 3);
    Eigen::MatrixX2d pixels(places.rows(), 2);
    std::vector<double> radii_px;
    for (std::size_t i = 0; i < view.circles.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      places.row(row) << board.point_m(view.circles[i].circle).transpose(), 1.0;
      pixels.row(row) = view.circles[i].centre_px.transpose();
      radii_px.push_back(std::sqrt(view.circles[i].semi_axes_px.prod()));
    }
    const Eigen::Matrix<double, 3, 2> affine =
        (places.transpose() * places).ldlt().solve(places.transpose() * pixels);
    const double px_per_m = std::sqrt(std::abs(affine.topRows<2>().determinant()));
    const double radius_px = medianOf(std::move(radii_px));
    if (px_per_m > 0.0 && radius_px > 0.0) ratios.push_back(radius_px / (px_per_m * board.radius_m));
  }
  if (ratios.size() < kMinViews) return std::nullopt;
  return medianOf(std::move(ratios));
}

bool isFar(double ratio, double bound) {
  return !(std::abs(std::log(ratio)) < std::log(bound));
}

// Spacing by accelerations, and radius relative to it by the circles' edges: one reason for both.
std::optional<QualityWarning> wrongBoard(const CalibrationInput& input, const Initialisation& initial,
                                         const InitialisationOptions& options) {
  const double scale = initial.board_scale;
  const bool wrong_spacing = isFar(scale, options.wrong_size_ratio);
  for (const CameraData& camera : input.cameras) {
    const Board& board = input.boardAt(camera.board);
    const std::optional<double> seen =
        board.hasCircles() ? seenRadius(camera, board) : std::optional<double>();
    if (!seen || !isFar(*seen, options.wrong_radius_ratio)) continue;
    const double of_spacing = wrong_spacing && camera.board == 0 ? scale : 1.0;
    const double radius = *seen * of_spacing;  // in units of the given one
    if (!isFar(radius, options.wrong_radius_ratio)) continue;
    if (wrong_spacing && camera.board == 0) break;  // the spacing comes first
    return QualityWarning{fmt::format("{}: radius_m ({:.4g} m) is {}: the circles' edges agree with about "
                                      "{:.2g} m at this spacing. Measure "
                                      "the diameter of a circle, and give half of it",
                                      input.boardWords(camera.board), board.radius_m,
                                      timesWords(1.0 / radius), radius * board.radius_m),
                          {},
                          kWrongBoard};
  }
  if (!wrong_spacing) return std::nullopt;
  return QualityWarning{fmt::format("{}: spacing_m ({:.4g} m) is {}: accelerations agree with about {:.2g} "
                                    "m. Measure the board over as many "
                                    "spacings as possible, and give metres",
                                    input.boardWords(0), input.board.spacing_m, timesWords(1.0 / scale),
                                    scale * input.board.spacing_m),
                        {},
                        kWrongBoard};
}

// Drift without the pull of its prior around 0, which is strong where a wrong clock makes the other errors
// large. `as_weighed`: of the solution, so without what the errors add to the reported variance.
double driftByData_ppm(double drift_ppm, const QuantityAddress& number,
                       const UncertaintyEstimate& uncertainty, double prior_ppm, double min_share) {
  const std::optional<Eigen::Index> column = columnOf(number, uncertainty.report.columns);
  if (!column) return drift_ppm;
  const double of_prior = uncertainty.as_weighed(*column, *column) / (prior_ppm * prior_ppm);
  return drift_ppm / std::max(min_share, 1.0 - of_prior);
}

// Clocks of computers and sensors differ by some ten ppm; stamps that are computed from a nominal rate, by up
// to some percent. The batch estimates either, but accelerations and rates then have wrong scales.
std::optional<QualityWarning> wrongClock(const CalibrationInput& input, const CalibrationState& state,
                                         const UncertaintyEstimate& uncertainty, double prior_ppm,
                                         const InitialisationOptions& options) {
  constexpr double kUsual = 4.0;  // sigmas of the prior
  const bool of_imu = !input.imus.empty();
  const std::string& reference = of_imu ? input.imus[input.reference_imu].name : input.cameras.front().name;
  std::optional<QualityWarning> wrong;
  const auto test = [&](const char* group, const auto& data, const QuantityAddress& number,
                        double estimated_ppm, double sigma_ppm) {
    const double min_ppm =
        std::max(options.wrong_clock_prior_sigmas * prior_ppm, options.wrong_clock_sigmas * sigma_ppm);
    if (wrong || data.prior.time_offset_drift || !(std::abs(estimated_ppm) > min_ppm)) return;
    const double drift_ppm =
        driftByData_ppm(estimated_ppm, number, uncertainty, prior_ppm, options.wrong_clock_share);
    const double pace = 1.0 + 1e-6 * drift_ppm;
    wrong = QualityWarning{
        fmt::format("the clocks of {} and {} differ by {:.2g} % in their rates, others by less than "
                    "{:.2g} %. Check the rate with which stamps were computed: {}.{}.clock_scale: {:.6g} or "
                    "{}.{}.clock_scale: {:.6g} would agree",
                    data.name, reference, 1e-4 * std::abs(drift_ppm), 1e-4 * kUsual * prior_ppm,
                    of_imu ? "imus" : "cameras", reference, 1.0 / pace, group, data.name, pace),
        {},
        kWrongClock};
  };
  for (std::size_t k = 0; k < input.cameras.size(); ++k)
    test("cameras", input.cameras[k], {QuantityOwner::Camera, k, QuantityId::TimeOffsetDrift},
         state.cameras[k].time_offset_drift_ppm, uncertainty.report.cameras[k].time_offset_drift_std_ppm);
  for (std::size_t k = 0; k < input.imus.size(); ++k)
    test("imus", input.imus[k], {QuantityOwner::Imu, k, QuantityId::TimeOffsetDrift},
         state.imus[k].time_offset_drift_ppm, uncertainty.report.imus[k].time_offset_drift_std_ppm);
  return wrong;
}

// Noise density of samples: their third differences contain hardly any motion. Filters correlate neighbours,
// so the largest figure of several distances counts.
double sampleDensity(const ImuData& imu, bool of_gyroscope) {
  constexpr double kLongest_s = 4e-3;
  std::vector<Eigen::Vector3d> values;
  for (const ImuSample& sample : imu.samples) {
    if (of_gyroscope ? !measuresRate(sample) : !measuresForce(sample)) continue;
    values.push_back(of_gyroscope ? sample.angular_rate_rad_s : sample.specific_force_m_s2);
  }
  const double rate_hz = of_gyroscope ? imu.rate_hz() : imu.accelerometerRate_hz();
  const double of_differences = std::sqrt(20.0 * std::max(rate_hz, 1e-9));  // squares of 1, 3, 3, 1
  double largest = 0.0;
  for (std::size_t step = 1; step == 1 || static_cast<double>(step) <= kLongest_s * rate_hz; step *= 2) {
    std::vector<double> differences;
    for (std::size_t i = 3 * step; i < values.size(); ++i) {
      const Eigen::Vector3d difference =
          values[i] - 3.0 * values[i - step] + 3.0 * values[i - 2 * step] - values[i - 3 * step];
      for (int axis = 0; axis < 3; ++axis) differences.push_back(std::abs(difference[axis]));
    }
    largest = std::max(largest, kMadToSigma * medianOf(std::move(differences)) / of_differences);
  }
  return largest;
}

struct NoiseInput {
  const char* key;
  const char* unit;
  const char* other_unit;  // often confused
  double other;            // in the unit
};
constexpr NoiseInput kGyroscopeNoise = {"gyroscope_noise_density", "rad/s/sqrt(Hz)", "deg/s/sqrt(Hz)",
                                        kRadPerDeg};
constexpr NoiseInput kAccelerometerNoise = {"accelerometer_noise_density", "m/s^2/sqrt(Hz)", "mg/sqrt(Hz)",
                                            1e-3 * kStandardGravity_m_s2};

// `times`: the given density in units of the recording's.
QualityWarning noiseWarning(const std::string& imu, const NoiseInput& input, double given, double found,
                            double unit_ratio) {
  const double times = given / found;
  const bool other_unit = !isFar(times * input.other, unit_ratio);
  return {fmt::format(
              "{}: {} ({:.3g} {}) is {}: the samples have about {:.2g}{}. Give the data sheet's value in {}",
              imu, input.key, given, input.unit, timesWords(times), found,
              other_unit    ? fmt::format("; the given one seems to be in {}", input.other_unit)
              : times < 1.0 ? std::string(" (vibrations have the same effect)")
                            : std::string(),
              input.unit),
          {},
          kWrongNoise,
          times < 1.0 ? 1.0 : 0.0};
}

// Both densities are wrong, and each agrees with the other sensor's samples, whose densities are the
// arguments.
std::optional<QualityWarning> exchangedNoise(const ImuData& imu, double of_rates, double of_forces,
                                             double agreement_ratio) {
  const double rates = imu.noise.gyroscope_density, forces = imu.noise.accelerometer_density;
  const bool exchanged =
      isFar(of_rates / rates, agreement_ratio) && isFar(of_forces / forces, agreement_ratio) &&
      !isFar(of_rates / forces, agreement_ratio) && !isFar(of_forces / rates, agreement_ratio);
  if (!exchanged) return std::nullopt;
  return QualityWarning{
      fmt::format(
          "{}: gyroscope_noise_density ({:.3g} rad/s/sqrt(Hz)) and accelerometer_noise_density ({:.3g} "
          "m/s^2/sqrt(Hz)) seem to be exchanged: the samples have about {:.2g} and {:.2g}",
          imu.name, rates, forces, of_rates, of_forces),
      {},
      kWrongNoise,
      1.0};
}

}  // namespace

LikelyUnit likelyUnitOfRates(const SessionImu* imu, double times, double tolerance) {
  LikelyUnit unit = likelyRateUnit(readAsRate_rad_s(imu), times, tolerance);
  if (unit.words.empty() && (imu == nullptr || !imu->angular_rate_unit))
    unit = likelyRateUnit(radiansPerSecond(AngularRateUnit::DegreesPerSecond), times, tolerance);
  return unit;
}

LikelyUnit likelyUnitOfForces(const SessionImu* imu, double times, double tolerance) {
  LikelyUnit unit = likelyAccelerationUnit(readAsForce_m_s2(imu), times, tolerance);
  if (unit.words.empty() && (imu == nullptr || !imu->acceleration_unit))
    unit = likelyAccelerationUnit(metresPerSecond2(AccelerationUnit::Gravity), times, tolerance);
  return unit;
}

CalibrationError withWrongInput(const CalibrationError& error, const Session& session,
                                const CalibrationInput& input, const Initialisation& initial,
                                bool recording_is_there, const RunContext& context) {
  if (error.kind() != ErrorKind::CalibrationFailed) return error;
  if (const std::optional<CalibrationError> forces = wrongForces(session, input)) return *forces;
  if (error.repair()) return error;
  std::optional<WrongRates> rates;
  if (!input.cameras.empty() && !input.imus.empty()) rates = wrongRates(session, input, context);
  if (rates && rates->certain) return rates->error;
  if (const std::optional<CalibrationError> lens = wrongLens(session, input, recording_is_there, context))
    return *lens;
  if (const std::optional<QualityWarning> board = wrongBoard(input, initial, *session.options.initialisation))
    return calibrationFailed(session.source.string(), board->text, "Correct the board in the session");
  return rates ? rates->error : error;
}

std::vector<QualityWarning> wrongInputs(const Session& session, const CalibrationInput& input,
                                        const Initialisation& initial, const BatchSolution& solution,
                                        const UncertaintyEstimate& uncertainty) {
  const InitialisationOptions& options = *session.options.initialisation;
  std::vector<QualityWarning> wrong;
  for (std::size_t k = 0; k < input.cameras.size(); ++k) {
    const CameraLens& lens = solution.state.cameras[k].lens;
    if (!lens.given || !lens.solved || input.sensorOf(k) != k) continue;
    if (!differs(*lens.given, *lens.solved, uncertainty.report.cameras[k].intrinsics_std,
                 options.wrong_lens_sigmas))
      continue;
    const std::string words = wrongLensWords(*lens.given, *lens.solved, 0.0, options);
    if (!words.empty())
      wrong.push_back(
          {fmt::format("{}: {}. {}", input.cameras[k].name, words, kCorrectLens), {}, kWrongLens});
  }
  if (std::optional<QualityWarning> board = wrongBoard(input, initial, options))
    wrong.push_back(std::move(*board));
  if (std::optional<QualityWarning> clock =
          wrongClock(input, solution.state, uncertainty,
                     session.options.optimisation->time_offset_drift_sigma_ppm, options))
    wrong.push_back(std::move(*clock));
  return wrong;
}

std::optional<QualityWarning> wrongUnit(const Session& session, const CalibrationInput& input,
                                        const CalibrationResult& result, const RunContext& context) {
  if (input.cameras.empty() || input.imus.empty()) return std::nullopt;
  const bool another_is_wrong = std::ranges::any_of(result.causes, isWrongInput);
  std::optional<CalibrationError> error = wrongForces(session, input);
  if (!error && result.status != CalibrationStatus::Ok)
    if (const std::optional<WrongRates> rates = wrongRates(session, input, context);
        rates && (rates->certain || !another_is_wrong))
      error = rates->error;
  if (!error) return std::nullopt;
  return QualityWarning{fmt::format("{}: {}. {}", error->place(), error->problem(), error->advice()),
                        error->repair(), kWrongUnit};
}

std::vector<QualityWarning> wrongNoise(const Session& session, const CalibrationInput& input,
                                       const BatchSolution& solution) {
  const InitialisationOptions& options = *session.options.initialisation;
  const double ratio = options.wrong_noise_ratio;
  const double misfit = session.options.optimisation->doubtful_imu_misfit;
  std::vector<QualityWarning> wrong;
  for (std::size_t k = 0; k < input.imus.size(); ++k) {
    const ImuData& imu = input.imus[k];
    const double of_rates = sampleDensity(imu, true), of_forces = sampleDensity(imu, false);
    const auto test = [&](const NoiseInput& noise, double of_samples, double given, double residual_times) {
      const double white = of_samples / given;
      const bool too_large = std::max(white, residual_times) * ratio < 1.0;
      const bool too_small = white > ratio && residual_times > misfit &&
                             !isFar(white / residual_times, options.noise_agreement_ratio);
      if (white > 0.0 && (too_large || too_small))
        wrong.push_back(noiseWarning(imu.name, noise, given, given * white, options.noise_unit_ratio));
    };
    if (std::optional<QualityWarning> both =
            exchangedNoise(imu, of_rates, of_forces, options.noise_agreement_ratio)) {
      wrong.push_back(std::move(*both));
      continue;
    }
    const ImuFit& fit = solution.imus[k];
    test(kGyroscopeNoise, of_rates, imu.noise.gyroscope_density,
         fit.gyroscope_rms_rad_s / imu.gyroscopeSigma_rad_s());
    test(kAccelerometerNoise, of_forces, imu.noise.accelerometer_density,
         fit.accelerometer_rms_m_s2 / imu.accelerometerSigma_m_s2());
  }
  return wrong;
}

}  // namespace evical
