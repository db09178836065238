#include "core/pipeline/rig/calibration_pipeline.h"

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/option_table.h"
#include "core/base/time.h"
#include "core/data/calibration_observer.h"
#include "core/data/quality_warning.h"
#include "core/geometry/projection_difference.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/initialise.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/circle_errors.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/optimisation/uncertainty/prior_check.h"
#include "core/optimisation/uncertainty/shared_sensors.h"
#include "core/pipeline/detection/board_size_check.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/pipeline/detection/view_rejection.h"
#include "core/pipeline/rig/calibrated_lenses.h"
#include "core/pipeline/rig/calibration_checks.h"
#include "core/pipeline/rig/detected_recording.h"
#include "core/pipeline/rig/misfit_diagnosis.h"
#include "core/pipeline/rig/residual_consistency.h"
#include "core/pipeline/rig/split_half_check.h"
#include "core/pipeline/rig/tag_corners.h"
#include "core/pipeline/rig/wrong_inputs.h"
#include "core/pipeline/session/session_keys.h"
#include "core/report/report_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr const char* kModelGroup = "optimisation.model";  // of options that may be `auto`

// Not a separate verdict: each half has less data than the whole, and less accurate sigmas.
void validateByHalves(const CalibrationInput& input, const OptimisationOptions& options, double block_s,
                      const RunContext& context, CalibrationResult& result) {
  result.split_half_check = checkHalves(input, result.state, options, block_s, context);
  const SplitHalfCheck& validation = *result.split_half_check;
  context.progress.log(
      LogLevel::Info,
      validation.failure.empty()
          ? fmt::format("the halves of the recording differ by {:.2f} sigmas (RMS)", validation.rms_sigmas)
          : "halves of the recording: " + validation.failure);
}

// Removes views on the smaller part's side of a step, and those close to it. Returns the indices that the
// kept ones had.
std::vector<int> keepLargerSide(const ClockStep& step, std::vector<BoardView>& views) {
  constexpr double kMargin_s = 1.5;  // accuracy of the step's time
  std::vector<int> kept;
  std::vector<BoardView> larger;
  for (std::size_t k = 0; k < views.size(); ++k) {
    const double time_s = views[k].time_s;
    if (step.larger_part_first ? time_s > step.at_s - kMargin_s : time_s < step.at_s + kMargin_s) continue;
    kept.push_back(static_cast<int>(k));
    larger.push_back(std::move(views[k]));
  }
  views = std::move(larger);
  return kept;
}

// Measured centre of a residual's circle.
Eigen::Vector2d centreIn(const BoardView& view, int circle) {
  return std::ranges::lower_bound(view.circles, circle, {}, &CircleObservation::circle)->centre_px;
}

// One run: its stages, and the data that they share.
class Calibration {
 public:
  Calibration(const Session& session, const RunContext& context)
      : session_(session), context_(context), options_(*session.options.optimisation) {}

  CalibrationOutcome fromRecording() {
    recording_is_there_ = true;
    return outcomeOf([this] {
      checkSession(session_);
      FoundLenses found = findLenses(session_, context_);
      lenses_ = std::move(found.lenses);
      run_.intrinsics = std::move(found.intrinsics);
      runFrom(CalibrationStage::Detect);
    });
  }

  CalibrationOutcome fromDetections(DetectionResult detections,
                                    std::vector<std::optional<IntrinsicsResult>> intrinsics) {
    run_.detections = std::move(detections);
    run_.intrinsics = std::move(intrinsics);
    before_s_ = std::max(run_.detections.read_s, run_.detections.detect_s);
    return outcomeOf([this] {
      checkSession(session_);
      prepareInput();
      runFrom(CalibrationStage::Initialise);
    });
  }

  InitialisedCalibration toInitialState(DetectionResult detections,
                                        std::vector<std::optional<IntrinsicsResult>> intrinsics) {
    run_.detections = std::move(detections);
    run_.intrinsics = std::move(intrinsics);
    checkSession(session_);
    prepareInput();
    initialiseState();
    return {std::move(input_), std::move(initial_)};
  }

