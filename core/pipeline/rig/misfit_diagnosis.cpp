#include "core/pipeline/rig/misfit_diagnosis.h"

#include "core/base/error.h"
#include "core/base/in_parallel.h"
#include "core/data/board_bow.h"
#include "core/geometry/camera_model.h"
#include "core/numerics/angles.h"
#include "core/pipeline/rig/residual_consistency.h"
#include "core/pipeline/rig/wrong_inputs.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace evical {

const Repair kFreeLenses{"optimisation.model.camera_intrinsics", "free"};
const Repair kFreeTurn{"optimisation.model.gyroscope_rotation", "true"};
const Repair kFreeBow{"optimisation.model.board_bow", "true"};
const Repair kFreeDelay{"optimisation.priors.accelerometer_delay_sigma_s", "0.1"};
const Repair kFreeLineDelays{"optimisation.model.line_delay", "true"};

namespace {

struct Trial {
  CauseKind kind;
  bool (*isHeld)(const BatchSolution& solution, const OptimisationOptions& options);
  void (*release)(OptimisationOptions& options);
  std::string (*words)(const CalibrationInput& input, const BatchSolution& freed);
  const char* advice;
  const Repair& repair;
};

bool turnIsHeld(const BatchSolution& solution, const OptimisationOptions& options) {
  return !solution.state.imus.empty() && !options.estimatesGyroscopeRotations();
}
void releaseTurn(OptimisationOptions& options) {
  options.gyroscope_rotation = Estimated::Yes;
}
std::string turnWords(const CalibrationInput& input, const BatchSolution& freed) {
  std::size_t most = 0;
  const auto turn_deg = [&](std::size_t k) {
    return kDegPerRad * Eigen::AngleAxisd(freed.state.imus[k].gyroscope_from_accelerometer).angle();
  };
  for (std::size_t k = 1; k < input.imus.size(); ++k)
    if (turn_deg(k) > turn_deg(most)) most = k;
  return fmt::format("{}: the gyroscope seems misaligned with the accelerometer by about {:.2g} deg",
                     input.imus[most].name, turn_deg(most));
}

bool aLensIsHeld(const BatchSolution& solution, const OptimisationOptions&) {
  return std::any_of(solution.state.cameras.begin(), solution.state.cameras.end(),
                     [](const CameraState& camera) { return !camera.lens.solved; });
}
void releaseLenses(OptimisationOptions& options) {
  options.camera_intrinsics = CameraIntrinsicsChoice::Free;
}
// A stretched or bent board has almost the same effect as a wrong lens.
std::string lensWords(const CalibrationInput& input, const BatchSolution& freed) {
  std::string text;
  for (std::size_t k = 0; k < input.cameras.size(); ++k) {
    const std::optional<CameraIntrinsics>& solved = freed.state.cameras[k].lens.solved;
    if (!solved) continue;
    const CameraIntrinsics& given = *input.cameras[k].lens.detection_intrinsics;
    const Eigen::Array2d focal =
        idealFocalLength_px(*solved).array() / idealFocalLength_px(given).array() - 1.0;
    const Eigen::Vector2d centre_px = solved->principal_point_px - given.principal_point_px;
    text += fmt::format(
        "{}{}: the lens or the board's shape differs from the session's: focal lengths by {:+.2f} and "
        "{:+.2f} %, the principal point by ({:+.1f}, {:+.1f}) px",
        text.empty() ? "" : ", ", input.cameras[k].name, 100.0 * focal.x(), 100.0 * focal.y(), centre_px.x(),
        centre_px.y());
  }
  return text;
}

bool flatnessIsHeld(const BatchSolution&, const OptimisationOptions& options) {
  return !options.board_bow;
}
void releaseBow(OptimisationOptions& options) {
  options.board_bow = true;
}
std::string bentBoardWords(const CalibrationInput& input, const BatchSolution& freed) {
  std::size_t most = 0;
  const auto bow_mm = [&](std::size_t i) { return largestBow_mm(freed.state.boardAt(i), input.boardAt(i)); };
  for (std::size_t i = 1; i < input.boardCount(); ++i)
    if (bow_mm(i) > bow_mm(most)) most = i;
  return bowWords(freed.state.boardAt(most), input.boardAt(most), input.boardWords(most));
}

constexpr double kLongestDelay_s = 0.1;  // kFreeDelay

bool delayIsHeld(const BatchSolution& solution, const OptimisationOptions& options) {
  return !solution.state.imus.empty() && options.free_imu_intrinsics &&
         options.accelerometer_delay_sigma_s < kLongestDelay_s;
}
void releaseDelay(OptimisationOptions& options) {
  options.accelerometer_delay_sigma_s = kLongestDelay_s;
}
std::string delayWords(const CalibrationInput& input, const BatchSolution& freed) {
  const auto latest = std::ranges::max_element(
      freed.state.imus, {}, [](const ImuState& imu) { return std::abs(imu.accelerometer_delay_s); });
  const double delay_ms = 1e3 * latest->accelerometer_delay_s;
  return fmt::format("{}: the accelerometer's samples seem to be {:.2g} ms {} than the gyroscope's",
                     input.imus[static_cast<std::size_t>(latest - freed.state.imus.begin())].name,
                     std::abs(delay_ms), delay_ms > 0.0 ? "later" : "earlier");
}

const std::array<Trial, 4> kTrials = {
    {{CauseKind::LateAccelerometer, &delayIsHeld, &releaseDelay, &delayWords,
      "check how the driver stamps and filters them, or calibrate with "
      "optimisation.priors.accelerometer_delay_sigma_s: 0.1",
      kFreeDelay},
     {CauseKind::BentBoard, &flatnessIsHeld, &releaseBow, &bentBoardWords,
      "mount it on glass, or calibrate with optimisation.model.board_bow: true", kFreeBow},
     {CauseKind::Lens, &aLensIsHeld, &releaseLenses, &lensWords,
      "calibrate with optimisation.model.camera_intrinsics: free, and measure the board", kFreeLenses},
     {CauseKind::GyroscopeTurned, &turnIsHeld, &releaseTurn, &turnWords,
      "other rotations may have errors of the same size: calibrate with "
      "optimisation.model.gyroscope_rotation: true",
      kFreeTurn}}};

// The reasons that a wrong input explains: all later ones that are symptoms of any, or only of weak data.
enum class Explains { Itself, WeakData, Symptoms };
enum class Reason { Independent, Symptom, WeakData };
struct RankedReason {
  std::string_view name;
  Explains explains = Explains::Itself;
  Reason is = Reason::Symptom;
};
// In the order in which they are reported. Unlisted ones come between causes and symptoms.
constexpr std::array kRanks = {RankedReason{"mirrored_image", Explains::Itself, Reason::Independent},
                               RankedReason{kWrongUnit, Explains::Symptoms, Reason::Independent},
                               RankedReason{kWrongClock, Explains::Symptoms, Reason::Independent},
                               RankedReason{"heavy_saturation", Explains::Symptoms, Reason::Independent},
                               RankedReason{kWrongLens, Explains::Symptoms},
                               RankedReason{kWrongBoard, Explains::Symptoms},
                               RankedReason{"first_look_at_lens"},
                               RankedReason{"saturation", Explains::Itself, Reason::Independent},
                               RankedReason{"stamp_jitter", Explains::Itself, Reason::Independent},
                               RankedReason{kWrongNoise, Explains::WeakData},
                               RankedReason{"clock_step", Explains::Itself, Reason::Independent},
                               RankedReason{"other"},
                               RankedReason{"late_accelerometer", Explains::Symptoms},
                               RankedReason{"gyroscope_turned"},
                               RankedReason{"lens"},
                               RankedReason{"board_bow"},
                               RankedReason{"misfit"},
                               RankedReason{"wandering_imu"},
                               RankedReason{"board_stretch"},
                               RankedReason{"board_scale", Explains::WeakData},
                               RankedReason{"board_size"},
                               RankedReason{"prior"},
                               RankedReason{"rolling_shutter"},
                               RankedReason{"another_sensor"},
                               RankedReason{"not_converged"},
                               RankedReason{"halves", Explains::Itself, Reason::WeakData},
                               RankedReason{"observability", Explains::Itself, Reason::WeakData}};

std::size_t rankOf(const QualityWarning& reason) {
  const auto row = std::ranges::find(kRanks, std::string_view(reason.name), &RankedReason::name);
  const auto other = std::ranges::find(kRanks, std::string_view("other"), &RankedReason::name);
  return static_cast<std::size_t>((row == kRanks.end() ? other : row) - kRanks.begin());
}

}  // namespace

