#include "core/pipeline/check_calibration.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/pipeline/compared_quantities.h"
#include "core/pipeline/prefixed_progress.h"
#include "core/pipeline/recording_assessment.h"
#include "core/pipeline/result_files.h"
#include "core/report/html/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

std::string wordsOf(const CheckedQuantity& quantity) {
  return fmt::format("the {} of {}", quantity.title, quantity.sensor);
}

// The session as a calibration takes it; that a short recording leaves sigmas large is judged here, not there.
Session freeSession(const CheckInput& input) {
  Session session = input.session;
  session.options.optimisation.judge_sigmas = false;
  session.options.optimisation.camera_intrinsics = CameraIntrinsicsChoice::Free;
  session.options.report.cross_validation = false;
  return session;
}

// As far as numbers go by name: of a run with the same session.
void addTogether(const NamedResult& together, const CheckInput& input,
                 std::vector<CheckedQuantity>& quantities) {
  const ComparedQuantities compared =
      compareQuantities({input.before, together, input.same_board}, input.session.options.check);
  for (CheckedQuantity& quantity : quantities)
    for (const ComparedQuantity& other : compared.quantities) {
      if (other.shown.sensor != quantity.sensor || other.shown.name != quantity.name) continue;
      for (std::size_t k = 0; k < std::min(quantity.numbers.size(), other.shown.numbers.size()); ++k) {
        quantity.numbers[k].together = other.shown.numbers[k].now;
        quantity.numbers[k].together_sigma = other.shown.numbers[k].now_sigma;
      }
    }
}

class Check {
 public:
  Check(const CheckInput& input, const RunContext& context) : input_(input), context_(context) {
    out_.check.notes = input.notes;
    out_.check.false_alarms = input.session.options.check.false_alarms;
    out_.check.before = input.before_name;
    out_.check.recording = input.session.recording.filename().string();
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
      cannotTell(outcome.error->place() + ": " + outcome.error->problem());
      addAdvice(outcome.error->advice());
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
    const CheckOptions& options = session.options.check;
    const ComparedQuantities compared = compareQuantities({input_.before, now, input_.same_board}, options);
    if (compared.quantities.empty())
      throw badInput(session.source.string(), "nothing that this recording tells is in the old result",
                     "Check with a recording of at least two of its sensors");
    const ChangeTests tests = testSingleChanges(compared.change, compared.groups, options.false_alarms);
    std::size_t shown = 0;
    std::vector<std::string> names(compared.groups.size());
    for (std::size_t g = 0; g < compared.groups.size(); ++g) {
      if (!compared.groups[g].tested) continue;
      const ComparedQuantity& quantity = compared.quantities[shown++];
      out_.check.quantities.push_back(testedQuantity(quantity, tests.groups[g], compared.groups[g]));
      names[g] = wordsOf(quantity.shown);
    }
    for (const std::size_t g : tests.or_else) out_.check.or_else.push_back(names[g]);
    for (const std::string& one : compared.not_told)
      out_.check.notes.push_back(one + " is not checked: it is given, or the recording does not tell it");
    solveTogether(session);
  }

  // What is known after both; a check of its own that the old result and the recording fit it is not.
  void solveTogether(const Session& session) {
    const Session weighed = withPriorOf(input_.before, session);
    RecordingPass pass = out_.run->pass;
    for (std::size_t k = 0; k < pass.lenses.size(); ++k)
      pass.lenses[k] = givenLens(pass.lenses[k].seen_with, weighed.cameras[k].intrinsics_uncertainty);
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
    addTogether(namedResult(weighed, result, {}), input_, out_.check.quantities);
  }

  void judge() {
    const CalibrationResult& result = out_.run->result;
    // What is wrong with the data may look like a change, and may hide one.
    if (result.status != CalibrationStatus::Ok) {
      cannotTell("the new recording is not to be relied on: " + result.reason);
      addAdvice("Mend what is said of the recording, and record again");
      return;
    }
    std::vector<std::string> changed, open;
    for (const CheckedQuantity& quantity : out_.check.quantities) {
      if (quantity.changed) changed.push_back(changeText(quantity));
      if (!quantity.toldEnough()) open.push_back(openText(quantity));
    }
    if (!changed.empty()) {
      out_.check.verdict = CheckVerdict::Changed;
      out_.check.reason = joined(changed) + " changed";
      if (!out_.check.or_else.empty())
        out_.check.reason +=
            fmt::format(" (or {}: the recording does not tell which)", joined(out_.check.or_else));
      addAdvice("Calibrate again, and look for what is loose");
    } else if (open.empty()) {
      out_.check.verdict = CheckVerdict::StillGood;
      out_.check.reason = "nothing has changed, and a change that matters would have shown";
    } else {
      cannotTell("nothing is seen to have changed, but this recording would not have shown " + joined(open));
      advise({out_.run->pass, out_.run->intrinsics});
    }
  }

  static std::string changeText(const CheckedQuantity& quantity) {
    std::string text = fmt::format("{} by {} {} ({:.1f} sigmas)", wordsOf(quantity),
                                   html::significant(quantity.change, 2), quantity.unit, quantity.sigmas);
    return text;
  }

  static std::string openText(const CheckedQuantity& quantity) {
    return fmt::format("a change of {} below {} {} ({} matters)", wordsOf(quantity),
                       html::significant(quantity.would_notice, 2), quantity.unit,
                       html::plain(quantity.matters));
  }

  void cannotTell(const std::string& reason) {
    out_.check.verdict = CheckVerdict::CannotTell;
    out_.check.reason = reason;
  }

  void addAdvice(const std::string& advice) {
    if (advice.empty()) return;
    const std::string sentence = advice.ends_with('.') ? advice : advice + ".";
    std::vector<std::string>& all = out_.check.advice;
    if (std::find(all.begin(), all.end(), sentence) == all.end()) all.push_back(sentence);
  }

  // As a recording is assessed before it is calibrated.
  void advise(const DetectedRecording& detected) {
    if (detected.pass.cameras.empty()) return;
    try {
      for (const Assessed& one : assessRecording(input_.session, detected, context_.unobserved()).all)
        addAdvice(one.advice);
    } catch (const CalibrationError&) {
      // Which is said already.
    }
    if (out_.check.advice.empty())
      addAdvice("Record for longer: twice the time makes sigmas 1.4 times smaller");
  }

  const CheckInput& input_;
  const RunContext& context_;
  CheckRun out_;
};

}  // namespace

CheckRun checkCalibration(const CheckInput& input, const RunContext& context) {
  return Check(input, context).run([&](const Session& session) { return runCalibration(session, context); });
}

CheckRun checkCalibration(const CheckInput& input, RecordingPass pass, const RunContext& context) {
  return Check(input, context).run([&](const Session& session) {
    return runCalibration(session, std::move(pass), context);
  });
}

}  // namespace evical
