#include "core/optimisation/uncertainty/change_test.h"

#include "core/numerics/angles.h"
#include "core/numerics/dense.h"
#include "core/optimisation/uncertainty/score_test.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace evical {
namespace {

// Numbers of one sensor that change together.
struct Candidate {
  ChangeKind kind;
  QuantityOwner owner;
  std::size_t sensor;
  std::vector<Eigen::Index> columns;
  std::vector<double> largest;  // of each number: bounds directions without information
};

std::optional<ChangeKind> kindOf(const QuantityInfo& info) {
  if (info.owner == QuantityOwner::Board) return std::nullopt;
  if (info.id == QuantityId::TimeOffset) return ChangeKind::Clock;
  if (info.id == QuantityId::Rotation || info.id == QuantityId::Translation) return ChangeKind::Pose;
  const bool bias = info.id == QuantityId::GyroscopeBias || info.id == QuantityId::AccelerometerBias;
  return bias ? std::optional(ChangeKind::Biases) : std::nullopt;
}

std::vector<Candidate> candidatesOf(const ProjectedInformation& information) {
  constexpr double kLargest = 1000.0;  // comparable units: 57 deg, 1 m, 0.1 s
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < information.quantities.size(); ++i) {
    const Quantity& quantity = information.quantities[i];
    const std::optional<ChangeKind> kind = kindOf(*quantity.info);
    if (!kind) continue;
    auto found = std::find_if(all.begin(), all.end(), [&](const Candidate& each) {
      return each.kind == *kind && each.owner == quantity.info->owner && each.sensor == quantity.sensor;
    });
    if (found == all.end())
      found = all.insert(all.end(), {*kind, quantity.info->owner, quantity.sensor, {}, {}});
    for (Eigen::Index k = information.first_column[i]; k < information.first_column[i + 1]; ++k) {
      found->columns.push_back(k);
      found->largest.push_back(kLargest * quantity.info->comparable_unit);
    }
  }
  return all;
}

class ChangeTest {
 public:
  explicit ChangeTest(const ProjectedInformation& information)
      : information_(information),
        inverse_(information.total),
        gradient_(Eigen::VectorXd::Zero(information.total.rows())) {
    for (const Eigen::VectorXd& score : information.scores) gradient_ += score;
  }

  // The most certain change; nullopt in recordings too short for two parts.
  std::optional<SensorChange> best(const Candidate& candidate) const {
    std::optional<SensorChange> best;
    for (const Step& step : likelySteps(candidate)) {
      const double sigmas = sigmasOf(step, scoresLeft(candidate, step));
      if (best && sigmas <= best->sigmas) continue;
      const double at_s =
          information_.first_stretch_s + static_cast<double>(step.from) * information_.stretch_s;
      best = {candidate.kind, candidate.owner, candidate.sensor, at_s, step.change, sigmas};
    }
    return best;
  }

 private:
  // Sums over all stretches from one on.
  struct Part {
    std::size_t from;
    Eigen::VectorXd score;
    Eigen::MatrixXd information;
  };
  struct Step {
    std::size_t from;
    Eigen::VectorXd change;
    Eigen::MatrixXd others;  // reduction by the other unknowns, which are free
    Eigen::MatrixXd information;

    double explains = 0.0;  // chi-square, with the given sigmas
  };

  // For each stretch, the number of earlier ones with information on these numbers. Others have a little,
  // too, through the trajectory.
  std::vector<std::size_t> tellingBefore(const Candidate& candidate) const {
    constexpr double kMinShare = 0.05;  // of the mean
    const Eigen::Index first = candidate.columns.front();
    double sum = 0.0;
    for (const Eigen::MatrixXd& share : information_.information_by_stretch) sum += share(first, first);
    const double least = kMinShare * sum / static_cast<double>(information_.information_by_stretch.size());
    std::vector<std::size_t> before = {0};
    for (const Eigen::MatrixXd& share : information_.information_by_stretch)
      before.push_back(before.back() + (share(first, first) > least ? 1 : 0));
    return before;
  }

