#include "core/initialisation/further_boards.h"

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/initialisation/board_alignment.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <vector>

namespace evical {
namespace {

bool agrees(const std::optional<BoardAlignment>& found, const InitialisationOptions& options) {
  return found && found->agreeing >= options.least_board_agreement;
}

void checkAlignment(const std::string& board, const CalibrationInput& input,
                    const std::optional<BoardAlignment>& found, double gap_s,
                    const InitialisationOptions& options) {
  if (!found) {
    throw calibrationFailed(
        board,
        fmt::format(
            "fewer than {} views of it are within {:.2g} s of views of '{}', so their relative pose is "
            "unknown",
            options.least_views, gap_s, input.boardName(0)),
        "Keep each board in its camera's view at the same time, for most of the recording");
  }
  if (agrees(found, options)) return;
  throw calibrationFailed(
      board,
      fmt::format("only {:.0f} % of its views agree on its pose relative to '{}'", 100.0 * found->agreeing,
                  input.boardName(0)),
      "Check that the boards do not move relative to each other, and which camera sees which board");
}

}  // namespace

void alignFurtherBoards(const CalibrationInput& input, const std::map<std::size_t, AlignedCamera>& aligned,
                        const CameraTrajectory& body, double gap_s, const InitialisationOptions& options,
                        Initialisation& result) {
  result.state.further_boards.resize(input.further_boards.size());
  for (std::size_t board = 1; board < input.boardCount(); ++board) {
    Stopwatch stopwatch;
    std::vector<BoardSight> sights;
    std::vector<std::size_t> cameras;
    for (const auto& [k, camera] : aligned) {
      if (input.cameras[k].board != board) continue;
      sights.push_back({camera.poses, camera.hand_eye.time_offset_s, camera.hand_eye.reference_from_sensor,
                        input.cameras[k].prior.translation});
      cameras.push_back(k);
    }
    const std::string& name = input.boardName(board);
    const auto found = alignBoard(body, sights, gap_s, options.least_views);
    const auto negated = alignBoard(body, sights, gap_s, options.least_views, -1.0);
    if (agrees(negated, options) &&
        (!agrees(found, options) || negated->position_rms_m < options.far_better * found->position_rms_m))
      throw calibrationFailed(
          name,
          fmt::format("its views agree with '{}' only if the images of the cameras of one of the two boards "
                      "are mirrored",
                      input.boardName(0)),
          "Check whether writing is readable in the cameras' pictures. If not, turn the mirroring off in the "
          "driver, or set mirrored: x, y or transposed for the camera");
    checkAlignment(name, input, found, gap_s, options);
    result.state.boardAt(board).world_from_board = found->world_from_board;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      CameraState& state = result.state.cameras.at(cameras[i]);
      state.reference_from_camera = {sights[i].body_from_camera, found->cameras_in_body_m[i]};
      state.time_offset_s = sights[i].time_offset_s;
    }
    result.steps.push_back(
        {"board to board", name,
         fmt::format("{} views agree to {:.3f} deg and {:.2f} mm on its pose relative to {}", found->views,
                     found->rotation_rms_rad * kDegPerRad, 1e3 * found->position_rms_m, input.boardName(0)),
         found->position_rms_m, 0.0, stopwatch.restart_s()});
  }
}

}  // namespace evical
