#include "core/optimisation/uncertainty/prior_check.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/base/progress.h"
#include "core/data/quantity.h"
#include "core/numerics/angles.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/known_values.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/optimisation/uncertainty/observability.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace evical {
namespace {

constexpr double kNoNeed = std::numeric_limits<double>::infinity();

struct Unit {
  std::string name;
  double factor;  // from SI
  double need;    // SI
};

// One number, in SI units.
struct Compared {
  double known, known_sigma;  // sigma 0: given
  double alone, alone_sigma;  // estimate from the recording alone
  double pull;                // alone minus the solution
};

class Comparison {
 public:
  Comparison(const CalibrationInput& input, const OptimisationOptions& options,
             const CalibrationState& solution, const CalibrationState& alone, const UncertaintyReport& sigmas)
      : input_(input), options_(options), solution_(solution), alone_(alone), sigmas_(sigmas) {}

  PriorCheck run();

 private:
  template <class Row, class State, class Sigma, class Prior>
  void compareRow(const std::string& sensor, const Row& row, const Prior& prior, const State& solution,
                  const State& alone, const Sigma& sigma);
  void compareLens(std::size_t camera);
  // Reports the number with the largest deviation.
  void judge(const std::string& name, const Unit& unit, const std::vector<Compared>& numbers,
             const std::vector<std::string>& parts);

  const CalibrationInput& input_;
  const OptimisationOptions& options_;
  const CalibrationState &solution_, &alone_;
  const UncertaintyReport& sigmas_;
  PriorCheck check_;
};

void Comparison::judge(const std::string& name, const Unit& unit, const std::vector<Compared>& numbers,
                       const std::vector<std::string>& parts) {
  double worst = options_.contradiction_sigmas;
  bool matters = false;
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Compared& each = numbers[i];
    const double sigmas = std::abs(each.alone - each.known) / std::hypot(each.known_sigma, each.alone_sigma);
    if (!(sigmas > options_.contradiction_sigmas)) continue;
    matters = matters || std::abs(each.pull) > unit.need ||
              (each.known_sigma > 0.0 && sigmas > options_.doubtful_contradiction_sigmas);
    if (sigmas < worst) continue;
    worst = sigmas;
    const std::string known = each.known_sigma > 0.0
                                  ? fmt::format("the prior is {:.6g} +- {:.2g}", unit.factor * each.known,
                                                unit.factor * each.known_sigma)
                                  : fmt::format("given as {:.6g}", unit.factor * each.known);
    text = fmt::format("{}{}: {}{}, but the recording alone gives {:.6g} +- {:.2g}{} ({:.0f} sigmas apart)",
                       name, parts[i], known, unit.name, unit.factor * each.alone,
                       unit.factor * each.alone_sigma, unit.name, sigmas);
  }
  if (text.empty()) return;
  check_.notes.push_back(text);
  if (matters && check_.doubt.empty()) check_.doubt = text + "; check the session's prior";
}

// Numbers to compare: rotations as vectors from the known one, which is 0.
template <class Value>
Eigen::VectorXd fromKnown(const QuantityInfo&, const Value& value, const Value&) {
  return quantityNumbers(value);
}
Eigen::VectorXd fromKnown(const QuantityInfo& info, const Eigen::Quaterniond& value,
                          const Eigen::Quaterniond& known) {
  return quantityDifference(info, value, known);
}
bool isRotation(const QuantityInfo& info) {
  return info.shape == QuantityShape::Rotation || info.shape == QuantityShape::LocalRotation;
}

// " x" of "rotation.x"
std::vector<std::string> partWords(const QuantityInfo& info) {
  std::vector<std::string> words;
  for (const QuantityPart& part : quantityParts(info)) {
    const std::string own = info.name;
    words.push_back(part.name == own ? "" : fmt::format(" {}", part.name.substr(own.size() + 1)));
  }
  return words;
}