 private:
  struct StageWork {
    CalibrationStage stage;
    void (Calibration::*work)();
  };
  static const std::array<StageWork, 4> kWork;  // intrinsics, if not given, are calibrated before

  template <class Work>
  CalibrationOutcome outcomeOf(const Work& work) {
    CalibrationOutcome outcome;
    try {
      work();
      returnDetections();
      outcome.run = std::move(run_);
      return outcome;
    } catch (const Cancelled&) {
      outcome.status = RunStatus::Cancelled;
    } catch (const CalibrationError& error) {
      outcome.status = RunStatus::Failed;
      outcome.error = error;
    }
    if (outcome.error) explainError(outcome);
    returnDetections();
    outcome.detections = std::move(run_.detections);
    return outcome;
  }

  // The error's axes as those of the recording, which the session may already have changed.
  CalibrationError ofRawAxes(const CalibrationError& error, const Repair& repair) const {
    const Repair raw = evical::ofRawAxes(repair, session_);
    const auto replaced = [&](std::string text) {
      const std::size_t at = text.find(repair.value);
      return raw.value == repair.value || at == std::string::npos
                 ? text
                 : text.replace(at, repair.value.size(), raw.value);
    };
    return CalibrationError(error.kind(), error.place(), replaced(error.problem()), replaced(error.advice()))
        .repairedBy(raw);
  }

  // Replaces the error by the wrong input that caused it.
  void explainError(CalibrationOutcome& outcome) {
    try {
      const DetectionResult& detections = run_.detections;
      if (input_.cameras.empty() && detections.cameras.size() == session_.cameras.size() &&
          detections.lenses.size() == detections.cameras.size() &&
          detections.imus.size() == session_.imus.size())
        input_ = makeInput(session_, run_.detections);  // the checks of the pass failed
      if (!mirrored_)
        outcome.error =
            withWrongInput(*outcome.error, session_, input_, initial_, recording_is_there_, context_);
      if (const std::optional<Repair> repair = outcome.error->repair())
        outcome.error = ofRawAxes(*outcome.error, *repair);
    } catch (const Cancelled&) {
      outcome = {};
      outcome.status = RunStatus::Cancelled;
    }
  }

  void runFrom(CalibrationStage first) {
    for (const StageWork& each : kWork) {
      if (each.stage < first) continue;
      if (each.stage == CalibrationStage::CompareHalves && !session_.options.report->split_half_check)
        continue;
      const StageRow& row = rowOf(each.stage);
      context_.progress.stageStarted(row.name);
      const Stopwatch stopwatch;
      (this->*each.work)();
      giveBackFreeMemory();
      context_.progress.stageProgress(1.0);
      run_.result.timing.*row.duration_s = stopwatch.elapsed_s();
    }
    conclude();
  }

  void detect() {
    run_.detections = readAndDetect(session_, lenses_, context_);
    prepareInput();
  }

  void prepareInput() {
    rejectAsIn(session_, run_.detections);
    checkPass(session_, context_, run_.detections);
    input_ = makeInput(session_, run_.detections);
    if (context_.observer != nullptr) context_.observer->detectionDone(input_);
  }

  // Returns the input's data to the pass, with the views that were removed.
  void returnDetections() {
    restorePass(std::exchange(input_, {}), run_.detections);
    for (std::size_t k = 0; k < whole_views_.size(); ++k)
      if (std::optional<std::vector<BoardView>> whole = std::exchange(whole_views_[k], std::nullopt))
        run_.detections.cameras[k].views = std::move(*whole);
  }

