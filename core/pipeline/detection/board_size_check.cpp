#include "core/pipeline/detection/board_size_check.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace evical {
namespace {

constexpr double kMinWhole = 0.05;  // of the views

struct AxisCheck {
  const char* line;  // "row" or "column"
  const LatticeEnds& ends;
  std::vector<bool> seen;  // by line, in any view
  bool whole;              // enough views show both outermost lines
};

std::vector<bool> circlesSeen(const BoardObservations& observations, const Board& board) {
  std::vector<bool> seen(static_cast<std::size_t>(board.pointCount()), false);
  for (const BoardView& view : observations.views)
    for (const CircleObservation& circle : view.circles) seen[static_cast<std::size_t>(circle.circle)] = true;
  return seen;
}

// Counts the views that show both outermost lines, of rows or of columns. A board smaller than the session's
// never has such a view. A board of the correct size has some, even if the read-out loses many bursts of
// events.
int wholeViews(const BoardObservations& observations, const Board& board, bool rows, double min_line) {
  const int lines = board.lineCount(rows), in_line = board.pointCount() / lines;
  const double least = std::max(2.0, min_line * in_line);
  return static_cast<int>(
      std::count_if(observations.views.begin(), observations.views.end(), [&](const BoardView& view) {
        int first = 0, last = 0;
        for (const CircleObservation& circle : view.circles) {
          const int line = board.lineOf(circle.circle, rows);
          first += line == 0;
          last += line == lines - 1;
        }
        return std::min(first, last) >= least;
      }));
}

bool contradicted(int against, int looked_at, const ExtentOptions& options) {
  return looked_at >= options.min_views && against > options.max_share * looked_at;
}

const char* pointsOf(const Board& board) {
  return board.hasCircles() ? "circles" : (board.type == BoardType::AprilGrid ? "tags" : "corners");
}

std::string whatToCheck(const Board& board) {
  if (board.hasCircles()) return "rows, columns and circles (dark or bright)";
  return board.hasTags() ? "type, rows, columns and tags" : "type, rows and columns";
}

// Keys that state which part of the visible lattice is the board: a wrong first_tag moves it by some rows.
std::string numbersOf(const Board& board) {
  return board.type == BoardType::AprilGrid ? "rows, columns and first_tag" : "rows and columns";
}

std::string beyondText(const AxisCheck& axis, const Board& board) {
  return fmt::format("{} of the same lattice are visible beyond its first or last {} in {:.0f} % of {} views",
                     pointsOf(board), axis.line, 100.0 * axis.ends.beyond_seen / axis.ends.beyond_in_view,
                     axis.ends.beyond_in_view);
}

std::string missingText(const AxisCheck& axis, std::size_t views) {
  const auto count = static_cast<std::ptrdiff_t>(axis.seen.size());
  const auto first = std::find(axis.seen.begin(), axis.seen.end(), true) - axis.seen.begin();
  const auto last = std::find(axis.seen.rbegin(), axis.seen.rend(), true) - axis.seen.rbegin();
  const std::ptrdiff_t never = std::max(first, last);
  if (never == 0 || never == count) {
    return fmt::format(
        "its first or last {} is missing in {:.0f} % of the {} views that contain its position", axis.line,
        100.0 * axis.ends.edge_missing / axis.ends.edge_in_view, axis.ends.edge_in_view);
  }
  return fmt::format("the {} {} of {} {}s {} never seen in {} views", first > last ? "first" : "last", never,
                     count, axis.line, never == 1 ? "was" : "were", views);
}

// "7 rows and 9 columns are visible", if enough views show both ends of a line.
std::string visibleLines(const BoardObservations& observations, const Board& board) {
  constexpr int kEnough = 3;
  std::string text;
  for (const bool of_rows : {true, false}) {
    const LatticeEnds& ends = of_rows ? observations.extent.rows : observations.extent.cols;
    if (ends.lines_lead < kEnough) continue;
    const int more = (of_rows ? board.rows : board.cols) - board.lineCount(of_rows);
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : " and ", ends.lines + more, of_rows ? "rows" : "columns");
  }
  return text.empty() ? text : ": " + text + " are visible";
}

}  // namespace

