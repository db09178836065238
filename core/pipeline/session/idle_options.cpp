#include "core/pipeline/session/idle_options.h"

#include "core/frontend/detection_options.h"
#include "core/optimisation/optimisation_options.h"

#include <algorithm>

namespace evical {
namespace {

bool hasBoard(const Session& session, BoardType type) {
  return session.board.type == type ||
         std::any_of(session.further_boards.begin(), session.further_boards.end(),
                     [type](const auto& further) { return further.board.type == type; });
}

bool everyLensIsGiven(const Session& session) {
  return !session.cameras.empty() &&
         std::all_of(session.cameras.begin(), session.cameras.end(),
                     [](const SessionCamera& camera) { return camera.intrinsics.has_value(); });
}

// Reason if no camera has this type; empty if one has it, or may have it.
std::string without(StreamType type, const Session& session, const StreamTypes& types) {
  if (session.cameras.empty()) return {};
  for (const SessionCamera& camera : session.cameras) {
    const auto found = types.find(camera.stream);
    if (found == types.end() || found->second == type) return {};
  }
  return type == StreamType::Frames ? "no camera records frames" : "no camera records events";
}

std::string where(bool idle, const char* reason) {
  return idle ? reason : "";
}

std::string whereOfImus(const Session& session, bool idle, const char* reason) {
  return session.imus.empty() ? "there is no IMU" : where(idle, reason);
}

// Why the options of a source of candidates have no effect: it is unused, or only used if the other one
// fails.
std::string withoutCandidates(CandidateSource source, const Session& session, const StreamTypes& types,
                              const char* alone, const char* fallback) {
  const DetectionOptions& detection = session.options.front_end->detection;
  if (std::string reason = without(StreamType::Events, session, types); !reason.empty()) return reason;
  return where(detection.method != source, detection.try_both ? fallback : alone);
}

std::string whyNot(Applies applies, const Session& session, const StreamTypes& types) {
  const OptimisationOptions& optimisation = *session.options.optimisation;
  switch (applies) {
    case Applies::Always:
      return {};
    case Applies::WithImu:
      return whereOfImus(session, false, "");
    case Applies::WithoutImu:
      return where(!session.imus.empty(), "there is an IMU");
    case Applies::WithEvents:
      return without(StreamType::Events, session, types);
    case Applies::WithFrames:  // and images of flashes
      return session.board_blinks ? "" : without(StreamType::Frames, session, types);
    case Applies::WithRingVotes:
      return withoutCandidates(CandidateSource::RingVote, session, types,
                               "circles are detected only by normal flow",
                               "ring votes are used only if normal flow does not find the board");
    case Applies::WithNormalFlow:
      return withoutCandidates(CandidateSource::NormalFlow, session, types,
                               "circles are detected only by ring votes",
                               "normal flow is used only if ring votes do not find the board");
    case Applies::WithAprilGrid:
      return where(!hasBoard(session, BoardType::AprilGrid), "no board is an AprilGrid");
    case Applies::WithCharuco:
      return where(!hasBoard(session, BoardType::Charuco), "no board is a ChArUco board");
    case Applies::WithBlinkingBoard:
      return where(!session.board_blinks, "the session's board does not blink");
    case Applies::WithUnknownLens:
      return where(everyLensIsGiven(session), "every camera's lens is given");
    case Applies::WithFreeGyroscopeTurns:
      return whereOfImus(session, optimisation.gyroscope_rotation == Estimated::No,
                         "gyroscope misalignments are not estimated");
    case Applies::WithFreeGravityNorm:
      return whereOfImus(session, !optimisation.free_gravity_norm, "gravity's norm is not estimated");
    case Applies::WithLinearBiases:
      return whereOfImus(session, optimisation.bias_model == BiasModel::Constant, "biases are constant");
    case Applies::InCheck:
      return "only a check of an earlier result uses it";
    case Applies::InCheckWithoutBoard:
      return "only a check without a board uses it";
    case Applies::InMaintain:
      return "only the maintenance of IMU logs uses it";
  }
  return {};
}

}  // namespace

std::string whyIdle(const Session& session, const OptionRow& option, const StreamTypes& types) {
  for (const Applies applies : option.applies)
    if (std::string reason = whyNot(applies, session, types); !reason.empty()) return reason;
  return {};
}

}  // namespace evical