  void initialiseState() {
    try {
      initial_ = initialise(input_, *session_.options.initialisation, context_, statedSigns(session_));
    } catch (const MirrorError&) {
      mirrored_ = true;
      throw;
    } catch (const CalibrationError& error) {
      if (input_.cameras.empty()) throw;
      throw withClockRate(error, session_, input_.cameras.front().observations, input_.imus);
    }
    dropViewsAcrossClockStep();
    for (const InitialisationStep& step : initial_.steps)
      context_.progress.log(LogLevel::Debug, fmt::format("{}: {}", step.name, step.text()));  // for log.txt
    for (const std::string& warning : initial_.warnings) context_.progress.log(LogLevel::Warning, warning);
  }

  // If clocks step, one time offset is valid for a part of the recording only.
  void dropViewsAcrossClockStep() {
    std::string doubt;
    for (std::size_t k = 0; k < initial_.agreements.size(); ++k) {
      const std::optional<ClockStep>& step = initial_.agreements[k].clock_step;
      if (!step) continue;
      std::vector<BoardView>& views = input_.cameras[k].observations.views;
      keepWhole(k);
      kept_views_.resize(input_.cameras.size());
      kept_views_[k] = keepLargerSide(*step, views);
      const double share = 1.0 - static_cast<double>(views.size()) /
                                     static_cast<double>(std::max<std::size_t>(whole_views_[k]->size(), 1));
      doubt += fmt::format(
          "{}{}: the offset between its clock and the IMU's steps by {:.1f} ms about {:.1f} s after the "
          "start: {:.0f} % of the views, those on the shorter side, are excluded",
          doubt.empty() ? "" : "; ", input_.cameras[k].name, 1e3 * step->step_s, step->at_s, 100.0 * share);
    }
    if (doubt.empty()) return;
    initial_ = initialise(input_, *session_.options.initialisation, context_, statedSigns(session_));
    initial_.warnings.push_back(doubt);
    clock_doubt_ = doubt;
  }

  // Again with each parameter that is `auto` and that a test shows for certain to be needed.
  void optimise() {
    for (bool again = true; again;) {
      try {
        solve();
        again = freeWhatIsNeeded(run_.result.causes);
      } catch (const CalibrationError& error) {
        if (!error.repair() || !isAutomatic(*error.repair())) throw;
        again = freeWhatIsNeeded({QualityWarning{error.problem(), error.repair()}});
      }
    }
  }

  // True if the repair sets an option that is `auto`.
  bool isAutomatic(const Repair& repair) const {
    const std::vector<OptionRow> rows = ModelOptions::table().rows(options_, kModelGroup);
    return std::ranges::any_of(
        rows, [&](const OptionRow& row) { return row.name == repair.key && row.value == "auto"; });
  }

  // Measured corners of tags that are displaced in all views alike are moved until their residuals do not
  // show it. Freed parameters continue from the solution before, unless that has a wrong input: its
  // parameters may be far from right.
  BatchSolution solveWithTags(const std::optional<CalibrationState>& solved,
                              std::vector<IterationRecord> before) {
    constexpr int kMaxRounds = 5;
    BatchSolution solution = solved ? continueBatch(input_, *solved, std::move(before), options_, context_)
                                    : optimiseBatch(input_, initial_.state, options_, context_);
    for (int round = 0; round < kMaxRounds && moveCornersOfTags(solution); ++round)
      solution = continueBatch(input_, solution.state, std::move(solution.iterations), options_, context_);
    return solution;
  }

  bool moveCornersOfTags(const BatchSolution& solution) {
    if (std::ranges::none_of(input_.cameras, [&](const CameraData& camera) {
          return input_.boardAt(camera.board).type == BoardType::AprilGrid;
        }))
      return false;
    const std::vector<CircleResidual> residuals =
        circleResiduals(input_, solution.circle_errors, solution.used_circles);
    bool any = false;
    for (std::size_t k = 0; k < input_.cameras.size(); ++k) {
      if (input_.boardOf(k).type != BoardType::AprilGrid) continue;
      const TagCornerShift shift = tagCornerShift(k, residuals);
      if (std::abs(shift.outwards_px) <
          std::max(options_.tag_corner_px, options_.tag_corner_sigmas * shift.sigma_px))
        continue;
      keepWhole(k);
      moveTagCorners(shift.outwards_px, input_.cameras[k].observations.views);
      corners_outwards_px_.resize(input_.cameras.size());
      corners_outwards_px_[k] += shift.outwards_px;
      any = true;
    }
    return any;
  }