std::string outcomes(const BoardObservations& observations) {
  std::array<int, kWindowOutcomeCount> counts = {};
  for (const WindowReport& window : observations.windows) ++counts[static_cast<std::size_t>(window.outcome)];
  std::string text;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    if (counts[k] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[k],
                        windowOutcomeName(static_cast<WindowOutcome>(k)));
  }
  return text.empty() ? "no windows" : text;
}

void checkBoardSeen(const BoardObservations& observations, const Board& board,
                    std::span<const RecordingFault> faults) {
  if (!observations.views.empty()) return;
  const auto by_hand =
      std::ranges::count(observations.windows, WindowOutcome::RejectedByHand, &WindowReport::outcome);
  if (by_hand > 0)
    throw calibrationFailed(
        observations.camera,
        fmt::format("all {} with the board {} rejected by hand",
                    counted(static_cast<std::uint64_t>(by_hand), "window"), by_hand == 1 ? "is" : "are"),
        "Include some again, or shorten rejected_windows_s of this camera in the session");
  const std::string never =
      fmt::format("the board was never found in {} {} ({})", observations.windows.size(),
                  observations.kind == CameraKind::Events ? "windows" : "frames", outcomes(observations));
  const std::string prefix = observations.camera + ": ";
  for (const RecordingFault& fault : faults)
    if (fault.kind == FaultKind::BoardSize && fault.text.starts_with(prefix))
      throw calibrationFailed(observations.camera, never + ": " + fault.text.substr(prefix.size()),
                              "Correct the board " + howTo(HowTo::EditBoard) +
                                  ", the printed board, or the driver or the key mirrored of the camera "
                                  "accordingly");
  const auto too_small =
      std::ranges::count(observations.windows, WindowOutcome::TooSmall, &WindowReport::outcome);
  if (10 * too_small > static_cast<std::ptrdiff_t>(observations.windows.size()))
    throw calibrationFailed(
        observations.camera,
        fmt::format(
            "{}: {} at most {:.1f} px wide in the image, and need 3 px", never,
            board.type == BoardType::AprilGrid ? "the dark borders of its tags are" : "its dark squares are",
            observations.narrowest_px),
        "Go closer, or use a board with larger squares or tags: borders of 2 bits are wider than those of 1");
  const auto other_tags =
      std::ranges::count(observations.windows, WindowOutcome::OtherPattern, &WindowReport::outcome);
  if (10 * other_tags > static_cast<std::ptrdiff_t>(observations.windows.size()))
    throw calibrationFailed(
        observations.camera,
        fmt::format("{}: corners of {} are visible, but the tags between them are others", never,
                    board.type == BoardType::AprilGrid ? "an AprilGrid" : "a ChArUco board"),
        fmt::format(
            "Check type, rows and columns {}{}. {}", howTo(HowTo::EditBoard),
            visibleLines(observations, board),
            board.type == BoardType::AprilGrid
                ? fmt::format("Tags {} to {} of the family tag36h11 are expected, with a border of 1 or "
                              "2 bits: check first_tag, too",
                              board.first_tag, board.first_tag + board.rows * board.cols - 1)
                : "Markers of ArUco's dictionaries are expected, from number 0 on"));
  int lattices = 0;
  for (const WindowReport& window : observations.windows) {
    lattices += window.outcome == WindowOutcome::TooFewInGrid || window.outcome == WindowOutcome::Ambiguous ||
                window.outcome == WindowOutcome::RefinementFailed;
  }
  const bool other_board = 5 * lattices > static_cast<int>(observations.windows.size());
  throw calibrationFailed(observations.camera, never,
                          other_board
                              ? fmt::format("Rows of {} are visible, but no {} x {} board: check {} {}{}",
                                            pointsOf(board), board.rows, board.cols, whatToCheck(board),
                                            howTo(HowTo::EditBoard), visibleLines(observations, board))
                              : std::string("Check that the board is in view, in focus and moving") +
                                    (board.hasCircles() ? ", and check "
                                                        : ", that its narrowest dark lines are 3 px wide in "
                                                          "the image, and check ") +
                                    whatToCheck(board) + " " + howTo(HowTo::EditBoard) +
                                    "; look at the detections " + howTo(HowTo::LookAtDetections));
}

