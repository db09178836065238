#include "core/report/html/advice.h"

#include "core/data/quality_warning.h"
#include "core/numerics/angles.h"
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::html {
namespace {

std::string percent(double share) {
  return number(100.0 * share, 0) + " %";
}

// Advice that reduces windows of this outcome.
const char* remedy(WindowOutcome outcome) {
  switch (outcome) {
    case WindowOutcome::TooFewEvents:
      return "Keep moving: an event camera at rest sees nothing. If it did move, lower its contrast "
             "thresholds.";
    case WindowOutcome::TooFewCircles:
      return "Keep the board in view, in focus and evenly lit; go closer if the board is small.";
    case WindowOutcome::NoLattice:
    case WindowOutcome::TooFewInGrid:
      return "Keep more of the board in the image, and keep moving clutter out of it.";
    case WindowOutcome::Ambiguous:
      return "Show the whole board more often: a part without an edge of the board is ambiguous.";
    case WindowOutcome::RefinementFailed:
      return "Move more smoothly or more slowly: the board's edges are blurred or overlap with others.";
    case WindowOutcome::Blurred:
      return "Move more slowly, or use a shorter exposure and more light: frames are blurred.";
    case WindowOutcome::TooSmall:
      return "Go closer, or use a board with larger squares or tags.";
    case WindowOutcome::OtherPattern:
      return "Check the board's type, its rows and columns, and the numbers of its tags.";
    case WindowOutcome::Unreadable:
      return "Copy the recording again: many of its images are damaged.";
    default:
      return "";
  }
}

WindowOutcome mostFrequentLoss(const CameraMeasures& camera) {
  std::size_t worst = static_cast<std::size_t>(WindowOutcome::TooFewEvents);
  for (std::size_t k = worst; k < kWindowOutcomeCount; ++k)
    if (k != static_cast<std::size_t>(WindowOutcome::RejectedByHand) &&
        camera.outcomes[k] > camera.outcomes[worst])
      worst = k;
  return static_cast<WindowOutcome>(worst);
}

void adviseDetection(const std::string& name, const CameraMeasures& camera, std::vector<Advice>& all) {
  constexpr double kGoodRate = 0.9, kManyPartial = 0.7, kWorthNaming = 0.05;
  if (camera.windows == 0) return;
  if (camera.detectionRate() < kGoodRate) {
    const WindowOutcome worst = mostFrequentLoss(camera);
    const int lost = camera.outcomes[static_cast<std::size_t>(worst)];
    if (lost > kWorthNaming * camera.windows)
      all.push_back({remedy(worst),
                     fmt::format("{}: the board was found in {} of the event windows or frames. Most "
                                 "frequent reason for the others: {} ({}).",
                                 name, percent(camera.detectionRate()), windowOutcomeName(worst), lost)});
  }
  if (camera.views > 0 && camera.partial > kManyPartial * camera.views)
    all.push_back(
        {"Keep the whole board in the image for longer: step back a little, or use a smaller board.",
         fmt::format("{}: {} of the views show only part of the board.", name,
                     percent(static_cast<double>(camera.partial) / camera.views))});
}

void adviseCoverage(const std::string& name, const CameraMeasures& camera, std::vector<Advice>& all) {
  constexpr double kCovered = 0.75, kTilted_deg = 20.0;
  if (camera.views == 0) return;
  if (!camera.cells.empty() && camera.coveredShare() < kCovered) {
    const std::string empty = emptyRegions(camera);
    all.push_back(
        {empty.empty() ? "Move the board through the whole image, into its corners."
                       : "Move the board through the whole image. Hardly covered: " + empty + ".",
         fmt::format("{}: the board covered {} of the image.", name, percent(camera.coveredShare()))});
  }
  if (camera.poses.empty()) return;
  const auto spread = [&](double BoardPose::*angle) {
    const auto [low, high] =
        std::minmax_element(camera.poses.begin(), camera.poses.end(),
                            [&](const BoardPose& a, const BoardPose& b) { return a.*angle < b.*angle; });
    return (*high).*angle - (*low).*angle;
  };
  const double x_deg = spread(&BoardPose::tilt_x_deg), y_deg = spread(&BoardPose::tilt_y_deg);
  if (std::min(x_deg, y_deg) < kTilted_deg)
    all.push_back(
        {fmt::format(
             "Tilt the camera more about its {} axis, up to 30 degrees to either side of the board's normal.",
             x_deg < y_deg ? "x" : "y"),
         fmt::format("{}: the tilts span {} deg about x and {} deg about y.", name, number(x_deg, 0),
                     number(y_deg, 0))});
}

void adviseLens(const std::string& name, const CameraMeasures& camera, const CameraFit& fit,
                std::vector<Advice>& all) {
  constexpr int kMin = 50;
  double largest_px = 0.0;
  for (const SensorCell& cell : camera.cells)
    if (cell.residuals >= kMin) largest_px = std::max(largest_px, cell.mean_residual_px.norm());
  constexpr double kBias_px = 0.1;
  if (largest_px > std::max(kBias_px, 0.7 * fit.reprojection_rms_px))
    all.push_back({"Calibrate the intrinsics again: the lens model does not fit the whole image.",
                   fmt::format("{}: the mean residual reaches {} px in parts of the image.", name,
                               significant(largest_px, 2))});
}

// Advice for the axis with the least motion, if that is below `enough`.
void adviseAxis(const std::string& name, const Eigen::Vector3d& motion, double enough, const char* verb,
                const char* unit, std::vector<Advice>& all) {
  Eigen::Index axis = 0;
  const double least = motion.minCoeff(&axis);
  if (least >= enough) return;
  all.push_back(
      {fmt::format("{} the {} axis of {} more.", verb, kAxes.at(static_cast<std::size_t>(axis)), name),
       fmt::format("RMS of x, y, z: {}, {}, {} {}; aim for at least {}.", significant(motion.x(), 2),
                   significant(motion.y(), 2), significant(motion.z(), 2), unit, significant(enough, 2))});
}

void adviseNoise(const std::string& name, const char* sensor, double found, double given, double density,
                 const char* unit, std::vector<Advice>& all) {
  constexpr double kFactor = 2.0;
  if (!(found > 0.0) || !(given > 0.0)) return;
  const double ratio = found / given;
  if (ratio < kFactor && ratio > 1.0 / kFactor) return;
  all.push_back({fmt::format("Check the {}'s noise density: the residuals correspond to {} {}.", sensor,
                             significant(ratio * density, 2), unit),
                 fmt::format("{}: the residuals are {} times those expected from {} {}{}.", name,
                             significant(ratio, 2), significant(density, 2), unit,
                             ratio > 1.0 ? "; vibration and shocks have the same effect" : "")});
}

void adviseImu(const std::string& name, const ImuData& given, const ImuMeasures& imu,
               std::vector<Advice>& all) {
  constexpr double kEnoughRate_rad_s = 0.4, kEnoughForce_m_s2 = 0.5;
  if (imu.rate_hz == 0.0) return;
  adviseAxis(name, imu.rate_rad_s.deviation, kEnoughRate_rad_s, "Turn about", "rad/s", all);
  adviseAxis(name, imu.force_m_s2.deviation, kEnoughForce_m_s2, "Accelerate along", "m/s\u00b2", all);
  const auto rms = [](const AxisMoments& m) { return std::sqrt(m.deviation.squaredNorm() / 3.0); };
  adviseNoise(name, "gyroscope", rms(imu.rate_residual), imu.rate_sigma_rad_s, given.noise.gyroscope_density,
              "rad/s/\u221aHz", all);
  adviseNoise(name, "accelerometer", rms(imu.force_residual), imu.force_sigma_m_s2,
              given.noise.accelerometer_density, "m/s\u00b2/\u221aHz", all);
}

// Sigmas decrease with the square root of the recorded time.
void adviseDuration(const ReportData& data, const Measures& measures, std::vector<Advice>& all) {
  constexpr double kShort_s = 15.0, kReasonable_s = 180.0;
  double worst = 0.0;
  for (const CameraUncertainty& sigma : data.named.result->uncertainty.cameras)
    worst = std::max({worst, kDegPerRad * sigma.rotation_std_rad.maxCoeff() / data.needs.rotation_deg,
                      1e3 * sigma.translation_std_m.maxCoeff() / data.needs.translation_mm,
                      1e3 * sigma.time_offset_std_s / data.needs.time_offset_ms});
  const double asked_s = worst * worst * measures.duration_s;
  if (worst > 1.0 && measures.duration_s > 0.0) {
    all.push_back(
        {asked_s < kReasonable_s
             ? fmt::format("Record longer: about {} s of the same motion would meet the required sigmas.",
                           number(std::ceil(asked_s / 5.0) * 5.0, 0))
             : "Move faster and in more directions: a longer recording alone would not be enough.",
         fmt::format("The largest sigma is {} times the required one after {} s.", significant(worst, 2),
                     number(measures.duration_s, 1))});
  } else if (measures.duration_s > 0.0 && measures.duration_s < kShort_s) {
    all.push_back({"Record at least 20 s: sigmas decrease with the square root of the time.",
                   fmt::format("This recording lasts {} s.", number(measures.duration_s, 1))});
  }
}

void adviseFaults(const ReportData& data, std::vector<Advice>& all) {
  struct Remedy {
    FaultKind kind;
    const char* what;
  };
  static constexpr std::array<Remedy, 8> kRemedies = {{
      {FaultKind::Gap,
       "Avoid data loss: use a faster or a local disk, or reduce the events (bias settings, event rate "
       "control)."},
      {FaultKind::BackwardTime,
       "Find out why timestamps decrease: the driver was restarted, or two sources share one topic."},
      {FaultKind::Jitter, "Use the sensor's own timestamps: timestamps set on arrival jitter."},
      {FaultKind::Truncated, "Stop the recorder before you switch off the power or copy the file."},
      {FaultKind::Corrupt, "Check the disk and the transfer: parts of the file are damaged."},
      {FaultKind::SaturatedAxis, "Move less abruptly, or set a larger measuring range of the IMU."},
      {FaultKind::StuckAxis,
       "Check the IMU: an axis whose value never changes is defective or decoded incorrectly."},
      {FaultKind::HotPixels, "Mask hot pixels in the camera's driver."},
  }};
  for (const Remedy& remedy : kRemedies) {
    const auto found = std::find_if(data.faults.begin(), data.faults.end(),
                                    [&](const auto& f) { return f.kind == remedy.kind; });
    if (found != data.faults.end()) all.push_back({remedy.what, found->text});
  }
}

void adviseHalves(const ReportData& data, std::vector<Advice>& all) {
  constexpr double kFar = 2.0, kVeryFar = 4.0;
  const auto& validation = data.named.result->split_half_check;
  if (!validation || !validation->failure.empty()) return;
  const QuantityDifference* worst = nullptr;
  for (const QuantityDifference& each : validation->quantities)
    if (worst == nullptr || std::abs(each.normalised()) > std::abs(worst->normalised())) worst = &each;
  if (worst == nullptr || (validation->rms_sigmas < kFar && std::abs(worst->normalised()) < kVeryFar)) return;
  all.push_back(
      {"Make sure that camera and IMU are rigidly connected. Regard the sigmas of this result as too small.",
       fmt::format("The two halves of the recording differ by {} sigmas (RMS), and by {} sigmas in {}.",
                   number(validation->rms_sigmas, 1), number(std::abs(worst->normalised()), 1),
                   worst->name)});
}

}  // namespace

std::string emptyRegions(const CameraMeasures& camera) {
  static constexpr std::array<const char*, 3> kRows = {"top", "middle", "bottom"},
                                              kCols = {"left", "centre", "right"};
  std::array<std::array<std::array<int, 2>, 3>, 3> cells = {};  // seen, all
  for (std::size_t i = 0; i < camera.cells.size(); ++i) {
    const std::size_t row = i / CameraMeasures::kCols, col = i % CameraMeasures::kCols;
    auto& region = cells[row * 3 / CameraMeasures::kRows][col * 3 / CameraMeasures::kCols];
    region[0] += camera.cells[i].circles > 0 ? 1 : 0;
    ++region[1];
  }
  std::string text;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t col = 0; col < 3; ++col)
      if (2 * cells[row][col][0] < cells[row][col][1])
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", kRows[row], kCols[col]);
  return text;
}