  void noteCornersOfTags() {
    for (std::size_t k = 0; k < corners_outwards_px_.size(); ++k)
      if (const double moved_px = corners_outwards_px_[k]; moved_px != 0.0)
        run_.result.notes.push_back(fmt::format(
            "{}: measured tag corners are {:.2f} px too far {} the middle of their tag; this is corrected",
            run_.detections.cameras[k].camera, std::abs(moved_px), moved_px > 0.0 ? "towards" : "from"));
  }

  // Before views of the input are changed, which belong to the pass.
  void keepWhole(std::size_t camera) {
    whole_views_.resize(input_.cameras.size());
    if (!whole_views_[camera]) whole_views_[camera] = input_.cameras[camera].observations.views;
  }

  // Residuals refer to the views of the pass, of which the input may have only some, with corrected corners
  // of tags.
  void referToPass(std::vector<CircleResidual>& residuals) const {
    for (CircleResidual& residual : residuals) {
      const auto camera = static_cast<std::size_t>(residual.camera);
      if (camera >= whole_views_.size() || !whole_views_[camera]) continue;
      if (camera < kept_views_.size() && !kept_views_[camera].empty())
        residual.view = kept_views_[camera].at(static_cast<std::size_t>(residual.view));
      const BoardView& view = whole_views_[camera]->at(static_cast<std::size_t>(residual.view));
      residual.centre_px = centreIn(view, residual.circle);
    }
  }

  bool freeWhatIsNeeded(const std::vector<QualityWarning>& causes) {
    bool any = false;
    for (const QualityWarning& cause : causes) {
      if (!cause.repair || !isAutomatic(*cause.repair)) continue;
      ModelOptions::table().set(options_, kModelGroup,
                                cause.repair->key.substr(cause.repair->key.rfind('.') + 1),
                                cause.repair->value);
      freed_.push_back(cause);
      any = true;
    }
    return any;
  }

