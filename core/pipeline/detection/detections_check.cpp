#include "core/pipeline/detection/detections_check.h"

#include "core/base/file_places.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/projection_difference.h"
#include "core/initialisation/initialisation_options.h"
#include "core/pipeline/session/given_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace evical {
namespace {

std::string otherFolder() {
  return "Give the folder of a run of this session, or leave " + howTo(HowTo::UseDetections) +
         " out to detect the board again";
}
std::string inQuotes(const std::string& text) {
  return "'" + text + "'";
}

void checkSame(const YamlNode& map, const char* key, const std::string& session, const char* what) {
  const YamlNode node = map[key];
  if (node.text() != session)
    throw node.error(fmt::format("the detections are of {} {}, but the session is of {}", what,
                                 inQuotes(node.text()), inQuotes(session)),
                     otherFolder());
}

// Compares ratios of sizes only: a board that was measured again is still the same board.
void checkSizes(const YamlNode& map, const Board& board) {
  constexpr double kMeasuredAgain = 0.05;
  const double spacing_m = map["spacing_m"].real(1e-6, 100.0, "m");
  const auto check = [&](const char* key, double session_m) {
    const YamlNode node = map[key];
    const double then = node.real(0.0, 100.0, "m") / spacing_m, now = session_m / board.spacing_m;
    if (std::abs(then - now) > kMeasuredAgain * std::max(then, now))
      throw node.error(
          fmt::format("it is {:.3f} of the spacing for the detections, but {:.3f} in the session", then, now),
          otherFolder());
  };
  check("radius_m", board.radius_m);
  check("tag_size_m", board.tag_size_m);
}

// Compares points with a tolerance, since they may have been measured again.
void checkPoints(const YamlNode& said, const Board& board) {
  constexpr double kMeasuredAgain = 0.05;  // relative to the distance of neighbours
  const YamlNode node = said["points_m"];
  const std::vector<Eigen::Vector2d> then_m = pointsFrom(node);
  if (then_m.size() != board.given_m.size())
    throw node.error(fmt::format("the detections are of a board with {} points, but the session's has {}",
                                 then_m.size(), board.given_m.size()),
                     otherFolder());
  for (std::size_t i = 0; i < then_m.size(); ++i)
    if ((then_m[i] - board.given_m[i]).norm() > kMeasuredAgain * board.spacing_m)
      throw node.error(
          fmt::format(
              "point {} of the board is at {}, {} m for the detections, but at {}, {} m in the session", i,
              then_m[i].x(), then_m[i].y(), board.given_m[i].x(), board.given_m[i].y()),
          otherFolder());
}

void checkTimeRange(const YamlNode& root, const Session& session) {
  const auto node = root.find("time_range_s");
  if (!node) return;
  const std::vector<double> seen_s = node->reals(2);
  const auto& wanted_s = session.time_range_s;
  if (wanted_s && (*wanted_s)[0] >= seen_s[0] && (*wanted_s)[1] <= seen_s[1]) return;
  throw node->error(
      fmt::format(
          "the detections cover {} to {} s, but the session covers {}", seen_s[0], seen_s[1],
          wanted_s ? fmt::format("{} to {} s", (*wanted_s)[0], (*wanted_s)[1]) : "the whole recording"),
      "Give the session " + howTo(HowTo::LimitTime) + " within it, or leave " + howTo(HowTo::UseDetections) +
          " out to detect the board again");
}

void logOptions(const YamlNode& map, const Session& session, const RunContext& context) {
  std::string differing;
  std::vector<OptionRow> rows = detectionOptions(session);
  for (const std::string& key : map.keys()) {
    const auto same = [&](const OptionRow& row) { return row.name == key && row.value == map[key].text(); };
    const auto found = std::find_if(rows.begin(), rows.end(), same);
    if (found == rows.end())
      differing += " " + key;
    else
      rows.erase(found);
  }
  for (const OptionRow& row : rows)
    if (!map.has(row.name)) differing += " " + row.name;
  if (!differing.empty())
    context.progress.log(LogLevel::Warning,
                         "The detections were made with other options and stay unchanged:" + differing);
}

}  // namespace

