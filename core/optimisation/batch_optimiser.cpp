#include "core/optimisation/batch_optimiser.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/circle_errors.h"
#include "core/optimisation/levenberg_marquardt.h"
#include "core/optimisation/sample_errors.h"
#include "core/optimisation/trajectory_smoothness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string_view>
#include <utility>

namespace evical {
namespace {

// If time offsets move by more, measurements are so far outside their segment that its
// polynomial does not describe the trajectory there: they are assigned again at once.
constexpr double kFurthestDrift_knots = 0.5;
// Bounds of the noise scales, so that a sensor with another fault neither dominates nor loses all weight.
constexpr double kMinScale = 0.05, kLargestScale = 1000.0;

// Name for people.
std::string wordsOf(const QuantityInfo& info) {
  std::string_view title = info.title;
  if (info.shape == QuantityShape::UpperTriangle) return std::string(title) + " scale and misalignment";
  constexpr std::string_view kAsNumbers = " vector";
  if (title.ends_with(kAsNumbers)) title.remove_suffix(kAsNumbers.size());
  switch (info.owner) {
    case QuantityOwner::Camera:
      return "camera " + std::string(title);
    case QuantityOwner::Imu:
      // The title without the name of one of the two sensors.
      if (title.starts_with("gyroscope") || title.starts_with("accelerometer")) return std::string(title);
      return "IMU " + std::string(title);
    case QuantityOwner::Board:
      return "board " + std::string(title);
    case QuantityOwner::Rig:
      break;
  }
  return std::string(title);
}

// Names of free quantities, in the order of their table: "camera time offset", once for all cameras.
std::vector<std::string> quantityWords(const std::vector<Quantity>& quantities) {
  std::vector<std::string> words;
  for (const Quantity& quantity : quantities) {
    std::string word = wordsOf(*quantity.info);
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(std::move(word));
  }
  return words;
}

// Names of `now` that are not among the earlier ones.
std::vector<std::string> releasedWords(const std::vector<std::string>& now,
                                       const std::vector<std::string>& before) {
  std::vector<std::string> released;
  for (const std::string& word : now)
    if (std::find(before.begin(), before.end(), word) == before.end()) released.push_back(word);
  return released;
}

class IterationReporter {
 public:
  IterationReporter(const CalibrationProblem& problem, const RunContext& context, int stage, int stage_count,
                    double& furthest, std::vector<IterationRecord>& records)
      : problem_(problem),
        context_(context),
        stage_(stage),
        stage_count_(stage_count),
        furthest_(furthest),
        records_(records) {}

  // Reports these names together with the next iteration.
  void reportReleased(std::vector<std::string> words) { released_ = std::move(words); }

  // False if measurements must be assigned again.
  bool report(const SolverIteration& iteration) {
    constexpr double kTypicalIterations = 8.0;
    const double share = std::min(1.0, (iterations_++ + 1.0) / kTypicalIterations);
    furthest_ = std::max(furthest_, (stage_ + share) / stage_count_);  // a stage may be solved more than once
    context_.progress.stageProgress(furthest_);
    const CalibrationState state = problem_.state();
    records_.push_back({stage_ + 1, static_cast<int>(records_.size()), iteration.cost,
                        iteration.gradient_max_norm, iteration.step_norm, state.cameras,
                        std::exchange(released_, {})});
    if (context_.observer != nullptr) context_.observer->iterationDone(records_.back(), state);
    return problem_.segmentDrift_knots() <= kFurthestDrift_knots;
  }

 private:
  const CalibrationProblem& problem_;
  const RunContext& context_;
  int stage_, stage_count_, iterations_ = 0;
  double& furthest_;  // of the whole batch, 0..1
  std::vector<IterationRecord>& records_;
  std::vector<std::string> released_;
};

SolverLimits loosely(const SolverOptions& options) {
  return {options.max_iterations, 0.0, options.stage_tolerance, options.threads};
}
SolverLimits closely(const SolverOptions& options) {
  constexpr double kSameCost = 1e-9;
  return {options.max_iterations, options.last_step_sigmas, kSameCost, options.threads};
}

class Batch {
 public:
  Batch(const CalibrationInput& input, const CalibrationState& initial, const OptimisationOptions& options,
        const RunContext& context)
      : input_(input),
        options_(options),
        context_(context),
        problem_(input, options, initial),
        weights_(givenWeights(input)),
        fit_samples_(weights_.used_samples) {}

