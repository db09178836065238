#include "core/pipeline/detection/saved_detections.h"

#include "core/base/element.h"
#include "core/base/yaml_node.h"
#include "core/format/intrinsics_yaml.h"
#include "core/format/quantity_yaml.h"
#include "core/intrinsics/intrinsics_uncertainty.h"
#include "core/pipeline/detection/detections_check.h"
#include "core/pipeline/session/given_points.h"
#include "core/report/detections_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace evical {
namespace {

constexpr std::array kKinds = {"events", "frames", "points"};  // in CameraKind's order

std::string boardYaml(const Board& board) {
  if (!board.hasPattern())
    return fmt::format("{{type: {}, points_m: {}}}", boardTypeName(board.type), pointsYaml(board));
  return fmt::format(
      "{{type: {}, rows: {}, cols: {}, spacing_m: {}, radius_m: {}, circles: {}, tag_size_m: {}{}}}",
      boardTypeName(board.type), board.rows, board.cols, board.spacing_m, board.radius_m,
      board.circles == CircleShade::Dark ? "dark" : "bright", board.tag_size_m,
      board.first_tag == 0 ? "" : fmt::format(", first_tag: {}", board.first_tag));
}

std::string endsYaml(const LatticeEnds& ends) {
  return fmt::format("[{}, {}, {}, {}, {}, {}]", ends.beyond_in_view, ends.beyond_seen, ends.edge_in_view,
                     ends.edge_missing, ends.lines, ends.lines_lead);
}

LatticeEnds endsFrom(const YamlNode& node) {
  const std::vector<YamlNode> items = node.items();
  if (items.size() != 4 && items.size() != 6) throw node.error("must be four or six counts");
  constexpr int kMax = 1'000'000'000;
  const auto count = [&](std::size_t k) { return k < items.size() ? items[k].integer(0, kMax) : 0; };
  return {count(0), count(1), count(2), count(3), count(4), count(5)};
}

std::string cameraYaml(const SessionCamera& camera, const DetectionResult& detections, std::size_t k,
                       const std::optional<IntrinsicsResult>& found) {
  const BoardObservations& seen = detections.cameras[k];
  const Resolution size = elementOrNone(detections.resolutions_px, k);
  std::string text = fmt::format("  {}:\n", yamlText(camera.name));
  for (const DetectionKey& key : detectionKeys(camera))
    text += fmt::format("    {}: {}\n", key.name, yamlText(key.value));
  text += fmt::format(
      "    kind: {}\n    measurements: {}\n    resolution_px: [{}, {}]\n    extent: {{rows: {}, cols: {}}}\n",
      kKinds.at(static_cast<std::size_t>(seen.kind)), seen.events, size.width_px, size.height_px,
      endsYaml(seen.extent.rows), endsYaml(seen.extent.cols));
  if (seen.stamp_step_s > 0.0) text += fmt::format("    stamp_step_s: {}\n", seen.stamp_step_s);
  if (seen.single_events) text += "    single_events: true\n";
  if (seen.polarity_delay)
    text += fmt::format("    polarity_delay: {{later_s: {}, std_s: {}}}\n", seen.polarity_delay->later_s,
                        seen.polarity_delay->std_s);
  if (detections.lenses[k].detection_intrinsics)
    text += "    detection_intrinsics:\n" + intrinsicsYaml(*detections.lenses[k].detection_intrinsics, 6);
  if (found) text += "    found_first:\n" + foundIntrinsicsYaml(*found, 6);
  return text;
}

// Faults, without those of IMUs, which are detected again.
std::string faultsYaml(const Session& session, const DetectionResult& detections) {
  std::string text;
  for (const RecordingFault& fault : detections.faults)
    if (!isOfImu(fault, session))
      text += fmt::format("  - {{stream: {}, kind: {}, at_s: {}, text: {}}}\n", yamlText(fault.stream),
                          nameOf(fault.kind), fault.at_s, yamlText(fault.text));
  return text.empty() ? "faults: []\n" : "faults:\n" + text;
}

std::string optionsYaml(const Session& session) {
  std::string text;
  for (const OptionRow& row : detectionOptions(session))
    text += fmt::format("  {}: {}\n", row.name, yamlText(row.value));
  return text.empty() ? "options: {}\n" : "options:\n" + text;
}

std::string detectionsYaml(const Session& session, const DetectionResult& detections,
                           std::span<const std::optional<IntrinsicsResult>> intrinsics) {
  std::string text = fmt::format("evical_detections: 1\nrecording: {}\nstart_ns: {}\n",
                                 yamlText(session.recording.filename().string()), detections.start_ns);
  if (session.time_range_s)
    text += fmt::format("time_range_s: [{}, {}]\n", (*session.time_range_s)[0], (*session.time_range_s)[1]);
  text += fmt::format("board: {}\n{}cameras:\n", boardYaml(session.board), optionsYaml(session));
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    text +=
        cameraYaml(session.cameras[k], detections, k, k < intrinsics.size() ? intrinsics[k] : std::nullopt);
    if (session.boardIndexOf(k) > 0) text += fmt::format("    board: {}\n", boardYaml(session.boardOf(k)));
  }
  return text + faultsYaml(session, detections);
}