YamlNode loadDetections(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "detections.yaml";
  if (!pathExists(file))
    throw badInput(file.string(), "does not exist",
                   "Give the result folder of a calibration or a detection. Detect again if an earlier "
                   "version wrote it");
  YamlNode root = YamlNode::load(file);
  if (!root.isMap() || !root.has("evical_detections"))
    throw root.error("does not contain detections: the key evical_detections is missing", otherFolder());
  root["evical_detections"].integer(1, 1);
  const YamlNode start = root["start_ns"];
  if (!isTime(start.nanoseconds())) throw start.error("is not a valid time", otherFolder());
  return root;
}

void checkBoard(const YamlNode& said, const Board& board) {
  checkSame(said, "type", boardTypeName(board.type), "a board of type");
  if (!board.hasPattern()) return checkPoints(said, board);
  checkSame(said, "rows", std::to_string(board.rows), "a board with rows:");
  checkSame(said, "cols", std::to_string(board.cols), "a board with columns:");
  if (board.hasCircles())
    checkSame(said, "circles", board.circles == CircleShade::Dark ? "dark" : "bright", "circles that are");
  checkSizes(said, board);
}

void checkSession(const YamlNode& detections, const Session& session, const RunContext& context) {
  checkTimeRange(detections, session);
  logOptions(detections["options"], session, context);
  const std::string recording = detections["recording"].anyText(),
                    own = session.recording.filename().string();
  if (recording != own)
    context.progress.log(LogLevel::Warning,
                         fmt::format("The detections are of a recording named {}; the session's is named {}",
                                     inQuotes(recording), inQuotes(own)));
}

YamlNode checkedCamera(const YamlNode& detections, const SessionCamera& camera) {
  const YamlNode cameras = detections["cameras"];
  const auto map = cameras.find(camera.name);
  if (!map) {
    std::string names;
    for (const std::string& name : cameras.keys()) names += (names.empty() ? "" : ", ") + name;
    throw cameras.error(
        fmt::format("the session's camera {} is missing; existing cameras: {}", inQuotes(camera.name), names),
        otherFolder());
  }
  const std::vector<DetectionKey> usual = detectionKeys({});
  std::vector<DetectionKey> keys = detectionKeys(camera);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto node = map->find(keys[k].name);
    const std::string then = node ? node->text() : usual[k].value;
    if (then == keys[k].value) continue;
    throw node.value_or(*map).error(fmt::format("the detections have the {} {}, but the session has {}",
                                                keys[k].name, inQuotes(then), inQuotes(keys[k].value)),
                                    otherFolder());
  }
  return *map;
}

Resolution checkedResolution(const YamlNode& map, const SessionCamera& camera) {
  const YamlNode node = map["resolution_px"];
  const std::vector<YamlNode> items = node.items();
  constexpr int kMax = 1'000'000;
  if (items.size() != 2) throw node.error("must be [width, height]");
  const Resolution seen = {items[0].integer(1, kMax), items[1].integer(1, kMax)};
  const Resolution own = camera.resolution_px.known() || !camera.intrinsics
                             ? camera.resolution_px
                             : camera.intrinsics->resolution_px;
  if (own.known() && own != seen)
    throw node.error(fmt::format("the detections are of {}, but the session's camera has {}", sizeText(seen),
                                 sizeText(own)),
                     otherFolder());
  return seen;
}