  void solve() {
    const OptimisationOptions& options = options_;
    CalibrationResult& result = run_.result;
    const bool continues = !result.state.cameras.empty() && wrong_noise_.empty() &&
                           std::ranges::none_of(result.causes, isWrongInput);
    const auto solved = continues ? std::optional(std::move(result.state)) : std::nullopt;
    std::vector<IterationRecord> before = std::move(result.iterations);
    result = {.timing = result.timing};
    BatchSolution solution = solveWithTags(solved, std::move(before));
    giveBackFreeMemory();
    UncertaintyEstimate uncertainty = estimateUncertainty(input_, solution, options, context_);
    PriorCheck priors = checkPriors(input_, solution, options, context_);
    result.status = uncertainty.status;
    result.reason = uncertainty.reason;
    if (!result.reason.empty()) result.causes = {QualityWarning{result.reason, {}, "observability"}};
    if (!solution.converged && result.status == CalibrationStatus::Ok)
      flagDoubtful(QualityWarning{"the optimisation did not converge: increase "
                                  "optimisation.solver.max_iterations, or check the residuals",
                                  Repair{"optimisation.solver.max_iterations",
                                         std::to_string(2 * options.max_iterations)},
                                  "not_converged"},
                   result);
    flagDoubtful(uncertainty.other_sensors, result, "another_sensor");
    flagDoubtful(QualityWarning{uncertainty.rolling_shutters, kFreeLineDelays, "rolling_shutter"}, result);
    flagDoubtful(priors.doubt, result, "prior");
    flagDoubtful(boardDoubt(uncertainty, solution.state), result);
    flagDoubtful(uncertainty.stretch_doubt, result, "board_stretch");
    flagDoubtful(uncertainty.bow_doubt, result, causeName(CauseKind::BentBoard));
    flagDoubtful(QualityWarning{uncertainty.wrong_lenses, kFreeLenses, causeName(CauseKind::Lens)}, result);
    flagDoubtful(clock_doubt_, result, "clock_step");
    for (const QualityWarning& wrong : wrongInputs(session_, input_, initial_, solution, uncertainty))
      flagDoubtful(wrong, result);
    wrong_noise_ = wrongNoise(session_, input_, solution);
    judge(solution, heldDoubt(uncertainty, !priors.doubt.empty()), uncertainty.change);
    if (result.status == CalibrationStatus::Doubtful) {
      flagDoubtful(scatteringStampsIn(input_, solution, run_.detections.faults, options), result,
                   "stamp_jitter");
      flagDoubtful(saturation(), result);
    }
    flagDoubtful(initial_.mirror_doubt, result, "mirrored_image");
    result.circle_residuals = circleResiduals(input_, solution.circle_errors, solution.used_circles);
    referToPass(result.circle_residuals);
    result.state = std::move(solution.state);
    result.uncertainty = std::move(uncertainty.report);
    addStampErrors(input_, run_.detections.imu_stamp_steps_s, options, result);
    run_.as_weighed = std::move(uncertainty.as_weighed);
    result.latencies = sensorLatencies(input_, result.state, result.uncertainty);
    result.cameras = std::move(solution.cameras);
    result.imus = std::move(solution.imus);
    result.iterations = std::move(solution.iterations);
    std::vector<std::string> slow = notesOnSlowPixels(input_, options);
    // Most of what a solution with a wrong input shows follows from that input.
    const bool wrong_input = result.status != CalibrationStatus::Ok &&
                             (!wrong_noise_.empty() || std::ranges::any_of(result.causes, isWrongInput));
    if (wrong_input) solution.notes.clear();
    if (wrong_input) slow.clear();
    notes_ = std::move(solution.notes);
    for (const auto* more : {&uncertainty.notes, &priors.notes, &slow})
      notes_.insert(notes_.end(), more->begin(), more->end());
  }

  QualityWarning saturation() const {
    return saturationIn(input_, options_, session_.options.initialisation->heavy_saturation_share);
  }

  // Doubt about the board's size. The initialisation detects large errors, since no prior pulls it towards
  // the given size. It is misled by a stretched board, and by an inaccurate lens or a late accelerometer that
  // the batch has corrected since.
  QualityWarning boardDoubt(const UncertaintyEstimate& uncertainty, const CalibrationState& state) const {
    // Chosen by size, not measured: 1 px at the edge of a 346x260 image is 0.6 % of focal length, which
    // corresponds to a wrong board spacing; 2 ms are 10 % of an acceleration that oscillates at 8 Hz.
    constexpr double kAnotherLens_px = 1.0, kLate_s = 2e-3;
    const bool led_astray =
        !uncertainty.stretch_doubt.empty() ||
        std::any_of(state.imus.begin(), state.imus.end(),
                    [](const ImuState& imu) { return std::abs(imu.accelerometer_delay_s) > kLate_s; }) ||
        std::any_of(state.cameras.begin(), state.cameras.end(), [](const CameraState& camera) {
          const CameraLens& lens = camera.lens;
          return lens.solved &&
                 projectionDifference(*lens.detection_intrinsics, *lens.solved).rms_px > kAnotherLens_px;
        });
    if (initial_.doubt.empty() || led_astray) return {uncertainty.scale_doubt, {}, "board_size"};
    return {initial_.doubt, {}, "board_scale"};
  }