// Lens that the session gives and lens of the detection. Cameras of one sensor share both.
CameraLens restoredLens(const YamlNode& root, const Session& session, std::size_t k) {
  const SessionCamera& sensor = session.sensor(k);
  CameraLens lens = givenLens(sensor.intrinsics, sensor.intrinsics_uncertainty);
  lens.detection_intrinsics = checkedLens(checkedCamera(root, sensor), sensor);
  if (session.sensorOf(k) == k) return lens;
  SessionCamera camera = session.cameras[k];
  camera.intrinsics = lens.detection_intrinsics;
  checkedLens(checkedCamera(root, camera), camera);
  return lens;
}

// Restores one of the session's cameras from detections.yaml.
void restoreCamera(const YamlNode& root, const Session& session, std::size_t k,
                   RestoredDetections& restored) {
  const SessionCamera& camera = session.cameras[k];
  const YamlNode map = checkedCamera(root, camera);
  checkBoard(map.find("board").value_or(root["board"]), session.boardOf(k));
  BoardObservations& seen = restored.detections.cameras.emplace_back();
  seen.camera = camera.name;
  seen.kind = static_cast<CameraKind>(map["kind"].choice(kKinds));
  seen.events = static_cast<std::uint64_t>(std::max<std::int64_t>(0, map["measurements"].nanoseconds()));
  seen.extent = {endsFrom(map["extent"]["rows"]), endsFrom(map["extent"]["cols"])};
  if (const auto step = map.find("stamp_step_s")) seen.stamp_step_s = step->real();
  if (const auto single = map.find("single_events"))
    seen.single_events = single->choice({"false", "true"}) == 1;
  if (const auto delay = map.find("polarity_delay"))
    seen.polarity_delay = PolarityDelay{(*delay)["later_s"].real(), (*delay)["std_s"].real()};
  restored.detections.resolutions_px.push_back(checkedResolution(map, camera));
  const CameraLens lens = restoredLens(root, session, k);
  restored.intrinsics.emplace_back();
  if (lens.foundFirst() && session.sensorOf(k) == k)
    restored.intrinsics.back() = foundIntrinsicsFrom(map["found_first"], *lens.detection_intrinsics);
  restored.detections.lenses.push_back(lens);
}

std::vector<RecordingFault> faultsFrom(const YamlNode& list) {
  std::vector<RecordingFault> faults;
  for (const YamlNode& node : list.items())
    faults.push_back({node["stream"].text(), static_cast<FaultKind>(node["kind"].choice(kFaultKinds)),
                      node["at_s"].real(), node["text"].anyText()});
  return faults;
}

