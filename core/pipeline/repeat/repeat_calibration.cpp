#include "core/pipeline/repeat/repeat_calibration.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/quality_warning.h"
#include "core/numerics/angles.h"
#include "core/numerics/chi_squared.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/compare/repeated_estimates.h"
#include "core/pipeline/rig/prefixed_progress.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/session/calibration_options.h"
#include "core/report/html/html_text.h"
#include "core/report/report_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kFewest = 2;

struct One {
  std::size_t recording;
  Session session;
  NamedResult named;
  Eigen::MatrixXd as_weighed;
};

// True if results are identical to the last bit, as for a copy of a recording.
bool sameData(const CalibrationResult& a, const CalibrationResult& b) {
  // Skip a reference camera, whose pose is the same in all recordings.
  const auto same = [](const CameraState& left, const CameraState& right) {
    return left.reference_from_camera.translation_m == right.reference_from_camera.translation_m &&
           left.time_offset_s == right.time_offset_s;
  };
  return a.start_ns == b.start_ns && std::ranges::equal(a.state.cameras, b.state.cameras, same);
}

// Result without residuals and similar data, which need most of the memory.
std::shared_ptr<const CalibrationResult> withoutCurves(const CalibrationResult& result) {
  auto kept = std::make_shared<CalibrationResult>(result);
  kept->circle_residuals.clear();
  kept->iterations.clear();
  return kept;
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string changeOfSensorText(const Finding& finding) {
  return fmt::format("{} of {} by {} {} ({:.1f} sigmas)", finding.title, finding.sensor,
                     html::significant(finding.change, 2), finding.unit, finding.sigmas);
}

class Repeat {
 public:
  Repeat(const RepeatInput& input, const RunContext& context) : input_(input), context_(context) {
    out().false_alarms = options().false_alarms;
    for (std::size_t k = 0; k < input.sessions.size(); ++k) {
      RepeatedRecording& recording = out().recordings.emplace_back();
      recording.name = input.names[k];
      recording.file = input.sessions[k].recording.string();
    }
  }

  RepeatRun run(const CalibrateOne& calibrate, const RecordingDone& done) {
    for (std::size_t k = 0; k < input_.sessions.size(); ++k) calibrateOne(k, calibrate, done);
    context_.throwIfStopped();
    if (ones_.size() < kFewest)
      fail();
    else
      compare();
    out().took_s = stopwatch_.elapsed_s();
    return std::move(run_);
  }

 private:
  using Chosen = std::vector<std::size_t>;  // indices into ones_

  Repeatability& out() { return run_.repeatability; }
  const CheckOptions& options() const { return *input_.sessions.front().options.check; }
  RepeatedRecording& recordingOf(std::size_t one) { return out().recordings[ones_[one].recording]; }

  void calibrateOne(std::size_t k, const CalibrateOne& calibrate, const RecordingDone& done) {
    RepeatedRecording& recording = out().recordings[k];
    PrefixedProgress progress(context_.progress, partOfRepeat(input_, k));
    const Session session = sessionOfRepeat(input_.sessions[k]);
    CalibrationOutcome outcome = calibrate(k, session, RunContext{progress, context_.stop});
    if (outcome.status == RunStatus::Cancelled) throw Cancelled{};
    if (outcome.error) return failOne(outcome.error->what(), recording);
    const auto run = std::make_shared<const CalibrationRun>(std::move(*outcome.run));
    for (const One& before : ones_)
      if (sameData(*before.named.result, run->result))
        return failOne(fmt::format("duplicates {}: it adds no information", input_.names[before.recording]),
                       recording);
    if (const std::string other = otherLens(run->result); !other.empty()) return failOne(other, recording);
    recording.status = run->result.status;
    recording.reason = run->result.reason;
    if (done) done(k, session, run);
    NamedResult named = namedRun(session, run, {});
    named.result = withoutCurves(run->result);
    ones_.push_back({k, session, std::move(named), run->as_weighed});
  }

  // Lens models that were selected from each recording may differ: then their parameters are not comparable.
  std::string otherLens(const CalibrationResult& result) const {
    if (ones_.empty()) return {};
    const CalibrationState& first = ones_.front().named.result->state;
    for (std::size_t k = 0; k < first.cameras.size() && k < result.state.cameras.size(); ++k) {
      const std::optional<CameraIntrinsics>&own = result.state.cameras[k].lens.inUse(),
            &other = first.cameras[k].lens.inUse();
      if (!own || !other || own->model == other->model) continue;
      return fmt::format(
          "its lens model of camera {} is {}, but that of {} is {}, so they cannot be combined: set "
          "intrinsics.model in all sessions",
          ones_.front().session.cameras[k].name, cameraModelTitle(own->model),
          input_.names[ones_.front().recording], cameraModelTitle(other->model));
    }
    return {};
  }

  void failOne(const std::string& reason, RepeatedRecording& recording) {
    recording.outcome = RepeatOutcome::Failed;
    recording.status = CalibrationStatus::Failed;
    recording.reason = reason;
    context_.progress.log(LogLevel::Warning, recording.name + ": " + reason);
  }

  void fail() {
    std::string reason = fmt::format("{} of {} recordings could be calibrated, at least {} are required",
                                     ones_.size(), out().recordings.size(), kFewest);
    for (const RepeatedRecording& each : out().recordings)
      if (each.outcome == RepeatOutcome::Failed) reason += fmt::format("; {}: {}", each.name, each.reason);
    out().reason = reason;
    out().advice.emplace_back("Fix the problems of the failed recordings, and record again");
  }

  void compare() {
    context_.progress.stageStarted(kComparingStage);
    std::vector<RecordedEstimate> recorded;
    for (const One& one : ones_) {
      recorded.push_back({one.named.result, one.as_weighed, cameraKinds(one.named)});
      out().columns.push_back(input_.names[one.recording]);
    }
    estimates_.emplace(ones_.front().session, std::move(recorded));
    for (std::size_t k = 0; k < ones_.size(); ++k) fitting_.push_back(k);
    while (fitting_.size() > kFewest) {
      const std::size_t worst = worstOf(fitting_);
      if (!isFar(estimates_->distance(worst, others(worst)))) break;
      fitting_.erase(std::find(fitting_.begin(), fitting_.end(), worst));
    }
    for (std::size_t k = 0; k < ones_.size(); ++k) judgeOne(k);
    out().quantities = estimates_->quantities(fitting_);
    fillRatio();
    solveTogether();
    judge();
    context_.progress.stageProgress(1.0);
  }

  Chosen others(std::size_t one) const {
    Chosen rest = fitting_;
    std::erase(rest, one);
    return rest;
  }

  std::size_t worstOf(const Chosen& chosen) const {
    const auto excess = [&](std::size_t k) {
      const EstimateDistance distance = estimates_->distance(k, others(k));
      return (distance.chi_square - distance.freedom) / std::sqrt(std::max(1.0, 2.0 * distance.freedom));
    };
    return *std::max_element(chosen.begin(), chosen.end(),
                             [&](std::size_t a, std::size_t b) { return excess(a) < excess(b); });
  }

  // Probability of a false alarm per recording, since each recording is tested.
  double falseAlarms() const { return options().false_alarms / static_cast<double>(ones_.size()); }
  bool isFar(const EstimateDistance& distance) const { return probabilityBeyond(distance) < falseAlarms(); }

  void judgeOne(std::size_t k) {
    const Chosen rest = others(k);
    RepeatedRecording& recording = recordingOf(k);
    const EstimateDistance distance = estimates_->distance(k, rest);
    recording.chi_square = distance.chi_square;
    recording.freedom = distance.freedom;
    if (distance.freedom > 0) recording.limit = chiSquaredLimit(falseAlarms(), distance.freedom);
    if (!isFar(distance)) return;
    recording.outcome = RepeatOutcome::DoesNotFit;
    recording.findings = differences(k, rest);
  }

  // Findings of a check of one recording against the others.
  std::vector<Finding> differences(std::size_t k, const Chosen& rest) const {
    const NamedResult before = namedJoint(rest);
    ComparedQuantities compared = compareQuantities({before, ones_[k].named, true}, options());
    leaveOffsetsOut(compared);
    const GroupTestResults tests = testSingleChanges(compared.change, compared.groups, falseAlarms());
    std::vector<Finding> all;
    for (std::size_t g = 0, shown = 0; g < compared.groups.size(); ++g)
      if (compared.groups[g].tested)
        all.push_back(testedQuantity(compared.quantities[shown++], tests.groups[g], compared.groups[g]));
    std::stable_sort(all.begin(), all.end(), [](const Finding& a, const Finding& b) {
      return a.sigmas / a.limit_sigmas > b.sigmas / b.limit_sigmas;
    });
    // If no single quantity explains it: the one that comes closest.
    const auto end =
        std::stable_partition(all.begin(), all.end(), [](const auto& each) { return each.changed; });
    if (!all.empty()) all.erase(std::max(end, all.begin() + 1), all.end());
    return all;
  }

  // Time offsets are separate for each recording.
  static void leaveOffsetsOut(ComparedQuantities& compared) {
    ComparedQuantities kept;
    std::vector<Eigen::Index> numbers;
    for (std::size_t g = 0, shown = 0; g < compared.groups.size(); ++g) {
      ChangeGroup group = compared.groups[g];
      const bool is_offset = group.tested && compared.quantities[shown].shown.id == QuantityId::TimeOffset;
      if (group.tested && !is_offset) kept.quantities.push_back(compared.quantities[shown]);
      if (group.tested) ++shown;
      if (is_offset) continue;
      const Eigen::Index first = group.first;
      group.first = static_cast<Eigen::Index>(numbers.size());
      for (Eigen::Index i = 0; i < group.size; ++i) numbers.push_back(first + i);
      kept.groups.push_back(std::move(group));
    }
    kept.change.difference = compared.change.difference(numbers);
    kept.change.covariance = compared.change.covariance(numbers, numbers);
    compared = std::move(kept);
  }

  NamedResult namedJoint(const Chosen& chosen) const {
    NamedResult named = ones_[chosen.back()].named;
    named.result = std::make_shared<const CalibrationResult>(estimates_->joint(chosen));
    return named;
  }

  void fillRatio() {
    double squares = 0.0;
    int count = 0;
    for (const RepeatedQuantity& quantity : out().quantities)
      for (const RepeatedNumber& number : quantity.numbers)
        if (number.count > 1 && number.mean_sigma > 0.0) {
          squares += number.ratio() * number.ratio();
          ++count;
        }
    if (count > 0) out().rms_ratio = std::sqrt(squares / count);
  }

  void solveTogether() {
    run_.own_values_of = ones_[fitting_.back()].recording;
    out().own_values_of = input_.names[run_.own_values_of];
    NamedResult named = namedJoint(fitting_);
    auto result = std::make_shared<CalibrationResult>(*named.result);
    std::vector<std::string> names;
    for (const std::size_t k : fitting_) names.push_back(input_.names[ones_[k].recording]);
    result->notes.push_back("solution of " + std::to_string(names.size()) +
                            " recordings together: " + listed(names));
    result->notes.push_back(
        "biases, gravity and time offsets are separate for each recording: those of this result are from " +
        out().own_values_of);
    for (const std::size_t k : fitting_)
      if (const RepeatedRecording& one = recordingOf(k); one.status == CalibrationStatus::Doubtful)
        flagDoubtful(one.name + ": " + one.reason, *result);
    flagDoubtful(sigmaDoubt(*result), *result);
    named.result = std::move(result);
    run_.joint = std::move(named);
  }

  // Reason for doubt if the joint result does not meet the required sigmas.
  std::string sigmaDoubt(const CalibrationResult& result) const {
    const OptimisationOptions& needs = *input_.sessions.front().options.optimisation;
    const auto doubt = [](const std::string& what, double sigma, double needed, const char* unit) {
      return sigma > needed ? fmt::format("the sigma of {} is {} {}, but {} {} is required", what,
                                          html::significant(sigma, 2), unit, html::plain(needed), unit)
                            : std::string();
    };
    for (std::size_t k = 0; k < result.uncertainty.cameras.size(); ++k) {
      const CameraUncertainty& camera = result.uncertainty.cameras[k];
      const std::string name = " of " + input_.sessions.front().cameras[k].name;
      for (std::string text :
           {doubt("rotation" + name, kDegPerRad * camera.rotation_std_rad.maxCoeff(),
                  needs.needed_rotation_deg, "deg"),
            doubt("translation" + name, 1e3 * camera.translation_std_m.maxCoeff(),
                  needs.needed_translation_mm, "mm"),
            doubt("time offset" + name, 1e3 * camera.time_offset_std_s, needs.needed_time_offset_ms, "ms")})
        if (!text.empty()) return text;
    }
    return {};
  }

  void judge() {
    std::vector<std::string> far, failed;
    for (const RepeatedRecording& each : out().recordings) {
      if (each.outcome == RepeatOutcome::Failed) failed.push_back(each.name);
      if (each.outcome == RepeatOutcome::DoesNotFit)
        far.push_back(each.findings.empty()
                          ? each.name
                          : fmt::format("{}: {}", each.name, changeOfSensorText(each.findings.front())));
    }
    out().verdict = far.empty() ? Verdict::Unchanged : Verdict::Changed;
    if (far.empty())
      out().reason = fmt::format("{} recordings agree", fitting_.size());
    else if (fitting_.size() <= kFewest && ones_.size() == kFewest)
      out().reason = "the two recordings disagree, and a third one is needed to decide which is correct: " +
                     changeOfFirst();
    else
      out().reason = fmt::format("{} of {} recordings do not fit the others: {}", far.size(), ones_.size(),
                                 fmt::join(far, "; "));
    if (!failed.empty())
      out().notes.push_back(fmt::format("{} of {} recordings could not be calibrated: {}", failed.size(),
                                        out().recordings.size(), listed(failed)));
    if (run_.joint && out().verdict == Verdict::Changed &&
        recordingOf(fitting_.front()).outcome != RepeatOutcome::Fits) {
      auto doubtful = std::make_shared<CalibrationResult>(*run_.joint->result);
      flagDoubtful(out().reason, *doubtful);
      run_.joint->result = std::move(doubtful);
    }
  }

  std::string changeOfFirst() {
    const std::vector<Finding>& findings = recordingOf(fitting_.front()).findings;
    return findings.empty() ? "all quantities together" : changeOfSensorText(findings.front());
  }

  const RepeatInput& input_;
  const RunContext& context_;
  const Stopwatch stopwatch_;
  RepeatRun run_;
  std::vector<One> ones_;  // successful calibrations
  std::optional<RepeatedEstimates> estimates_;
  Chosen fitting_;
};

}  // namespace

std::string partOfRepeat(const RepeatInput& input, std::size_t recording) {
  return fmt::format("{} ({} of {})", input.names.at(recording), recording + 1, input.sessions.size());
}

Session sessionOfRepeat(Session session) {
  session.options.optimisation.edit().judge_sigmas = false;
  session.options.report.edit().split_half_check = false;
  return session;
}

RepeatRun repeatCalibration(const RepeatInput& input, const CalibrateOne& calibrate,
                            const RecordingDone& done, const RunContext& context) {
  return Repeat(input, context).run(calibrate, done);
}

RepeatRun repeatCalibration(const RepeatInput& input, const RecordingDone& done, const RunContext& context) {
  return repeatCalibration(
      input,
      [](std::size_t, const Session& session, const RunContext& one) { return runCalibration(session, one); },
      done, context);
}

}  // namespace evical
