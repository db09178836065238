#include "core/pipeline/check/check_calibration.h"

#include "core/base/error.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/check/check_verdict.h"
#include "core/pipeline/check/check_without_board.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/rig/prefixed_progress.h"
#include "core/pipeline/rig/recording_assessment.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/session/calibration_options.h"
#include "core/report/report_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {
namespace {

// Session for the calibration without a prior; the check judges large sigmas itself.
Session freeSession(const CheckInput& input) {
  Session session = input.session;
  session.options.optimisation.edit().judge_sigmas = false;
  session.options.optimisation.edit().camera_intrinsics = CameraIntrinsicsChoice::Free;
  session.options.report.edit().split_half_check = false;
  return session;
}

// Visibility of the board in the windows and frames of all cameras.
struct BoardSeen {
  std::size_t windows = 0, with_board = 0;

  bool isRare(double min_share) const {
    return windows > 0 && static_cast<double>(with_board) < min_share * static_cast<double>(windows);
  }
};

BoardSeen boardSeen(const DetectionResult& detections) {
  BoardSeen seen;
  for (const BoardObservations& camera : detections.cameras) {
    seen.windows += camera.windows.size();
    seen.with_board += camera.views.size();
  }
  return seen;
}

// Adds the numbers of the joint solution to the findings, by name.
void addJoint(const NamedResult& together, const CheckInput& input, std::vector<Finding>& findings) {
  const ComparedQuantities compared =
      compareQuantities({input.before, together, input.same_board}, *input.session.options.check);
  for (Finding& finding : findings)
    for (const ComparedQuantity& other : compared.quantities) {
      if (other.shown.sensor != finding.sensor || other.shown.quantity != finding.quantity) continue;
      for (std::size_t k = 0; k < std::min(finding.numbers.size(), other.shown.numbers.size()); ++k)
        finding.numbers[k].joint = other.shown.numbers[k].now;
    }
}

class Check {
 public:
  Check(const CheckInput& input, const RunContext& context) : input_(input), context_(context) {
    out_.check.notes = input.notes;
    out_.check.false_alarms = input.session.options.check->false_alarms;
    out_.check.before = input.before_name;
    out_.check.inputs = {input.session.recording.filename().string()};
  }

  // `calibrate`: runs the calibration without a prior, with the given session.
  template <class Calibrate>
  CheckRun run(const Calibrate& calibrate) {
    const Session session = freeSession(input_);
    CalibrationOutcome outcome = calibrate(session);
    if (outcome.status == RunStatus::Cancelled) throw Cancelled{};
    if (outcome.error) {
      if (outcome.error->kind() == ErrorKind::BadInput) throw CalibrationError(*outcome.error);
      out_.detections = std::move(outcome.detections);
      setCannotTell(outcome.error->place() + ": " + outcome.error->problem(), out_.check);
      addAdvice(outcome.error->advice(), out_.check);
      advise({out_.detections, {}});
      return std::move(out_);
    }
    out_.run = std::make_shared<const CalibrationRun>(std::move(*outcome.run));
    compare(session);
    judge();
    return std::move(out_);
  }

 private:
  void compare(const Session& session) {
    const NamedResult now = namedRun(session, out_.run, {});
    const CheckOptions& options = *session.options.check;
    const ComparedQuantities compared = compareQuantities({input_.before, now, input_.same_board}, options);
    if (compared.quantities.empty())
      throw badInput(session.source.string(),
                     "the old result has none of the quantities that this recording determines",
                     "Check with a recording of at least two of its sensors");
    testQuantities(compared, options, out_.check);
    for (const std::string& one : compared.not_told)
      out_.check.notes.push_back(one +
                                 " is not checked: it is given, or the recording does not determine it");
    solveTogether(session);
  }

  // A copy of the old recording has its start, and the same noise.
  bool isCopy() const {
    const std::vector<Finding>& findings = out_.check.findings;
    return out_.run->result.start_ns == input_.before.result->start_ns && !findings.empty() &&
           std::ranges::all_of(findings, [&](const Finding& finding) {
             return finding.sigmas < input_.session.options.check->copy_sigmas;
           });
  }

  // Joint solution of the old result and the recording. It is not a separate test that both agree.
  void solveTogether(const Session& session) {
    const Session weighed = withPriorOf(input_.before, session);
    DetectionResult detections = out_.run->detections;
    for (std::size_t k = 0; k < detections.lenses.size(); ++k)
      detections.lenses[k] =
          givenLens(detections.lenses[k].detection_intrinsics, weighed.cameras[k].intrinsics_uncertainty);
    PrefixedProgress progress(context_.progress, kTogetherPart);
    const CalibrationOutcome outcome = runCalibration(weighed, std::move(detections),
                                                      RunContext{progress, context_.stop, context_.observer});
    if (outcome.status == RunStatus::Cancelled) throw Cancelled{};
    if (!outcome.run) {
      out_.check.notes.push_back("the calibration with the old result as prior failed: " +
                                 std::string(outcome.error->what()));
      return;
    }
    const auto result = std::make_shared<const CalibrationResult>(outcome.run->result);
    addJoint(namedResult(weighed, result, {}), input_, out_.check.findings);
  }

  void judge() {
    const CalibrationResult& result = out_.run->result;
    // Faults of the data can look like a change, or hide one.
    if (result.status != CalibrationStatus::Ok) {
      setCannotTell("the new recording is not reliable: " + result.reason, out_.check);
      addAdvice("Fix the problem reported above and record again", out_.check);
      return;
    }
    judgeFindings(out_.check);
    if (input_.duplicate || isCopy()) return judgeDuplicate(out_.check);
    if (out_.check.verdict == Verdict::CannotTell) advise({out_.run->detections, out_.run->intrinsics});
  }

  // Advice from the assessment of the recording.
  void advise(const DetectedRecording& detected) {
    if (detected.detections.cameras.empty()) return;
    try {
      for (const Assessed& one : assessRecording(input_.session, detected, context_.unobserved()).all)
        addAdvice(one.advice, out_.check);
    } catch (const CalibrationError&) {
      // Already reported.
    }
    if (out_.check.advice.empty())
      addAdvice("Record for longer: doubling the time makes sigmas 1.4 times smaller", out_.check);
  }

  const CheckInput& input_;
  const RunContext& context_;
  CheckRun out_;
};

}  // namespace

CheckRun checkCalibration(const CheckInput& input, const RunContext& context) {
  if (input.session.options.check->no_board) return checkWithoutBoard(input, context);
  CheckRun checked =
      Check(input, context).run([&](const Session& session) { return runCalibration(session, context); });
  const BoardSeen seen = boardSeen(checked.run ? checked.run->detections : checked.detections);
  if (input.session.board_blinks || !seen.isRare(input.session.options.check->min_board_share))
    return checked;
  CheckRun without = checkWithoutBoard(input, context);
  without.check.notes.push_back(fmt::format(
      "the board was found in only {} of {} event windows or frames, so the check does not use it",
      seen.with_board, seen.windows));
  return without;
}

CheckRun checkCalibration(const CheckInput& input, DetectionResult detections, const RunContext& context) {
  return Check(input, context).run([&](const Session& session) {
    return runCalibration(session, std::move(detections), context);
  });
}

}  // namespace evical