void checkBoardSize(const BoardObservations& observations, const Board& board, const ExtentOptions& options) {
  if (observations.kind != CameraKind::Events) return;  // only their lattice can be misidentified
  const std::vector<bool> seen = circlesSeen(observations, board);
  const double min_whole =
      std::max<double>(options.min_views, kMinWhole * static_cast<double>(observations.views.size()));
  const auto isWhole = [&](bool of_rows) {
    return wholeViews(observations, board, of_rows, options.min_line) >= min_whole;
  };
  AxisCheck rows{"row", observations.extent.rows,
                 std::vector<bool>(static_cast<std::size_t>(board.lineCount(true))), isWhole(true)};
  AxisCheck cols{"column", observations.extent.cols,
                 std::vector<bool>(static_cast<std::size_t>(board.lineCount(false))), isWhole(false)};
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (!seen[k]) continue;
    const auto point = static_cast<int>(k);
    rows.seen[static_cast<std::size_t>(board.lineOf(point, true))] = true;
    cols.seen[static_cast<std::size_t>(board.lineOf(point, false))] = true;
  }
  bool larger = false, smaller = false;
  std::string text;
  const auto say = [&](const std::string& more) { text += (text.empty() ? "" : ", and ") + more; };
  for (const AxisCheck* axis : {&rows, &cols}) {
    if (contradicted(axis->ends.beyond_seen, axis->ends.beyond_in_view, options)) {
      larger = true;
      say(beyondText(*axis, board));
    }
    if (!axis->whole && contradicted(axis->ends.edge_missing, axis->ends.edge_in_view, options)) {
      smaller = true;
      say(missingText(*axis, observations.views.size()));
    }
  }
  if (text.empty()) return;
  throw calibrationFailed(observations.camera,
                          fmt::format("the visible board seems {} {} x {}: {}",
                                      larger && smaller ? "different from"
                                      : larger          ? "larger than"
                                                        : "smaller than",
                                      board.rows, board.cols, text),
                          "Check " + numbersOf(board) + " " + howTo(HowTo::EditBoard) +
                              (larger && smaller && board.rows != board.cols
                                   ? fmt::format(": are they exchanged ({} and {})?", board.cols, board.rows)
                                   : visibleLines(observations, board)));
}

std::optional<RecordingFault> unseenCircles(const BoardObservations& observations, const Board& board) {
  constexpr std::size_t kEnoughViews = 30;
  if (observations.views.size() < kEnoughViews) return std::nullopt;
  const std::vector<bool> seen = circlesSeen(observations, board);
  const auto never = std::count(seen.begin(), seen.end(), false);
  if (never == 0) return std::nullopt;
  return RecordingFault{
      observations.camera, FaultKind::BoardSize, 0.0,
      fmt::format("{}: {} of the board's {} {} were not seen in any of {} views: check its {}",
                  observations.camera, never, board.pointCount(), board.hasCircles() ? "circles" : "points",
                  observations.views.size(), board.hasPattern() ? numbersOf(board) : "points_m")};
}

const char* measurementsOf(CameraKind kind) {
  return kind == CameraKind::Events ? "events" : kind == CameraKind::Frames ? "frames" : "points";
}

}  // namespace evical