CameraIntrinsics checkedLens(const YamlNode& map, const SessionCamera& camera) {
  const auto node = map.find("detection_intrinsics");
  if (!node)
    throw map.error(
        "was detected without intrinsics, which would change the positions",
        "Start from the folder of a calibration, or give the camera's intrinsics and detect again");
  CameraIntrinsics detection_intrinsics = readIntrinsics(*node);
  if (!camera.intrinsics) {
    if (!map.has("found_first"))
      throw node->error(
          "the detections were made with given intrinsics, but the session gives none",
          "Give the session the same intrinsics, or leave " + howTo(HowTo::UseDetections) + " out");
    return detection_intrinsics;
  }
  constexpr double kSame_px = 1e-6;
  const CameraIntrinsics& given = *camera.intrinsics;
  const bool same =
      detection_intrinsics == given || (detection_intrinsics.resolution_px == given.resolution_px &&
                                        detection_intrinsics.resolution_px.known() &&
                                        projectionDifference(detection_intrinsics, given).max_px < kSame_px);
  if (!same)
    throw node->error("the detections were made with intrinsics other than the session's",
                      "Use the intrinsics of the detections in the session, or omit " +
                          howTo(HowTo::UseDetections) + " to detect the board again");
  return detection_intrinsics;
}

void checkOverlap(const Session& session, const DetectionResult& detections) {
  double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
  for (const BoardObservations& camera : detections.cameras) {
    if (camera.views.empty()) continue;
    first_s = std::min(first_s, camera.views.front().time_s);
    last_s = std::max(last_s, camera.views.back().time_s);
  }
  const double apart_s = session.options.initialisation->time_offset_search_s;
  for (const ImuData& imu : detections.imus) {
    const double begin_s = secondsSince(detections.start_ns, imu.samples.front().time_ns),
                 end_s = secondsSince(detections.start_ns, imu.samples.back().time_ns);
    if (begin_s > last_s + apart_s || end_s < first_s - apart_s)
      throw badInput(imu.name,
                     fmt::format("its samples cover {:.3f} to {:.3f} s, but the detections {:.3f} to {:.3f} "
                                 "s: they are of another recording",
                                 begin_s, end_s, first_s, last_s),
                     otherFolder());
  }
}

// All options except those of later stages and other commands. Those of the intrinsics have an effect on
// lenses that are calibrated first.
std::vector<OptionRow> detectionOptions(const Session& session) {
  const CalibrationOptions usual;
  CalibrationOptions deciding = session.options;
  deciding.stamps = usual.stamps;  // IMU samples are read again
  deciding.initialisation = usual.initialisation;
  deciding.optimisation = usual.optimisation;
  deciding.report = usual.report;
  deciding.check = usual.check;
  deciding.edge_slopes = usual.edge_slopes;
  deciding.egomotion = usual.egomotion;
  deciding.maintain = usual.maintain;
  const std::vector<CameraLens> lenses = givenLenses(session);
  if (std::ranges::all_of(lenses, [](const CameraLens& lens) { return lens.given.has_value(); }))
    deciding.intrinsics = usual.intrinsics;
  return differingOptions(deciding);
}

// Compilation fails if SessionCamera has a member that is missing here. Priors, the lens's uncertainty, the
// shutter and rejected windows have no effect before the initialisation. The recordings may have been moved.
std::vector<DetectionKey> detectionKeys(const SessionCamera& camera) {
  const auto& [name, stream, resolution_px, intrinsics, recording, clock_offset_s, clock_scale, columns,
               prior, intrinsics_uncertainty, shutter, same_sensor_as, board, mirrored, rejected_windows_s] =
      camera;
  static_cast<void>(std::tie(name, resolution_px, intrinsics, recording, prior, intrinsics_uncertainty,
                             shutter, same_sensor_as, board, rejected_windows_s));
  return {{"stream", stream},
          {"clock_offset_s", fmt::format("{}", clock_offset_s)},
          {"clock_scale", fmt::format("{}", clock_scale)},
          {"columns", columns},
          {"mirrored", kMirroringNames.at(static_cast<std::size_t>(mirrored.value_or(Mirroring::None)))}};
}

bool isOfImu(const RecordingFault& fault, const Session& session) {
  return std::any_of(session.imus.begin(), session.imus.end(), [&](const SessionImu& imu) {
    const std::array names = {imu.stream, imu.accelerometer_stream, imu.joinedStream(), imu.name};
    return !fault.stream.empty() && std::ranges::find(names, fault.stream) != names.end();
  });
}

}  // namespace evical