void rankReasons(CalibrationResult& result) {
  if (result.causes.empty()) return;
  std::ranges::stable_sort(result.causes, {}, rankOf);
  std::vector<QualityWarning> kept;
  Explains explained = Explains::Itself;
  for (QualityWarning& cause : result.causes) {
    const RankedReason& row = kRanks.at(rankOf(cause));
    const bool follows = (explained == Explains::Symptoms && row.is != Reason::Independent) ||
                         (explained == Explains::WeakData && row.is == Reason::WeakData);
    if (follows && cause.name != kept.back().name) continue;
    explained = std::max(explained, cause.explains >= 1.0 ? Explains::Symptoms : row.explains);
    kept.push_back(std::move(cause));
  }
  result.causes = std::move(kept);
  result.reason.clear();
  for (const QualityWarning& cause : result.causes)
    result.reason += (result.reason.empty() ? "" : "; ") + cause.text;
  result.repair = result.causes.front().repair;
}

const char* causeName(CauseKind kind) {
  constexpr std::array kNames = {"gyroscope_turned", "lens", "board_bow",
                                 "late_accelerometer"};  // in the enumeration's order
  return kNames.at(static_cast<std::size_t>(kind));
}

std::optional<Cause> findCause(const CalibrationInput& input, const BatchSolution& solution,
                               const OptimisationOptions& options, const RunContext& context) {
  constexpr double kExplains = 0.7;         // largest share of the misfit's logarithm that may remain
  constexpr double kWorthExplaining = 0.2;  // residuals 1.2 times the expected ones
  const double before = totalMisfit(solution);
  if (before < kWorthExplaining) return std::nullopt;
  // Side by side, since little of a solution is parallel; long recordings one after the other, for less
  // memory.
  constexpr std::size_t kMany = 100'000;
  const int at_once = solution.circle_errors.size() < kMany ? options.threads : 1;
  std::array<std::optional<BatchSolution>, kTrials.size()> refits;
  const RunContext quiet{silentProgress(), context.stop};
  inParallel(at_once, kTrials.size(), [&](std::size_t k) {
    if (!kTrials[k].isHeld(solution, options)) return;
    OptimisationOptions freed = options;
    kTrials[k].release(freed);
    freed.threads = options.threads / at_once;
    try {
      refits[k] = tryBatch(input, solution.state, freed, quiet);
    } catch (const CalibrationError&) {
      return;  // a trial without a solution explains nothing
    }
  });
  double least = kExplains * before;
  std::optional<Cause> best;
  for (std::size_t k = 0; k < kTrials.size(); ++k) {
    const Trial& trial = kTrials[k];
    const double after = refits[k] ? totalMisfit(*refits[k]) : least;
    if (after >= least) continue;
    least = after;
    const bool is_next =
        trial.kind == CauseKind::GyroscopeTurned && options.gyroscope_rotation == Estimated::Auto;
    best = Cause{
        trial.kind,
        fmt::format("{} (freeing this reduces residuals from {:.2g} to {:.2g} times the expected size){}",
                    trial.words(input, *refits[k]), std::exp(before), std::exp(after),
                    is_next ? "" : fmt::format("; {}", trial.advice)),
        trial.repair, 1.0 - after / before};
  }
  return best;
}

}  // namespace evical