  // Doubt about fixed parameters. A prior with a large error has the same effect as a misaligned gyroscope.
  static QualityWarning heldDoubt(const UncertaintyEstimate& uncertainty, bool prior_is_off) {
    if (!uncertainty.bent_board.empty())
      return {uncertainty.bent_board, kFreeBow, causeName(CauseKind::BentBoard)};
    if (prior_is_off) return {};
    if (!uncertainty.turned_gyroscopes.empty())
      return {uncertainty.turned_gyroscopes, kFreeTurn, causeName(CauseKind::GyroscopeTurned)};
    return {uncertainty.wandering_imus, {}, "wandering_imu"};
  }

  // The cause of a misfit comes before the misfit, and a change within the recording before other causes. A
  // misaligned gyroscope is reported only if nothing else is: many unmodelled effects look like it, such as a
  // bent board.
  void judge(const BatchSolution& solution, const QualityWarning& held, const QualityWarning& change) {
    const OptimisationOptions& options = options_;
    const MisfitVerdict misfit = judgeMisfit(input_, solution, options);
    if (misfit.doubt.empty() && held.text.empty() && change.text.empty()) return;
    QualityWarning cause = change;
    if (cause.text.empty())
      if (const std::optional<Cause> found = findCause(input_, solution, options, context_))
        cause = {found->text, found->repair, causeName(found->kind), found->explains};
    if (cause.text.empty() && !misfit.failure.empty())
      cause = {scatteringStampsIn(input_, solution, run_.detections.faults, options), {}, "stamp_jitter"};
    if (!misfit.failure.empty()) {
      std::erase_if(run_.result.causes, [](const QualityWarning& each) { return !isWrongInput(each); });
      flagDoubtful(misfit.failure, run_.result, "misfit");
      flagDoubtful(cause, run_.result);
      flagDoubtful(saturation(), run_.result);
      for (const QualityWarning& noise : wrong_noise_) flagDoubtful(noise, run_.result);
      rankReasons(run_.result);
      const bool is_unknown = run_.result.causes.front().name == "misfit";
      throw calibrationFailed(
          session_.source.string(), run_.result.reason,
          is_unknown ? "Check the board, the lens and the streams " + howTo(HowTo::EditSession) : "")
          .repairedBy(run_.result.repair);
    }
    if (misfit.doubt.empty() && cause.text.empty()) flagDoubtful(held, run_.result);
    flagDoubtful(misfit.doubt, run_.result, "misfit");
    flagDoubtful(cause, run_.result);
  }

  void compareHalves() {
    validateByHalves(input_, options_, session_.options.report->split_half_check_block_s, context_,
                     run_.result);
    const std::string doubt = doubtOfHalves(*run_.result.split_half_check, options_);
    if (run_.result.status == CalibrationStatus::Ok) flagDoubtful(doubt, run_.result, "halves");
  }

  // A density that is too large is a reason only if the result is not ok: it makes sigmas too large.
  void rank() {
    CalibrationResult& result = run_.result;
    for (const QualityWarning& noise : wrong_noise_) {
      context_.progress.log(LogLevel::Warning, noise.text);
      if (result.status == CalibrationStatus::Ok)
        result.notes.insert(result.notes.begin(), noise.text);
      else
        flagDoubtful(noise, result);
    }
    rankReasons(result);
    // Notes that a reason states, or a warning.
    const auto isDistinguished = [&](const std::string& note) {
      return result.reason.find(note) != std::string::npos || note == initial_.doubt ||
             (!wrong_noise_.empty() && note.find("residual is ") != std::string::npos);
    };
    std::erase_if(result.notes, isDistinguished);
  }

  void noteRejected() {
    for (std::size_t k = 0; k < run_.detections.cameras.size(); ++k) {
      for (const double time_s : rejectedTimes_s(run_.detections.cameras[k]))
        run_.result.rejected_windows.push_back({k, time_s});
      if (std::string rejected = rejectedSentence(run_.detections.cameras[k]); !rejected.empty())
        run_.result.notes.push_back(std::move(rejected));
    }
  }

