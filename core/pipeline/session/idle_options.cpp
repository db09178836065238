#include "core/pipeline/session/idle_options.h"

#include <algorithm>
#include <array>
#include <string_view>

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

const DetectionOptions& detection(const Session& session) {
  return session.options.front_end.detection;
}

const OptimisationOptions& optimisation(const Session& session) {
  return session.options.optimisation;
}

bool onlyBy(const Session& session, CandidateSource source) {
  return detection(session).method == source && !detection(session).try_both;
}

struct Rule {
  std::string_view part;  // of the option's name
  bool (*holds)(const Session& session);
  const char* reason;
};

// The first that fits is said.
constexpr std::array kRules = {
    Rule{"ring_vote.", [](const Session& s) { return onlyBy(s, CandidateSource::NormalFlow); },
         "circles are looked for by normal flow alone"},
    Rule{"ring_vote.", [](const Session& s) { return detection(s).method == CandidateSource::NormalFlow; },
         "ring votes are used only where normal flow finds no board"},
    Rule{"normal_flow.", [](const Session& s) { return onlyBy(s, CandidateSource::RingVote); },
         "circles are looked for by ring votes alone"},
    Rule{"normal_flow.", [](const Session& s) { return detection(s).method == CandidateSource::RingVote; },
         "normal flow is used only where ring votes find no board"},
    Rule{"check.", [](const Session&) { return true; }, "only a check of an earlier result takes it"},
    Rule{"maintain.", [](const Session&) { return true; }, "only a look at logs of IMUs takes it"},
    Rule{"egomotion.", [](const Session&) { return true; }, "only a check without a board uses it"},
    Rule{"edge_slopes.", [](const Session&) { return true; }, "only a check without a board uses it"},
    Rule{"blink.", [](const Session& s) { return !s.board_blinks; },
         "the board does not blink, as far as the session says"},
    Rule{"intrinsics.", everyLensIsGiven, "every camera's lens is given"},
    Rule{"frames.tag_border", [](const Session& s) { return !hasBoard(s, BoardType::AprilGrid); },
         "no board is an AprilGrid"},
    Rule{"frames.markers", [](const Session& s) { return !hasBoard(s, BoardType::Charuco); },
         "no board is a ChArUco board"},
    Rule{"priors.smooth_", [](const Session& s) { return !s.imus.empty(); },
         "an IMU tells how smooth the motion is"},
    Rule{"gyroscope_rotation_sigma", [](const Session& s) { return !optimisation(s).gyroscope_rotation; },
         "turns of gyroscopes are not estimated"},
    Rule{"gravity_norm_sigma", [](const Session& s) { return !optimisation(s).free_gravity_norm; },
         "gravity's norm is not estimated"},
    Rule{"_random_walk", [](const Session& s) { return optimisation(s).bias_model != BiasModel::Linear; },
         "biases are constant"},
    Rule{"gyroscope", [](const Session& s) { return s.imus.empty(); }, "there is no IMU"},
    Rule{"acceler", [](const Session& s) { return s.imus.empty(); }, "there is no IMU"},
    Rule{"gravity", [](const Session& s) { return s.imus.empty(); }, "there is no IMU"},
    Rule{"imu_", [](const Session& s) { return s.imus.empty(); }, "there is no IMU"},
};

}  // namespace

std::string whyIdle(const Session& session, const std::string& option) {
  for (const Rule& rule : kRules)
    if (option.find(rule.part) != std::string::npos && rule.holds(session)) return rule.reason;
  return {};
}

}  // namespace evical