// Removes items outside the session's time range, if it is shorter than the detections'.
template <class Items>
void keepWithin(const std::optional<std::array<double, 2>>& range_s, Items& items) {
  if (!range_s) return;
  const auto [begin_s, end_s] = *range_s;
  std::erase_if(items, [begin = begin_s, end = end_s](const auto& item) {
    const double time_s = item.time_s;
    return time_s < begin || time_s > end;
  });
}

void restoreViews(const std::filesystem::path& folder, const Session& session, DetectionResult& detections) {
  std::vector<int> point_counts;
  for (std::size_t k = 0; k < session.cameras.size(); ++k)
    point_counts.push_back(session.boardOf(k).pointCount());
  std::vector<BoardObservations> saved =
      readDetections(folder, *std::max_element(point_counts.begin(), point_counts.end()));
  for (BoardObservations& camera : detections.cameras) {
    for (BoardObservations& each : saved) {
      if (each.camera != camera.camera) continue;
      camera.views = std::move(each.views);
      camera.windows = std::move(each.windows);
    }
    keepWithin(session.time_range_s, camera.views);
    keepWithin(session.time_range_s, camera.windows);
  }
}

void readSamples(const Session& session, const RunContext& context, DetectionResult& detections) {
  DetectionResult samples = readImus(session, detections.start_ns, context);
  detections.imus = std::move(samples.imus);
  detections.imu_stamp_steps_s = std::move(samples.imu_stamp_steps_s);
  detections.read_s = samples.read_s;
  for (RecordingFault& fault : samples.faults) {
    const auto same = [&](const RecordingFault& known) { return known.text == fault.text; };
    if (std::none_of(detections.faults.begin(), detections.faults.end(), same))
      detections.faults.push_back(std::move(fault));
  }
  checkOverlap(session, detections);
}

}  // namespace

std::vector<FileContent> detectionFiles(const Session& session, const DetectionResult& detections,
                                        std::span<const std::optional<IntrinsicsResult>> intrinsics) {
  return {{"detections.csv",
           {},
           [&detections](const TextSink& sink) { detectionsCsv(detections.cameras, sink); }},
          {"windows.csv", windowsCsv(detections.cameras)},
          {"detections.yaml", detectionsYaml(session, detections, intrinsics)}};
}

RestoredDetections restoreDetections(const std::filesystem::path& folder, const Session& session,
                                     const RunContext& context) {
  const YamlNode root = loadDetections(folder);
  checkSession(root, session, context);
  RestoredDetections restored;
  restored.detections.start_ns = root["start_ns"].nanoseconds();
  for (std::size_t k = 0; k < session.cameras.size(); ++k) restoreCamera(root, session, k, restored);
  restored.detections.faults = faultsFrom(root["faults"]);
  restoreViews(folder, session, restored.detections);
  readSamples(session, context, restored.detections);
  return restored;
}