std::string remedyForMissed(const CameraMeasures& camera) {
  return camera.views < camera.windows ? remedy(mostFrequentLoss(camera)) : std::string();
}

std::vector<Advice> adviceFor(const ReportData& data, const Measures& measures) {
  std::vector<Advice> all;
  adviseFaults(data, all);
  for (std::size_t i = 0; i < measures.cameras.size(); ++i) {
    const std::string name = cameraName(data, i);
    adviseDetection(name, measures.cameras[i], all);
    adviseCoverage(name, measures.cameras[i], all);
    if (i < data.named.result->cameras.size())
      adviseLens(name, measures.cameras[i], data.named.result->cameras[i], all);
  }
  for (std::size_t i = 0; i < measures.imus.size(); ++i)
    adviseImu(imuName(data, i), data.imus[i], measures.imus[i], all);
  adviseDuration(data, measures, all);
  adviseHalves(data, all);
  return all;
}

void writeAdvice(const ReportData& data, const Measures& measures, ReportPage& page) {
  std::vector<Advice> all = adviceFor(data, measures);
  const std::vector<QualityWarning>& causes = data.named.result->causes;
  const bool wrong_input = !causes.empty() && isWrongInput(causes.front());
  if (wrong_input) all.clear();  // measured with that input
  const bool failed = data.named.result->status == CalibrationStatus::Failed;
  if (failed && all.empty()) return;
  page.beginSection("advice", "Advice for the next recording");
  if (failed) page.text(paragraph("", "First fix the problem above. The data also suggest:"));
  if (all.empty())
    page.text(paragraph("", wrong_input ? "Correct the input above first, and calibrate this recording again."
                                        : "No improvement is needed: a similar recording is suitable."));
  std::string items;
  for (const Advice& each : all)
    items += element("li", "", escaped(each.what) + " <small>" + escaped(each.evidence) + "</small>");
  if (!items.empty()) page.text(element("ol", "", items));
  page.endSection();
}

}  // namespace evical::html
