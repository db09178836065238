#include "core/egomotion/camera_record.h"

#include "core/egomotion/window_fit.h"

#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// Weights of the parts of the window in the estimated motion.
void weighParts(const WindowFit& fit, double window_s, WindowMotion& out) {
  double sum = 0.0;
  for (const EdgeRow& row : fit.rows()) {
    const double part = row.time_s / window_s * static_cast<double>(WindowMotion::kParts);
    const auto k =
        static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(WindowMotion::kParts) - 0.5));
    const EdgeResidual residual = fit.seen(row).residual;
    const double weight = fit.weightOf(residual) * residual.by_flow.squaredNorm();
    out.part_weights[k] += weight;
    sum += weight;
  }
  for (double& weight : out.part_weights) weight /= sum;
}

double medianSpeed_px_s(const WindowFit& fit, double focal_length_px) {
  std::vector<double> speeds;
  for (const EdgeRow& row : fit.rows())
    speeds.push_back(
        (row.by_rotation * fit.state().rate_rad_s + fit.seen(row).residual.translational).norm());
  return focal_length_px * medianOf(std::move(speeds));
}

}  // namespace

const char* windowUseWords(WindowUse use) {
  static constexpr std::array<const char*, kWindowUses> kWords = {
      "used",
      "too few edges with a speed",
      "the image hardly moves",
      "most edges do not move as in a static scene",
      "the rotation is not determined",
      "no gyroscope samples at that time",
      "contradicts the other windows"};
  return kWords.at(static_cast<std::size_t>(use));
}

WindowMotion estimateWindowMotion(std::span<const EdgeSlope> slopes, const LensRays& lens, WindowTime time,
                                  const EgomotionOptions& options) {
  WindowMotion out;
  out.begin_s = secondsSince(time.start_ns, time.begin_ns);
  out.end_s = out.begin_s + options.window_s;
  std::vector<EdgeRow> rows = edgeRows(slopes, lens, time.begin_ns, options);
  out.slopes = rows.size();
  if (static_cast<int>(rows.size()) < options.min_slopes) return out;
  WindowFit fit(std::move(rows), options);
  if (!fit.start(WindowUnknowns::Rotation)) return out;
  fit.refine();
  const double alone = fit.medianSquare();
  if (!fit.start(WindowUnknowns::Both)) return out;
  fit.refine();
  // Equally good, apart from the chance improvement by three more numbers.
  constexpr double kAsWell = 1.05, kNegligible = 0.01;  // squares of sigmas
  out.rotation_alone = alone <= kAsWell * fit.medianSquare() + kNegligible;
  out.inliers = fit.inlierShare();
  out.rate_rad_s = fit.state().rate_rad_s;
  out.covariance = fit.covariance(options.shared_slopes).topLeftCorner<3, 3>();
  weighParts(fit, options.window_s, out);
  const double min_sigma_rad_s = std::sqrt(std::max(0.0, out.covariance.diagonal().minCoeff()));
  if (medianSpeed_px_s(fit, lens.focalLength_px()) < options.min_speed_px_s) {
    out.use = WindowUse::HardlyMoving;
  } else if (out.inliers < options.min_inliers) {
    out.use = WindowUse::NotExplained;
  } else if (!(min_sigma_rad_s < options.max_sigma_rad_s) || !out.covariance.allFinite()) {
    out.use = WindowUse::Uncertain;
  } else {
    out.use = WindowUse::Used;
  }
  return out;
}

void KeptSlopes::add(std::size_t index, std::int64_t begin_ns, std::span<const EdgeSlope> slopes,
                     const EgomotionOptions& options) {
  if (windows_.size() >= static_cast<std::size_t>(options.kept_windows)) {
    every_ *= 2;
    std::erase_if(windows_, [this](const Window& window) { return window.index % every_ != 0; });
  }
  if (index % every_ != 0) return;
  Window& window = windows_.emplace_back();
  window.index = index;
  window.begin_ns = begin_ns;
  const std::size_t step = 1 + slopes.size() / static_cast<std::size_t>(options.kept_slopes);
  window.slopes.reserve(slopes.size() / step + 1);
  for (std::size_t k = 0; k < slopes.size(); k += step) window.slopes.push_back(slopes[k]);
}

}  // namespace evical
