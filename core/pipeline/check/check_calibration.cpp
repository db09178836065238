#include "core/pipeline/check/check_calibration.h"

#include "core/base/error.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/check/check_verdict.h"
#include "core/pipeline/check/check_without_board.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/rig/prefixed_progress.h"
#include "core/pipeline/rig/recording_assessment.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/session/check_options.h"
#include "core/report/report_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {
namespace {

// The session as a calibration takes it; that a short recording leaves sigmas large is judged here, not there.
Session freeSession(const CheckInput& input) {
  Session session = input.session;
  session.options.optimisation.edit().judge_sigmas = false;
  session.options.optimisation.edit().camera_intrinsics = CameraIntrinsicsChoice::Free;
  session.options.report.edit().split_half_check = false;
  return session;
}

// In how many of the windows and frames of all cameras.
struct BoardSeen {
  std::size_t windows = 0, with_board = 0;

  bool isRare(double least_share) const {
    return windows > 0 && static_cast<double>(with_board) < least_share * static_cast<double>(windows);
  }
};

BoardSeen boardSeen(const DetectionResult& pass) {
  BoardSeen seen;
  for (const BoardObservations& camera : pass.cameras) {
    seen.windows += camera.windows.size();
    seen.with_board += camera.views.size();
  }
  return seen;
}

// As far as numbers go by name: of a run with the same session.
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

  // `calibrate`: the free run, of the session it is given.
  template <class Calibrate>
  CheckRun run(const Calibrate& calibrate) {
    const Session session = freeSession(input_);
    CalibrationOutcome outcome = calibrate(session);
    if (outcome.status == RunStatus::Cancelled) throw Cancelled{};
    if (outcome.error) {
      if (outcome.error->kind() == ErrorKind::BadInput) throw CalibrationError(*outcome.error);
      out_.pass = std::move(outcome.pass);
      setCannotTell(outcome.error->place() + ": " + outcome.error->problem(), out_.check);
      addAdvice(outcome.error->advice(), out_.check);
      advise({out_.pass, {}});
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
      throw badInput(session.source.string(), "nothing that this recording tells is in the old result",
                     "Check with a recording of at least two of its sensors");
    testQuantities(compared, options, out_.check);
    for (const std::string& one : compared.not_told)
      out_.check.notes.push_back(one + " is not checked: it is given, or the recording does not tell it");
    solveTogether(session);
  }

  // What is known after both; a check of its own that the old result and the recording fit it is not.
  void solveTogether(const Session& session) {
    const Session weighed = withPriorOf(input_.before, session);
    DetectionResult pass = out_.run->pass;
    for (std::size_t k = 0; k < pass.lenses.size(); ++k)
      pass.lenses[k] =
          givenLens(pass.lenses[k].detection_intrinsics, weighed.cameras[k].intrinsics_uncertainty);
    PrefixedProgress progress(context_.progress, kTogetherPart);
    const CalibrationOutcome outcome =
        runCalibration(weighed, std::move(pass), RunContext{progress, context_.stop, context_.observer});
    if (outcome.status == RunStatus::Cancelled) throw Cancelled{};
    if (!outcome.run) {
      out_.check.notes.push_back("with the old result as prior there is no solution: " +
                                 std::string(outcome.error->what()));
      return;
    }
    const auto result = std::make_shared<const CalibrationResult>(outcome.run->result);
    addJoint(namedResult(weighed, result, {}), input_, out_.check.findings);
  }

  void judge() {
    const CalibrationResult& result = out_.run->result;
    // What is wrong with the data may look like a change, and may hide one.
    if (result.status != CalibrationStatus::Ok) {
      setCannotTell("the new recording is not to be relied on: " + result.reason, out_.check);
      addAdvice("Mend what is said of the recording, and record again", out_.check);
      return;
    }
    judgeFindings(out_.check);
    if (out_.check.verdict == Verdict::CannotTell) advise({out_.run->pass, out_.run->intrinsics});
  }

  // As a recording is assessed before it is calibrated.
  void advise(const DetectedRecording& detected) {
    if (detected.pass.cameras.empty()) return;
    try {
      for (const Assessed& one : assessRecording(input_.session, detected, context_.unobserved()).all)
        addAdvice(one.advice, out_.check);
    } catch (const CalibrationError&) {
      // Which is said already.
    }
    if (out_.check.advice.empty())
      addAdvice("Record for longer: twice the time makes sigmas 1.4 times smaller", out_.check);
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
  const BoardSeen seen = boardSeen(checked.run ? checked.run->pass : checked.pass);
  if (input.session.board_blinks || !seen.isRare(input.session.options.check->least_board_share))
    return checked;
  CheckRun without = checkWithoutBoard(input, context);
  without.check.notes.push_back(fmt::format(
      "the board was found in {} of {} windows, so it is taken as not there", seen.with_board, seen.windows));
  return without;
}

CheckRun checkCalibration(const CheckInput& input, DetectionResult pass, const RunContext& context) {
  return Check(input, context).run([&](const Session& session) {
    return runCalibration(session, std::move(pass), context);
  });
}

}  // namespace evical