  void conclude() {
    CalibrationResult& result = run_.result;
    if (const std::optional<QualityWarning> unit = wrongUnit(session_, input_, result, context_))
      flagDoubtful(*unit, result);
    returnDetections();
    result.start_ns = run_.detections.start_ns;
    result.freed = freed_;
    noteCornersOfTags();
    for (const QualityWarning& freed : freed_)
      result.notes.push_back(
          fmt::format("{}: therefore, the option {} was set", freed.text, freed.repair->text()));
    noteRejected();
    for (const SessionCamera& camera : session_.cameras)
      if (std::string note = reversalNote(camera); !note.empty()) result.notes.push_back(std::move(note));
    for (const RecordingFault& fault : run_.detections.faults) result.notes.push_back(fault.text);
    result.notes.insert(result.notes.end(), initial_.warnings.begin(), initial_.warnings.end());
    result.notes.insert(result.notes.end(), notes_.begin(), notes_.end());
    Timing& timing = result.timing;
    timing.read_s = run_.detections.read_s;  // of overlapping threads; also for a pass of an earlier run
    timing.detect_s = run_.detections.detect_s;
    timing.total_s = before_s_ + stopwatch_.elapsed_s();
    result.memory_peak_mb = peakMemory_mb();
    setLensSigmas(session_, run_);
    addLensNotes(session_, run_);
    rank();
  }

  const Session& session_;
  const RunContext& context_;
  OptimisationOptions options_;  // those of the session, with the freed parameters
  std::vector<QualityWarning> freed_;
  std::vector<double> corners_outwards_px_;  // by camera: how far tag corners were moved
  std::vector<CameraLens> lenses_;           // used by the front end
  CalibrationRun run_;
  CalibrationInput input_;
  Initialisation initial_;
  const Stopwatch stopwatch_;
  double before_s_ = 0.0;           // time of a pass of an earlier run
  std::string clock_doubt_;         // of a clock step
  std::vector<std::string> notes_;  // of the batch
  std::vector<QualityWarning> wrong_noise_;
  bool recording_is_there_ = false;
  bool mirrored_ = false;  // the error is a MirrorError
  std::vector<std::optional<std::vector<BoardView>>>
      whole_views_;                           // by camera, if views were removed or changed
  std::vector<std::vector<int>> kept_views_;  // by camera: indices in whole_views_, empty if none was removed
};

const std::array<Calibration::StageWork, 4> Calibration::kWork = {
    {{CalibrationStage::Detect, &Calibration::detect},
     {CalibrationStage::Initialise, &Calibration::initialiseState},
     {CalibrationStage::Optimise, &Calibration::optimise},
     {CalibrationStage::CompareHalves, &Calibration::compareHalves}}};

}  // namespace

CalibrationRun CalibrationOutcome::runOrThrow() && {
  if (status == RunStatus::Cancelled) throw Cancelled{};
  if (error) throw CalibrationError(*error);
  return std::move(*run);
}

CalibrationOutcome runCalibration(const Session& session, const RunContext& context) {
  return Calibration(session, context).fromRecording();
}

CalibrationOutcome runCalibration(const Session& session, DetectionResult detections,
                                  const RunContext& context,
                                  std::vector<std::optional<IntrinsicsResult>> intrinsics) {
  return Calibration(session, context).fromDetections(std::move(detections), std::move(intrinsics));
}

InitialisedCalibration initialiseCalibration(const Session& session, DetectionResult detections,
                                             const RunContext& context,
                                             std::vector<std::optional<IntrinsicsResult>> intrinsics) {
  return Calibration(session, context).toInitialState(std::move(detections), std::move(intrinsics));
}

CalibrationRun calibrate(const Session& session, const RunContext& context) {
  return runCalibration(session, context).runOrThrow();
}

CalibrationRun calibrate(const Session& session, DetectionResult detections, const RunContext& context,
                         std::vector<std::optional<IntrinsicsResult>> intrinsics) {
  return runCalibration(session, std::move(detections), context, std::move(intrinsics)).runOrThrow();
}

}  // namespace evical