  // Moments at which a step explains most. Either part needs its share of the sensor's measurements: one view
  // before a gap is not enough.
  std::vector<Step> likelySteps(const Candidate& candidate) const {
    constexpr double kMinPart_s = 1.5;  // shorter parts have little information
    constexpr std::size_t kTried = 30;
    const std::size_t count = information_.scores.size();
    std::vector<Step> steps;
    if (count == 0) return steps;
    const auto least = static_cast<std::size_t>(std::ceil(kMinPart_s / information_.stretch_s));
    const std::vector<std::size_t> telling = tellingBefore(candidate);
    const auto enough = [&](std::size_t stretches) { return stretches * count >= telling.back() * least; };
    Part part{count, Eigen::VectorXd::Zero(gradient_.size()),
              Eigen::MatrixXd::Zero(gradient_.size(), gradient_.size())};
    const auto explainsMore = [](const Step& a, const Step& b) { return a.explains > b.explains; };
    while (part.from > least) {
      --part.from;
      part.score += information_.scores[part.from];
      part.information += information_.information_by_stretch[part.from];
      if (count - part.from < least) continue;
      if (!enough(telling[part.from]) || !enough(telling.back() - telling[part.from])) continue;
      steps.push_back(stepOf(candidate, part));
      std::push_heap(steps.begin(), steps.end(), explainsMore);
      if (steps.size() <= kTried) continue;
      std::pop_heap(steps.begin(), steps.end(), explainsMore);
      steps.pop_back();
    }
    return steps;
  }

  Step stepOf(const Candidate& candidate, const Part& part) const {
    const std::vector<Eigen::Index>& columns = candidate.columns;
    Step step{part.from, {}, inverse_.times(Eigen::MatrixXd(part.information(Eigen::all, columns))), {}, 0.0};
    step.information =
        part.information(columns, columns) - part.information(columns, Eigen::all) * step.others;
    for (std::size_t k = 0; k < columns.size(); ++k)
      step.information.diagonal()[static_cast<Eigen::Index>(k)] +=
          1.0 / (candidate.largest[k] * candidate.largest[k]);
    step.change = -step.information.ldlt().solve(part.score(columns) - step.others.transpose() * gradient_);
    step.explains = step.change.dot(step.information * step.change);
    return step;
  }

  // Scores by stretch after the step.
  std::vector<Eigen::VectorXd> scoresLeft(const Candidate& candidate, const Step& step) const {
    const std::vector<Eigen::Index>& columns = candidate.columns;
    const Eigen::VectorXd moved = -inverse_.times(gradient_) - step.others * step.change;
    std::vector<Eigen::VectorXd> left;
    for (std::size_t k = 0; k < information_.scores.size(); ++k) {
      Eigen::VectorXd here = moved;
      if (k >= step.from) here(columns) += step.change;
      const Eigen::VectorXd score = information_.scores[k] + information_.information_by_stretch[k] * here;
      Eigen::VectorXd of_step = -step.others.transpose() * score;
      if (k >= step.from) of_step += score(columns);
      left.push_back(std::move(of_step));
    }
    return left;
  }

  // By information or by the scatter of the remaining scores, whichever is less certain. If the remaining
  // scores exceed the noise, the step must be significant relative to them, too.
  static double sigmasOf(const Step& step, const std::vector<Eigen::VectorXd>& left) {
    constexpr double kMinScatter = 1e-9;
    const Eigen::MatrixXd scatter = scoreScatter(left, step.change.size());
    const Eigen::VectorXd root = step.information.diagonal().cwiseSqrt();
    Eigen::MatrixXd scaled = root.cwiseInverse().asDiagonal() * scatter * root.cwiseInverse().asDiagonal();
    scaled.diagonal().array() += kMinScatter;
    const Eigen::VectorXd pull = (step.information * step.change).cwiseQuotient(root);
    const double sigmas2 = std::min(step.explains, pull.dot(scaled.ldlt().solve(pull)));
    const auto by_chance = static_cast<double>(step.change.size());
    return std::sqrt(std::max(0.0, sigmas2 - by_chance) /
                     std::max(1.0, scatterRatio(scatter, step.information)));
  }

  const ProjectedInformation& information_;
  ScaledInverse inverse_;
  Eigen::VectorXd gradient_;
};

