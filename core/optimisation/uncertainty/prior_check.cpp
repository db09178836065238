#include "core/optimisation/uncertainty/prior_check.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/progress.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/known_values.h"
#include "core/optimisation/uncertainty/covariance.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace evical {
namespace {

constexpr double kNoNeed = std::numeric_limits<double>::infinity();

struct Unit {
  const char* name;
  double factor;  // from SI
  double need;    // SI
};

// One number, in SI units.
struct Compared {
  double known, known_sigma;  // 0: given
  double alone, alone_sigma;  // what the recording alone says
  double pull;                // that, less the solution
};

class Comparison {
 public:
  Comparison(const CalibrationInput& input, const OptimisationOptions& options,
             const CalibrationState& solution, const CalibrationState& alone, const UncertaintyReport& sigmas)
      : input_(input), options_(options), solution_(solution), alone_(alone), sigmas_(sigmas) {}

  PriorCheck run();

 private:
  template <class Sigmas>
  void comparePlace(const std::string& sensor, const SensorPrior& prior, const RigidTransform& solution,
                    const RigidTransform& alone, const Sigmas& sigma);
  void compareOffset(const std::string& sensor, const SensorPrior& prior, double solution_s, double alone_s,
                     double sigma_s);
  void compareVector(const std::string& name, const Unit& unit, const KnownVector& known,
                     const Eigen::Vector3d& solution, const Eigen::Vector3d& alone,
                     const Eigen::Vector3d& sigma);
  void compareMapping(const std::string& name, const std::optional<KnownMapping>& known,
                      const Eigen::Matrix3d& solution, const Eigen::Matrix3d& alone,
                      const Eigen::Matrix3d& sigma);
  void compareImu(std::size_t imu);
  // Of several numbers the one that is furthest off is said.
  void judge(const std::string& name, const Unit& unit, const std::vector<Compared>& numbers,
             const std::vector<const char*>& parts);

  const CalibrationInput& input_;
  const OptimisationOptions& options_;
  const CalibrationState &solution_, &alone_;
  const UncertaintyReport& sigmas_;
  PriorCheck check_;
};

void Comparison::judge(const std::string& name, const Unit& unit, const std::vector<Compared>& numbers,
                       const std::vector<const char*>& parts) {
  double worst = options_.contradiction_sigmas;
  bool matters = false;
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Compared& each = numbers[i];
    const double sigmas = std::abs(each.alone - each.known) / std::hypot(each.known_sigma, each.alone_sigma);
    if (!(sigmas > options_.contradiction_sigmas)) continue;
    matters = matters || std::abs(each.pull) > unit.need;
    if (sigmas < worst) continue;
    worst = sigmas;
    const std::string known = each.known_sigma > 0.0
                                  ? fmt::format("the prior says {:.6g} +- {:.2g}", unit.factor * each.known,
                                                unit.factor * each.known_sigma)
                                  : fmt::format("given as {:.6g}", unit.factor * each.known);
    text = fmt::format("{}{}: {}{}, but the recording alone says {:.6g} +- {:.2g}{} ({:.0f} sigmas away)",
                       name, parts[i], known, unit.name, unit.factor * each.alone,
                       unit.factor * each.alone_sigma, unit.name, sigmas);
  }
  if (text.empty()) return;
  check_.notes.push_back(text);
  if (matters && check_.doubt.empty()) check_.doubt = text + "; check the session's prior";
}

void Comparison::compareVector(const std::string& name, const Unit& unit, const KnownVector& known,
                               const Eigen::Vector3d& solution, const Eigen::Vector3d& alone,
                               const Eigen::Vector3d& sigma) {
  const Eigen::Vector3d known_sigma = known.sigma.value_or(Eigen::Vector3d::Zero());
  std::vector<Compared> numbers;
  for (int i = 0; i < 3; ++i)
    numbers.push_back({known.value[i], known_sigma[i], alone[i], sigma[i], alone[i] - solution[i]});
  judge(name, unit, numbers, {" x", " y", " z"});
}

void Comparison::compareOffset(const std::string& sensor, const SensorPrior& prior, double solution_s,
                               double alone_s, double sigma_s) {
  const bool free = options_.free_time_offsets;
  if (!prior.time_offset && free) return;
  const double known_s = prior.time_offset ? prior.time_offset->value : 0.0;
  const double known_sigma_s = prior.time_offset && free ? prior.time_offset->sigma.value_or(0.0) : 0.0;
  judge(sensor + ".time_offset", {" ms", 1e3, 1e-3 * options_.needed_time_offset_ms},
        {{known_s, known_sigma_s, alone_s, sigma_s, alone_s - solution_s}}, {""});
}

// Rotations as vectors from the known one, which is 0.
template <class Sigmas>
void Comparison::comparePlace(const std::string& sensor, const SensorPrior& prior,
                              const RigidTransform& solution, const RigidTransform& alone,
                              const Sigmas& sigma) {
  if (prior.rotation) {
    const Eigen::Quaterniond to_known = prior.rotation->value.conjugate();
    compareVector(
        sensor + ".rotation (from there)", {" deg", kDegPerRad, options_.needed_rotation_deg / kDegPerRad},
        {Eigen::Vector3d::Zero(), prior.rotation->sigma}, quaternionLog(solution.rotation * to_known),
        quaternionLog(alone.rotation * to_known), sigma.rotation_std_rad);
  }
  if (prior.translation)
    compareVector(sensor + ".translation", {" mm", 1e3, 1e-3 * options_.needed_translation_mm},
                  *prior.translation, solution.translation_m, alone.translation_m, sigma.translation_std_m);
}

