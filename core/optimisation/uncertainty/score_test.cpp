#include "core/optimisation/uncertainty/score_test.h"

#include "core/data/board_bow.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/projection_difference.h"
#include "core/numerics/angles.h"
#include "core/numerics/dense.h"
#include "core/optimisation/uncertainty/schur_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

// Free only for the test, without a prior with a sigma or an option that releases it.
bool isHeld(const Quantity& quantity, const CalibrationInput& input, const OptimisationOptions& options) {
  if (quantity.info->id == QuantityId::Intrinsics) return !options.freesIntrinsics();
  if (quantity.info->release == QuantityRelease::BoardBow) return !options.board_bow;
  if (quantity.info->id == QuantityId::LineDelay)
    return !options.estimatesLineDelays() && input.cameras[quantity.sensor].shutter != Shutter::Rolling;
  if (quantity.info->id != QuantityId::GyroscopeRotation || options.estimatesGyroscopeRotations())
    return false;
  const auto& prior = input.imus[quantity.sensor].prior.gyroscope_rotation;
  return !(prior && prior->sigma);
}

// Step of one quantity, and its significance along the most certain axis.
struct Step {
  Eigen::VectorXd change;
  double sigmas = 0.0;
};

class Steps {
 public:
  // Sigmas assume uncorrelated residuals. A wrong fixed value correlates them, and sigmas that include the
  // correlation would hide it.
  Steps(const ProjectedInformation& information, const ProjectedInformation& credible)
      : information_(information),
        inverse_(information.total),
        step_(-inverse_.times(information.gradient)),
        covariance_(credible.total) {}

  Step of(std::size_t quantity) const {
    constexpr double kMinSigma = 1e-12;
    const Eigen::Index first = information_.first_column[quantity],
                       size = information_.first_column[quantity + 1] - first;
    Step step{step_.segment(first, size)};
    for (Eigen::Index k = 0; k < size; ++k)
      step.sigmas =
          std::max(step.sigmas, std::abs(step.change[k]) / std::max(covariance_.sigma(first + k), kMinSigma));
    return step;
  }

  // After all steps, the variance of this quantity's scores over stretches, relative to that of noise.
  double leftOf(std::size_t quantity) const {
    const Eigen::Index first = information_.first_column[quantity],
                       size = information_.first_column[quantity + 1] - first;
    Eigen::MatrixXd weights(step_.size(), size);  // of the scores in this estimate
    for (Eigen::Index k = 0; k < size; ++k)
      weights.col(k) = inverse_.times(Eigen::VectorXd(Eigen::VectorXd::Unit(step_.size(), first + k)));
    std::vector<Eigen::VectorXd> left;
    for (std::size_t k = 0; k < information_.scores.size(); ++k)
      left.emplace_back(weights.transpose() *
                        (information_.scores[k] + information_.information_by_stretch[k] * step_));
    return scatterRatio(scoreScatter(left, size), weights.middleRows(first, size));
  }

 private:
  const ProjectedInformation& information_;
  ScaledInverse inverse_;
  Eigen::VectorXd step_;
  ScaledInverse covariance_;
};

void add(std::string& doubts, const std::string& doubt) {
  doubts += (doubts.empty() ? "" : "; ") + doubt;
}

// If a misalignment is real, estimating it removes all errors that it causes. Intermittent errors look like
// one, but most of them remain.
void testGyroscope(const std::string& imu, const Steps& steps, std::size_t quantity,
                   const OptimisationOptions& options, HeldDoubts& doubts) {
  const Step step = steps.of(quantity);
  const double turn_deg = kDegPerRad * step.change.norm();
  if (turn_deg < options.needed_rotation_deg || step.sigmas < options.turned_gyroscope_sigmas) return;
  const double sigmas = step.sigmas / std::sqrt(std::max(1.0, steps.leftOf(quantity)));
  if (sigmas < options.turned_gyroscope_sigmas)
    return add(
        doubts.wandering_imus,
        fmt::format(
            "{}: sample errors that last for tenths of a second exceed the given noise density, and a "
            "misaligned gyroscope does not explain them: check its noise density, filters and vibrations",
            imu));
  doubts.gyroscope_sigmas = std::max(doubts.gyroscope_sigmas, sigmas);
  add(doubts.gyroscopes,
      fmt::format("{}: the gyroscope seems misaligned with the accelerometer by about {:.2g} deg ({:.0f} "
                  "sigmas){}",
                  imu, turn_deg, sigmas,
                  options.gyroscope_rotation == Estimated::Auto
                      ? ""  // it is estimated next
                      : ", and other rotations may have errors of the same size; calibrate with "
                        "optimisation.model.gyroscope_rotation: true"));
}