double rotation_deg(const SensorChange& change) {
  return kDegPerRad * change.change.head<3>().norm();
}
double translation_mm(const SensorChange& change) {
  return change.change.size() > 3 ? 1e3 * change.change.tail<3>().norm() : 0.0;
}
double timeOffset_ms(const SensorChange& change) {
  return 1e3 * change.change[0];
}

bool matters(const SensorChange& change, const OptimisationOptions& options) {
  if (change.sigmas < options.changed_sigmas) return false;
  switch (change.kind) {
    case ChangeKind::Clock:
      return std::abs(timeOffset_ms(change)) > options.needed_time_offset_ms;
    case ChangeKind::Pose:
      return rotation_deg(change) > options.needed_rotation_deg ||
             translation_mm(change) > options.needed_translation_mm;
    case ChangeKind::Biases:
      return !options.hasLinearBiases();
  }
  return false;
}

std::string nameOf(const CalibrationInput& input, const SensorChange& change) {
  return change.owner == QuantityOwner::Camera ? input.cameras[change.sensor].name
                                               : input.imus[change.sensor].name;
}
std::string referenceName(const CalibrationInput& input) {
  return input.imus.empty() ? input.cameras[input.reference_camera].name
                            : input.imus[input.reference_imu].name;
}

std::string wordsOf(const CalibrationInput& input, const SensorChange& change,
                    const OptimisationOptions& options) {
  const std::string name = nameOf(input, change);
  switch (change.kind) {
    case ChangeKind::Clock:
      return fmt::format(
          "{}: its clock seems to step relative to that of {} by {:.2g} ms about {:.1f} s after the start "
          "({:.0f} sigmas): calibrate only the larger part",
          name, referenceName(input), std::abs(timeOffset_ms(change)), change.at_s, change.sigmas);
    case ChangeKind::Pose:
      return fmt::format(
          "{}: it seems to have moved relative to {} about {:.1f} s after the start, by {:.2g} deg and "
          "{:.2g} mm ({:.0f} sigmas): fasten it and record again, or calibrate only the larger part",
          name, referenceName(input), change.at_s, rotation_deg(change), translation_mm(change),
          change.sigmas);
    case ChangeKind::Biases:
      return fmt::format(
          "{}: its biases change within the recording by {:.2g} rad/s and {:.2g} m/s^2 ({:.0f} sigmas){}",
          name, change.change.head<3>().norm(), change.change.tail<3>().norm(), change.sigmas,
          options.bias_model == BiasModel::Auto ? ""
                                                : "; calibrate with optimisation.model.bias_model: linear");
  }
  return {};
}

Repair repairOf(const SensorChange& change, const ProjectedInformation& information) {
  constexpr double kMargin_s = 0.5;  // uncertainty of the moment
  if (change.kind == ChangeKind::Biases) return {"optimisation.model.bias_model", "linear"};
  const double begin_s = std::max(0.0, information.first_stretch_s);
  const double end_s =
      information.first_stretch_s + information.stretch_s * static_cast<double>(information.scores.size());
  const bool late = change.at_s - begin_s > end_s - change.at_s;
  return {"time_range_s", late ? fmt::format("[{:.1f},{:.1f}]", begin_s, change.at_s - kMargin_s)
                               : fmt::format("[{:.1f},{:.1f}]", change.at_s + kMargin_s, end_s)};
}

}  // namespace

std::vector<SensorChange> findChanges(const ProjectedInformation& information) {
  std::vector<SensorChange> changes;
  const ChangeTest test(information);
  for (const Candidate& candidate : candidatesOf(information))
    if (std::optional<SensorChange> change = test.best(candidate)) changes.push_back(std::move(*change));
  return changes;
}

ChangeDoubt doubtOfChanges(const CalibrationInput& input, const ProjectedInformation& information,
                           const OptimisationOptions& options) {
  ChangeDoubt result;
  for (const SensorChange& change : findChanges(information)) {
    if (change.sigmas < result.sigmas || !matters(change, options)) continue;
    result = {QualityWarning{wordsOf(input, change, options), repairOf(change, information), "change"},
              change.sigmas};
  }
  return result;
}

}  // namespace evical