  BatchSolution run();
  BatchSolution continueFrom(std::vector<IterationRecord> before);
  BatchSolution refine(int solutions, const SolverLimits& limits);

 private:
  std::vector<ParameterStages> stages() const;
  void solveStage(ParameterStages stage, int index, const SolverLimits& limits);
  void reportReleased(IterationReporter& reporter);
  void solveLastStage();
  void holdStillAxes();
  bool updateWeights();
  bool updateWeights(const std::vector<CircleError>& errors);
  void updateSmoothness();
  void takeSolution();
  BatchSolution finish();
  void reportFits();
  void reportNotes();
  struct ImuFits {
    std::vector<ImuFit> fits;                        // RMS by IMU, in SI units, of the samples used
    std::vector<double> gyroscopes, accelerometers;  // the same in units of the given noise
  };
  std::vector<SampleErrors> imuErrors() const;                     // by IMU
  bool selectImuSamples(const std::vector<SampleErrors>& errors);  // true if others take part than before
  ImuFits imuFits(const std::vector<SampleErrors>& errors) const;

  const CalibrationInput& input_;
  const OptimisationOptions& options_;
  const RunContext& context_;
  CalibrationProblem problem_;
  Weights weights_;
  SolverMemory memory_;
  const std::vector<SampleSelection> fit_samples_;  // by IMU
  BatchSolution solution_;
  double progress_ = 0.0;
  std::vector<std::string> free_;  // names of the parameters that were free so far
};

std::vector<ParameterStages> Batch::stages() const {
  std::vector<ParameterStages> all = {ParameterStages::Extrinsics};
  if (input_.imus.size() > 1) all.push_back(ParameterStages::FurtherImus);
  if (!input_.imus.empty() && options_.free_imu_intrinsics) all.push_back(ParameterStages::Mappings);
  const bool late = options_.freesIntrinsics() || options_.free_board_size || options_.board_bow;
  if (late && all.back() != lastStage(options_)) all.push_back(lastStage(options_));  // that releases them
  return all;
}

void Batch::solveStage(ParameterStages stage, int index, const SolverLimits& limits) {
  const int stage_count = static_cast<int>(stages().size()) + 1;  // the last one twice
  IterationReporter reporter(problem_, context_, index, stage_count, progress_, solution_.iterations);
  solution_.converged = false;
  for (int round = 0; round < options_.max_rounds; ++round) {
    context_.throwIfStopped();
    problem_.build(stage, weights_);
    reportReleased(reporter);
    const SolverSummary summary =
        solveNormalEquations(problem_, limits, context_.stop, memory_,
                             [&](const SolverIteration& iteration) { return reporter.report(iteration); });
    if (!summary.failure.empty()) {
      throw calibrationFailed("optimisation", "the batch could not be solved: " + summary.failure,
                              "Check the noise densities, the board's size and the camera's intrinsics");
    }
    context_.progress.log(
        LogLevel::Debug,
        fmt::format("stage {} round {}: {} iterations, cost {:.6e} to {:.6e}", index + 1, round + 1,
                    summary.iterations, summary.initial_cost, summary.final_cost));
    if (problem_.segmentDrift_knots() <= options_.segment_drift) {
      solution_.converged = summary.converged;
      return;
    }
  }
}

// A parameter that is fixed again later (an unexcited axis) counts as released.
void Batch::reportReleased(IterationReporter& reporter) {
  std::vector<std::string> released = releasedWords(quantityWords(problem_.quantities()), free_);
  if (released.empty()) return;
  free_.insert(free_.end(), released.begin(), released.end());
  reporter.reportReleased(std::move(released));
}

// Noise scales and outliers, both from all circles and samples; true if anything
// changed enough to solve again.
bool Batch::updateWeights() {
  return updateWeights(circleErrors(input_, problem_.state(), options_, weights_.scales));
}

bool Batch::updateWeights(const std::vector<CircleError>& errors) {
  std::vector<double> circles;
  for (std::size_t i = 0; i < input_.cameras.size(); ++i) circles.push_back(robustScale(errors, i));
  const std::vector<SampleErrors> imu_errors = imuErrors();
  bool changed = selectImuSamples(imu_errors);
  const ImuFits imus = imuFits(imu_errors);
  const auto update = [&](std::vector<double>& old, const std::vector<double>& fresh) {
    constexpr double kNoticeable = 0.05;
    for (std::size_t i = 0; i < old.size(); ++i) {
      const double scale = std::clamp(fresh[i], kMinScale, kLargestScale);
      changed = changed || std::abs(scale / old[i] - 1.0) > kNoticeable;
      old[i] = scale;
    }
  };
  update(weights_.scales.circles, circles);
  update(weights_.scales.gyroscopes, imus.gyroscopes);
  update(weights_.scales.accelerometers, imus.accelerometers);
  if (input_.imus.empty()) updateSmoothness();
  CircleSelection selection = selectCircles(input_, errors, weights_.scales.circles, options_);
  changed = changed || selection != weights_.used_circles;
  weights_.used_circles = std::move(selection);
  for (std::size_t i = 0; i < input_.cameras.size(); ++i)
    weights_.scales.displacements[i] =
        displacementScale(input_, problem_.state(), options_, errors, weights_.used_circles, i);
  return changed;
}

// Circles change little by it, so the batch is not solved again.
void Batch::updateSmoothness() {
  constexpr double kMin = 1e-4;
  const TrajectorySmoothness found = trajectorySmoothness(input_, problem_.state());
  const auto scale = [&](double measured, double largest) {
    return std::clamp(options_.smooth_unevenness * measured / largest, kMin, 1.0);
  };
  weights_.scales.smooth_rotation = scale(found.rotation_rad_s2, options_.smooth_rotation_rad_s2);
  weights_.scales.smooth_position = scale(found.position_m_s2, options_.smooth_position_m_s2);
}

std::vector<SampleErrors> Batch::imuErrors() const {
  const CalibrationState state = problem_.state();
  std::vector<SampleErrors> errors;
  for (std::size_t i = 0; i < input_.imus.size(); ++i) errors.push_back(sampleErrors(input_, state, i));
  return errors;
}

bool Batch::selectImuSamples(const std::vector<SampleErrors>& errors) {
  std::vector<SampleSelection> selected;
  for (std::size_t i = 0; i < input_.imus.size(); ++i)
    selected.push_back(selectSamples(errors[i], fit_samples_[i], options_.outlier_sigma));
  const bool changed = selected != weights_.used_samples;
  weights_.used_samples = std::move(selected);
  return changed;
}

Batch::ImuFits Batch::imuFits(const std::vector<SampleErrors>& errors) const {
  ImuFits all;
  for (std::size_t i = 0; i < input_.imus.size(); ++i) {
    const ImuData& data = input_.imus[i];
    const SampleSelection& used = weights_.used_samples[i];
    const ImuFit fit{rmsPerAxis(errors[i].gyroscope_rad_s, used.gyroscope),
                     rmsPerAxis(errors[i].accelerometer_m_s2, used.accelerometer)};
    all.fits.push_back(fit);
    all.gyroscopes.push_back(fit.gyroscope_rms_rad_s / data.gyroscopeSigma_rad_s());
    all.accelerometers.push_back(fit.accelerometer_rms_m_s2 / data.accelerometerSigma_m_s2());
  }
  return all;
}

BatchSolution Batch::run() {
  const std::vector<ParameterStages> all = stages();
  // By the initial errors: else most circles would start in the flat part of Huber's loss.
  const std::vector<CircleError> initial = circleErrors(input_, problem_.state(), options_, weights_.scales);
  if (initial.empty())
    throw calibrationFailed("optimisation", "no view of the board is within the trajectory's time range",
                            "Check that camera and IMU recorded at the same time");
  updateWeights(initial);
  for (std::size_t i = 0; i < all.size(); ++i) {
    solveStage(all[i], static_cast<int>(i), loosely(options_));
    updateWeights();
    holdStillAxes();  // with noise scales that are those of a first solution
  }
  solveLastStage();
  return finish();
}

void Batch::holdStillAxes() {
  const CalibrationState state = problem_.state();
  for (std::size_t imu = 0; imu < input_.imus.size(); ++imu)
    weights_.held_axes[imu] = stillAxes(input_, state, weights_, imu);
}

// Solves until convergence with weights that follow from the residuals. Weights need no converged residuals,
// so that only the last solution converges.
void Batch::solveLastStage() {
  const std::vector<ParameterStages> all = stages();
  const auto solve = [&](const SolverLimits& limits) {
    solveStage(all.back(), static_cast<int>(all.size()), limits);
  };
  constexpr int kMaxReweightings = 3;
  bool changed = true;
  for (int i = 1; i < kMaxReweightings && changed; ++i) {
    solve(loosely(options_));
    changed = updateWeights();
  }
  solve(closely(options_));
}

BatchSolution Batch::continueFrom(std::vector<IterationRecord> before) {
  for (const IterationRecord& record : before)
    free_.insert(free_.end(), record.released.begin(), record.released.end());
  solution_.iterations = std::move(before);
  updateWeights();
  holdStillAxes();
  solveLastStage();
  return finish();
}

// Weights by the residuals before each solution, and after several.
BatchSolution Batch::refine(int solutions, const SolverLimits& limits) {
  updateWeights();
  holdStillAxes();
  for (int i = 0; i < solutions; ++i) {
    solveStage(stages().back(), static_cast<int>(stages().size()), limits);
    if (solutions > 1) updateWeights();
  }
  takeSolution();
  return std::move(solution_);
}

void Batch::takeSolution() {
  solution_.state = problem_.state();
  solution_.scales = weights_.scales;
  solution_.used_circles = weights_.used_circles;
  solution_.used_samples = weights_.used_samples;
}

BatchSolution Batch::finish() {
  takeSolution();
  reportFits();
  reportNotes();
  context_.progress.stageProgress(1.0);
  return std::move(solution_);
}

void Batch::reportFits() {
  solution_.imus = imuFits(imuErrors()).fits;
  for (const CameraData& camera : input_.cameras) {
    CameraFit& fit = solution_.cameras.emplace_back();
    fit.windows_total = static_cast<int>(camera.observations.windows.size());
    for (const BoardView& view : camera.observations.views) {
      ++(view.kind == ViewKind::Complete ? fit.windows_complete : fit.windows_partial);
    }
    for (const WindowReport& window : camera.observations.windows)
      fit.windows_rejected += window.outcome == WindowOutcome::RejectedByHand ? 1 : 0;
  }
  std::vector<std::vector<std::uint8_t>> view_used;
  for (const CameraData& camera : input_.cameras) view_used.emplace_back(camera.observations.views.size());
  std::vector<double> normalised2(input_.cameras.size()), coordinates(input_.cameras.size());
  solution_.circle_errors =
      circleErrors(input_, solution_.state, options_, solution_.scales, &solution_.used_circles);
  for (const CircleError& error : solution_.circle_errors) {
    const bool used = solution_.used_circles[error.camera][error.view][error.index] != 0;
    CameraFit& fit = solution_.cameras[error.camera];
    ++(used ? fit.circles_used : fit.circles_rejected);
    if (!used) continue;
    fit.reprojection_rms_px += error.error_px.squaredNorm();
    normalised2[error.camera] += error.normalised2;
    coordinates[error.camera] += error.known_directions;
    fit.windows_used += view_used[error.camera][error.view] ? 0 : 1;
    view_used[error.camera][error.view] = 1;
  }
  for (std::size_t i = 0; i < input_.cameras.size(); ++i) {
    CameraFit& fit = solution_.cameras[i];
    const double count = std::max(1.0, coordinates[i]);
    fit.reprojection_rms_px = std::sqrt(2.0 * fit.reprojection_rms_px / count);  // of distances
    fit.normalised_rms = std::sqrt(normalised2[i] / count);
    fit.neighbour_agreement = neighbourAgreement(input_, solution_.state, options_, weights_, i);
  }
}

void Batch::reportNotes() {
  constexpr double kWorthSaying = 2.0;
  const auto say = [&](const std::string& sensor, const char* what, double scale) {
    if (scale > 1.0 / kWorthSaying && scale < kWorthSaying) return;
    solution_.notes.push_back(fmt::format(
        "{}: {} is {:.2g} times its given sigma; the weights use the estimate", sensor, what, scale));
  };
  const auto noteHeld = [&](const std::string& imu, const char* motion, std::size_t axes, const char* what) {
    if (axes == 0) return;
    solution_.notes.push_back(
        fmt::format("{}: there is hardly any {} along {} of 3 axes; {} for them", imu, motion, axes, what));
  };
  for (std::size_t i = 0; i < input_.cameras.size(); ++i) {
    say(input_.cameras[i].name, "the spread of points", solution_.scales.circles[i]);
    const CameraFit& fit = solution_.cameras[i];
    if (fit.circles_rejected > 0) {
      solution_.notes.push_back(fmt::format("{}: {} of {} points were rejected as outliers",
                                            input_.cameras[i].name, fit.circles_rejected,
                                            fit.circles_rejected + fit.circles_used));
    }
  }
  for (std::size_t i = 0; i < input_.imus.size(); ++i) {
    say(input_.imus[i].name, "the gyroscope's residual", solution_.scales.gyroscopes[i]);
    say(input_.imus[i].name, "the accelerometer's residual", solution_.scales.accelerometers[i]);
    for (std::string& note : notesOfUnused(input_, i, weights_.used_samples[i]))
      solution_.notes.push_back(std::move(note));
    if (options_.estimatesGyroscopeRotations())
      noteHeld(input_.imus[i].name, "rotation", weights_.held_axes[i].gyroscope.size(),
               "the gyroscope's misalignment is fixed");
  }
  if (!input_.imus.empty()) {
    noteHeld(input_.imus[input_.reference_imu].name, "lever of rotation",
             weights_.held_axes[input_.reference_imu].axesWithoutRotation().size(),
             "translations are fixed at 0");
  }
  if (!solution_.converged) {
    solution_.notes.emplace_back("the optimiser stopped at its iteration limit before it converged");
  }
}

// Preconditions that earlier stages of the pipeline ensure.
void assertComplete([[maybe_unused]] const CalibrationInput& input,
                    [[maybe_unused]] const CalibrationState& initial) {
  assert(!input.cameras.empty() && input.cameras.size() + input.imus.size() >= 2);
  assert(initial.cameras.size() == input.cameras.size() && initial.imus.size() == input.imus.size());
  assert(initial.world_from_imu_rotation.segmentCount() >= 1 && initial.imu_in_world_m.segmentCount() >= 1);
  assert(std::all_of(input.cameras.begin(), input.cameras.end(),
                     [](const CameraData& camera) { return camera.lens.detection_intrinsics.has_value(); }));
}

}  // namespace

BatchSolution optimiseBatch(const CalibrationInput& input, const CalibrationState& initial,
                            const OptimisationOptions& options, const RunContext& context) {
  assertComplete(input, initial);
  return Batch(input, initial, options, context).run();
}

BatchSolution continueBatch(const CalibrationInput& input, const CalibrationState& solved,
                            std::vector<IterationRecord> before, const OptimisationOptions& options,
                            const RunContext& context) {
  assertComplete(input, solved);
  return Batch(input, solved, options, context).continueFrom(std::move(before));
}

BatchSolution refineBatch(const CalibrationInput& input, const CalibrationState& solved,
                          const OptimisationOptions& options, const RunContext& context) {
  assertComplete(input, solved);
  const RunContext unobserved = context.unobserved();
  return Batch(input, solved, options, unobserved).refine(1, closely(options));
}

BatchSolution tryBatch(const CalibrationInput& input, const CalibrationState& solved,
                       const OptimisationOptions& options, const RunContext& context) {
  assertComplete(input, solved);
  const RunContext unobserved = context.unobserved();
  return Batch(input, solved, options, unobserved).refine(2, loosely(options));
}

}  // namespace evical