void Comparison::compareMapping(const std::string& name, const std::optional<KnownMapping>& known,
                                const Eigen::Matrix3d& solution, const Eigen::Matrix3d& alone,
                                const Eigen::Matrix3d& sigma) {
  const bool free = options_.free_imu_intrinsics;
  if (!known && free) return;
  const Eigen::Matrix3d value = known ? known->value : Eigen::Matrix3d::Identity();
  const bool weighed = known && known->sigma && free;
  std::vector<Compared> numbers;
  for (int row = 0; row < 3; ++row)
    for (int col = row; col < 3; ++col)
      numbers.push_back({value(row, col), weighed ? (*known->sigma)(row, col) : 0.0, alone(row, col),
                         sigma(row, col), alone(row, col) - solution(row, col)});
  judge(name, {"", 1.0, kNoNeed}, numbers, {" xx", " xy", " xz", " yy", " yz", " zz"});
}

void Comparison::compareImu(std::size_t imu) {
  const ImuState &solution = solution_.imus[imu], &alone = alone_.imus[imu];
  const ImuUncertainty& sigma = sigmas_.imus[imu];
  const ImuPrior& prior = input_.imus[imu].prior;
  const std::string& name = input_.imus[imu].name;
  if (imu != input_.reference_imu) {
    comparePlace(name, prior, solution.reference_from_imu, alone.reference_from_imu, sigma);
    compareOffset(name, prior, solution.time_offset_s, alone.time_offset_s, sigma.time_offset_std_s);
  }
  if (prior.gyroscope_bias)
    compareVector(name + ".gyroscope_bias", {" rad/s", 1.0, kNoNeed}, *prior.gyroscope_bias,
                  solution.gyroscope_bias_rad_s, alone.gyroscope_bias_rad_s, sigma.gyroscope_bias_std_rad_s);
  if (prior.accelerometer_bias)
    compareVector(name + ".accelerometer_bias", {" m/s^2", 1.0, kNoNeed}, *prior.accelerometer_bias,
                  solution.accelerometer_bias_m_s2, alone.accelerometer_bias_m_s2,
                  sigma.accelerometer_bias_std_m_s2);
  compareMapping(name + ".gyroscope_mapping", prior.gyroscope_mapping, solution.gyroscope_mapping,
                 alone.gyroscope_mapping, sigma.gyroscope_mapping_std);
  compareMapping(name + ".accelerometer_mapping", prior.accelerometer_mapping, solution.accelerometer_mapping,
                 alone.accelerometer_mapping, sigma.accelerometer_mapping_std);
}

PriorCheck Comparison::run() {
  for (std::size_t i = 0; i < input_.cameras.size(); ++i) {
    if (input_.isReferenceCamera(i)) continue;
    const CameraData& camera = input_.cameras[i];
    const CameraState &solution = solution_.cameras[i], &alone = alone_.cameras[i];
    comparePlace(camera.name, camera.prior, solution.reference_from_camera, alone.reference_from_camera,
                 sigmas_.cameras[i]);
    compareOffset(camera.name, camera.prior, solution.time_offset_s, alone.time_offset_s,
                  sigmas_.cameras[i].time_offset_std_s);
  }
  for (std::size_t i = 0; i < input_.imus.size(); ++i) compareImu(i);
  return std::move(check_);
}

CalibrationInput withoutPriors(CalibrationInput input) {
  for (CameraData& camera : input.cameras) camera.prior = {};
  for (ImuData& imu : input.imus) imu.prior = {};
  return input;
}

bool hasPrior(const CalibrationInput& input) {
  for (const CameraData& camera : input.cameras)
    if (camera.prior != SensorPrior{}) return true;
  for (const ImuData& imu : input.imus)
    if (imu.prior != ImuPrior{}) return true;
  return false;
}

}  // namespace

PriorCheck checkPriors(const CalibrationInput& input, const BatchSolution& solution,
                       const OptimisationOptions& options, const RunContext& context) {
  const std::vector<std::string> given = givenQuantities(input, options);
  if (given.empty() && !hasPrior(input)) return {};
  PriorCheck check;
  OptimisationOptions free = options;
  free.free_time_offsets = free.free_imu_intrinsics = true;
  const RunContext quiet{silentProgress(), context.stop};
  try {
    const CalibrationInput without = withoutPriors(input);
    const BatchSolution alone = refineBatch(without, solution.state, free, quiet);
    const UncertaintyReport sigmas = estimateUncertainty(without, alone, free, quiet).report;
    check = Comparison(input, options, solution.state, alone.state, sigmas).run();
  } catch (const CalibrationError& error) {
    check.notes.push_back(std::string("the priors could not be held against the recording: ") + error.what());
  }
  if (!given.empty()) check.notes.insert(check.notes.begin(), "given, not estimated: " + joined(given));
  return check;
}

}  // namespace evical