void testLens(const std::string& camera, const CameraIntrinsics& held, const Step& step,
              const OptimisationOptions& options, std::string& doubts) {
  if (step.sigmas < options.wrong_lens_sigmas) return;
  std::array<double, 9> numbers{};
  writeIntrinsics(held, numbers.data());
  for (Eigen::Index k = 0; k < step.change.size(); ++k)  // unused ones come last
    numbers[static_cast<std::size_t>(k)] += step.change[k];
  const CameraIntrinsics freed = intrinsicsFrom(numbers.data(), held.model, held.resolution_px);
  const Eigen::Array2d focal = idealFocalLength_px(freed).array() / idealFocalLength_px(held).array() - 1.0;
  const Eigen::Vector2d centre_px = freed.principal_point_px - held.principal_point_px;
  const double moved_px = std::max(projectionDifference(held, freed).rms_px, centre_px.norm());
  if (moved_px < options.wrong_lens_px) return;
  constexpr double kPercent = 100.0;
  add(doubts,
      fmt::format("{}: the lens differs from the session's: focal lengths by {:+.2f} and {:+.2f} %, the "
                  "principal point by ({:+.1f}, {:+.1f}) px ({:.0f} sigmas); calibrate with "
                  "optimisation.model.camera_intrinsics: free",
                  camera, kPercent * focal.x(), kPercent * focal.y(), centre_px.x(), centre_px.y(),
                  step.sigmas));
}

void testShutter(const CameraData& camera, const Step& step, const OptimisationOptions& options,
                 std::string& doubts) {
  const double readout_ms =
      1e-3 * std::abs(step.change[0]) * camera.lens.detection_intrinsics->resolution_px.height_px;
  if (step.sigmas < options.rolling_shutter_sigmas || readout_ms < options.rolling_shutter_ms) return;
  add(doubts,
      fmt::format("{}: the shutter is rolling: each row is exposed {:.2g} us {} the row above ({:.0f} "
                  "sigmas){}",
                  camera.name, std::abs(step.change[0]), step.change[0] > 0.0 ? "after" : "before",
                  step.sigmas,
                  options.line_delay == Estimated::Auto ? "" : "; set shutter: rolling for this camera"));
}

// Test of the significant curvatures; the text names the largest one.
class BoardTest {
 public:
  void add(const QuantityInfo& info, const Step& step, const OptimisationOptions& options) {
    if (step.sigmas < options.bent_board_sigmas) return;
    sigmas_ = std::max(sigmas_, step.sigmas);
    forEachSheetQuantity([&](const auto& row) {
      if (row.info.id == info.id) row.value(bent_) = step.change[0];
    });
  }
  std::string doubt(const Board& board, const std::string& called, const OptimisationOptions& options) const {
    if (largestBow_mm(bent_, board) < options.bent_board_mm) return {};
    return fmt::format(
        "{} ({:.0f} sigmas): mount it on glass, or calibrate with optimisation.model.board_bow: true",
        bowWords(bent_, board, called), sigmas_);
  }

 private:
  BoardState bent_;
  double sigmas_ = 0.0;
};

}  // namespace

OptimisationOptions freeToBeTested(OptimisationOptions options) {
  options.gyroscope_rotation = options.line_delay = Estimated::Yes;
  options.board_bow = true;
  options.share_sensors = false;
  options.camera_intrinsics = CameraIntrinsicsChoice::Free;
  return options;
}

HeldDoubts testHeldValues(const CalibrationInput& input, const CalibrationState& state,
                          const ProjectedInformation& information, const OptimisationOptions& options) {
  HeldDoubts doubts;
  std::vector<std::size_t> held;
  for (std::size_t i = 0; i < information.quantities.size(); ++i)
    if (isHeld(information.quantities[i], input, options)) held.push_back(i);
  if (held.empty()) return doubts;
  const Steps steps(information, withoutNoise(information));
  std::vector<BoardTest> boards(input.boardCount());
  for (const std::size_t i : held) {
    const Quantity& quantity = information.quantities[i];
    if (quantity.info->owner == QuantityOwner::Board)
      boards[quantity.sensor].add(*quantity.info, steps.of(i), options);
    else if (quantity.info->id == QuantityId::LineDelay)
      testShutter(input.cameras[quantity.sensor], steps.of(i), options, doubts.shutters);
    else if (quantity.info->owner == QuantityOwner::Camera)
      testLens(input.cameras[quantity.sensor].name, *state.cameras[quantity.sensor].lens.inUse(), steps.of(i),
               options, doubts.lenses);
    else
      testGyroscope(input.imus[quantity.sensor].name, steps, i, options, doubts);
  }
  for (std::size_t i = 0; i < boards.size() && doubts.board.empty(); ++i)
    doubts.board = boards[i].doubt(input.boardAt(i), input.boardWords(i), options);
  return doubts;
}

ProjectedInformation withoutHeldValues(const CalibrationInput& input, const OptimisationOptions& options,
                                       ProjectedInformation information) {
  KeptColumns kept(information);
  for (std::size_t i = 0; i < information.quantities.size(); ++i)
    if (!isHeld(information.quantities[i], input, options)) kept.keep(i);
  return withColumns(kept, std::move(information));
}

}  // namespace evical
