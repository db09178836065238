#include "core/pipeline/pass/found_intrinsics_yaml.h"

#include "core/format/quantity_yaml.h"
#include "core/intrinsics/intrinsics_uncertainty.h"

#include <fmt/format.h>

#include <array>

namespace evical {
namespace {

constexpr std::array kStatuses = {"ok", "doubtful", "failed"};  // in CalibrationStatus's order
constexpr int kMostCells = 1000, kMostCount = 1'000'000'000;

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
  image.columns = map["columns"].integer(1, kMostCells);
  image.rows = map["rows"].integer(1, kMostCells);
  for (const YamlNode& item : map["circles"].items())
    image.cells.emplace_back().circles = item.integer(0, kMostCount);
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
  for (const CountKey& row : kCounts) found.*row.count = map[row.key].integer(0, kMostCount);
  found.covariance = covarianceFrom(map["covariance"]);
  found.image = imageFrom(map["image"]);
  setSigmas(intrinsics, found.covariance, found.image);
  return found;
}

}  // namespace evical