template <class Row, class State, class Sigma, class Prior>
void Comparison::compareRow(const std::string& sensor, const Row& row, const Prior& prior,
                            const State& solution, const State& alone, const Sigma& sigma) {
  const QuantityInfo& info = row.info;
  const auto known = effectivePrior(info, options_, row.prior(prior));
  if (!known) return;
  const Eigen::VectorXd value = fromKnown(info, known->value, known->value);
  const Eigen::VectorXd value_sigma =
      known->sigma ? quantityNumbers(*known->sigma) : Eigen::VectorXd::Zero(value.size());
  const Eigen::VectorXd found = fromKnown(info, row.value(solution), known->value);
  const Eigen::VectorXd found_alone = fromKnown(info, row.value(alone), known->value);
  const Eigen::VectorXd alone_sigma = quantityNumbers(row.sigma(sigma));
  std::vector<Compared> numbers;
  for (Eigen::Index i = 0; i < value.size(); ++i)
    numbers.push_back({value[i], value_sigma[i], found_alone[i], alone_sigma[i], found_alone[i] - found[i]});
  const std::string shown_unit = info.shown_unit;
  judge(sensor + "." + info.name + (isRotation(info) ? " (relative to the prior)" : ""),
        {shown_unit.empty() ? "" : fmt::format(" {}", shown_unit), info.shown_factor,
         info.need == QuantityNeed::None ? kNoNeed : neededSigma(info.need, options_)},
        numbers, partWords(info));
}

// Comparison of a lens that was given with sigmas.
void Comparison::compareLens(std::size_t camera) {
  const CameraLens& lens = input_.cameras[camera].lens;
  const auto &solved = solution_.cameras[camera].lens.solved, &alone = alone_.cameras[camera].lens.solved;
  if (!lens.given_with || !solved || !alone) return;
  const QuantityInfo& info = quantityInfo(QuantityOwner::Camera, QuantityId::Intrinsics);
  const Eigen::VectorXd known = quantityNumbers(lens.given), found = quantityNumbers(solved),
                        found_alone = quantityNumbers(alone),
                        alone_sigma = quantityNumbers(sigmas_.cameras[camera].intrinsics_std);
  const IntrinsicsVector known_sigma = lens.given_with->covariance().diagonal().cwiseSqrt();
  const std::vector<QuantityPart> parts = quantityParts(info, lens.given);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    if (known_sigma[i] <= 0.0) continue;
    judge(input_.cameras[camera].name + "." + parts[k].name,
          {parts[k].shown_unit.empty() ? "" : " " + parts[k].shown_unit, 1.0, kNoNeed},
          {{known[i], known_sigma[i], found_alone[i], alone_sigma[i], found_alone[i] - found[i]}}, {""});
  }
}

PriorCheck Comparison::run() {
  for (std::size_t i = 0; i < input_.cameras.size(); ++i) compareLens(i);
  forEachSensorKind([&](auto kind) {
    for (std::size_t i = 0; i < kind.of(input_).size(); ++i)
      forEachPriorQuantity(kind.rows(), [&](const auto& row) {
        if (row.info.relative && kind.isReference(input_, i)) return;
        compareRow(kind.of(input_)[i].name, row, kind.of(input_)[i].prior, kind.of(solution_)[i],
                   kind.of(alone_)[i], kind.of(sigmas_)[i]);
      });
  });
  return std::move(check_);
}

CalibrationInput withoutPriors(CalibrationInput input) {
  for (CameraData& camera : input.cameras) {
    camera.prior = {};
    camera.lens.given_with.reset();
  }
  for (ImuData& imu : input.imus) imu.prior = {};
  return input;
}

// Frees the drift if it has a prior to compare.
void freeDrift(const SensorPrior& prior, OptimisationOptions& options) {
  options.time_offset_drift = options.time_offset_drift || prior.time_offset_drift.has_value();
}

bool hasPrior(const CalibrationInput& input) {
  for (const CameraData& camera : input.cameras)
    if (camera.prior != SensorPrior{} || camera.lens.given_with) return true;
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
  for (const CameraData& camera : input.cameras) freeDrift(camera.prior, free);
  for (const ImuData& imu : input.imus) {
    freeDrift(imu.prior, free);
    if (imu.prior.gyroscope_rotation) free.gyroscope_rotation = Estimated::Yes;
  }
  const RunContext quiet{silentProgress(), context.stop};
  try {
    const CalibrationInput without = withoutPriors(input);
    const BatchSolution alone = refineBatch(without, solution.state, free, quiet);
    const UncertaintyReport sigmas = estimateSigmas(without, alone, free, quiet);
    check = Comparison(input, options, solution.state, alone.state, sigmas).run();
  } catch (const CalibrationError& error) {
    check.notes.push_back(std::string("the priors could not be compared with the recording: ") +
                          error.what());
  }
  if (!given.empty()) check.notes.insert(check.notes.begin(), "given, not estimated: " + joined(given));
  return check;
}

}  // namespace evical