namespace {

constexpr std::array kStatuses = {"ok", "doubtful", "failed"};  // in CalibrationStatus's order
constexpr int kMaxCells = 1000, kMaxCount = 1'000'000'000;

struct NumberKey {
  const char* key;
  double IntrinsicsResult::*number;
};
constexpr std::array kNumbers = {
    NumberKey{"edge_localisation_bias_px", &IntrinsicsResult::edge_localisation_bias_px},
    NumberKey{"edge_localisation_bias_std_px", &IntrinsicsResult::edge_localisation_bias_std_px},
    NumberKey{"reprojection_rms_px", &IntrinsicsResult::reprojection_rms_px},
    NumberKey{"normalised_rms", &IntrinsicsResult::normalised_rms},
    NumberKey{"largest_tilt_deg", &IntrinsicsResult::largest_tilt_deg},
    NumberKey{"moved_px", &IntrinsicsResult::moved_px},
    NumberKey{"elapsed_s", &IntrinsicsResult::elapsed_s}};

struct CountKey {
  const char* key;
  int IntrinsicsResult::*count;
};
constexpr std::array kCounts = {CountKey{"views_found", &IntrinsicsResult::views_found},
                                CountKey{"views_used", &IntrinsicsResult::views_used},
                                CountKey{"circles_used", &IntrinsicsResult::circles_used},
                                CountKey{"circles_rejected", &IntrinsicsResult::circles_rejected},
                                CountKey{"passes", &IntrinsicsResult::passes}};

std::string imageYaml(const ImageMap& image) {
  std::string circles;
  for (const ImageCell& cell : image.cells)
    circles += fmt::format("{}{}", circles.empty() ? "" : ", ", cell.circles);
  return fmt::format("image: {{columns: {}, rows: {}, circles: [{}]}}\n", image.columns, image.rows, circles);
}

ImageMap imageFrom(const YamlNode& map) {
  ImageMap image;
  image.columns = map["columns"].integer(1, kMaxCells);
  image.rows = map["rows"].integer(1, kMaxCells);
  for (const YamlNode& item : map["circles"].items())
    image.cells.emplace_back().circles = item.integer(0, kMaxCount);
  if (image.cells.size() != static_cast<std::size_t>(image.columns * image.rows))
    throw map.error("does not have a count for each cell");
  return image;
}

IntrinsicsMatrix covarianceFrom(const YamlNode& node) {
  const std::vector<YamlNode> rows = node.items();
  if (rows.size() != kIntrinsicsCount) throw node.error(fmt::format("must be {} rows", kIntrinsicsCount));
  IntrinsicsMatrix covariance;
  for (int row = 0; row < kIntrinsicsCount; ++row) {
    const std::vector<double> numbers = rows[static_cast<std::size_t>(row)].reals(kIntrinsicsCount);
    covariance.row(row) = Eigen::Map<const IntrinsicsVector>(numbers.data()).transpose();
  }
  return covariance;
}

}  // namespace

std::string foundIntrinsicsYaml(const IntrinsicsResult& found, int indent) {
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  std::string text = fmt::format("{0}status: {1}\n{0}reason: {2}\n{0}advice:{3}\n", blanks,
                                 kStatuses.at(static_cast<std::size_t>(found.status)), yamlLine(found.reason),
                                 found.advice.empty() ? " []" : "");
  for (const std::string& advice : found.advice) text += fmt::format("{}  - {}\n", blanks, yamlLine(advice));
  for (const NumberKey& row : kNumbers)
    text += fmt::format("{}{}: {}\n", blanks, row.key, exactYaml(found.*row.number));
  for (const CountKey& row : kCounts) text += fmt::format("{}{}: {}\n", blanks, row.key, found.*row.count);
  text += blanks + imageYaml(found.image) + blanks + "covariance:\n";
  for (int row = 0; row < kIntrinsicsCount; ++row)
    text += fmt::format("{}  - {}\n", blanks,
                        quantityYaml(Eigen::VectorXd(found.covariance.row(row).transpose()), exactYaml));
  return text;
}

IntrinsicsResult foundIntrinsicsFrom(const YamlNode& map, const CameraIntrinsics& intrinsics) {
  IntrinsicsResult found;
  found.status = static_cast<CalibrationStatus>(map["status"].choice(kStatuses));
  found.reason = map["reason"].text();
  for (const YamlNode& item : map["advice"].items()) found.advice.push_back(item.text());
  found.intrinsics = intrinsics;
  for (const NumberKey& row : kNumbers) found.*row.number = map[row.key].real();
  for (const CountKey& row : kCounts) found.*row.count = map[row.key].integer(0, kMaxCount);
  found.covariance = covarianceFrom(map["covariance"]);
  found.image = imageFrom(map["image"]);
  setSigmas(intrinsics, found.covariance, found.image);
  return found;
}

}  // namespace evical
