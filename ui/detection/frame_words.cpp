// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/numerics/robust.h"
#include "ui/detection/frame_analysis.h"
#include "ui/detection/print.h"

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

bool isOfUse(const WindowAnalysis& analysis) {
  return analysis.outcome == WindowOutcome::Complete || analysis.outcome == WindowOutcome::Partial;
}

std::string whichText(const FrameFinding& frame) {
  std::string text = print("%zu of %zu", frame.number, frame.count);
  if (frame.size_px.known()) text += print(", %d x %d px", frame.size_px.width_px, frame.size_px.height_px);
  return text + (frame.exposure_s > 0.0 ? print(", exposed for %.2f ms", 1e3 * frame.exposure_s)
                                        : std::string(", exposure unknown"));
}

StageReport pictureStage(const WindowAnalysis& analysis, const FrameOptions& options) {
  const FrameFinding& frame = *analysis.frame;
  const double contrast = frame.brightest - frame.darkest;
  const bool pale = !isOfUse(analysis) && contrast < options.min_contrast;
  std::string text =
      print("90 %% of the pixels are between %.0f and %.0f of 255", frame.darkest, frame.brightest);
  if (pale) text += print(": too little contrast (min_contrast is %.0f)", options.min_contrast);
  return {"picture", pale ? StageVerdict::Failed : StageVerdict::Passed, text};
}

StageReport searchStage(const WindowAnalysis& analysis) {
  const FrameFinding& frame = *analysis.frame;
  if (frame.points.empty())
    return {"search", StageVerdict::Failed,
            "no board at the place predicted from previous frames, nor elsewhere in the frame"};
  return {"search", StageVerdict::Passed,
          frame.tracked ? "tracked from previous frames" : "found by a search of the whole frame"};
}

StageReport pointsStage(const WindowAnalysis& analysis, const FrameOptions& options) {
  const std::vector<CircleObservation>& points = analysis.frame->points;
  const int count = analysis.scene->board.pointCount();
  if (points.empty()) return {"points", StageVerdict::NotReached, "not reached"};
  std::string text = print("%zu of %d", points.size(), count);
  if (analysis.outcome == WindowOutcome::TooFewInGrid)
    return {"points", StageVerdict::Failed,
            text + print(": at least %.0f needed (min_points is %.2f)",
                         std::max(4.0, std::ceil(options.min_points * count)), options.min_points)};
  std::vector<double> sigmas_px;
  for (const CircleObservation& point : points)
    sigmas_px.push_back(std::sqrt(0.5 * point.covariance_px2.trace()));
  text += print(", sigma %.3f px", medianOf(std::move(sigmas_px)));
  return {"points", StageVerdict::Passed, text};
}

StageReport blurStage(const WindowAnalysis& analysis, const FrameOptions& options) {
  const FrameFinding& frame = *analysis.frame;
  const bool blurred = analysis.outcome == WindowOutcome::Blurred;
  if (!isOfUse(analysis) && !blurred) return {"blur", StageVerdict::NotReached, "not reached"};
  if (!(frame.exposure_s > 0.0))
    return {"blur", StageVerdict::Note, "unknown: the recording does not contain the exposure"};
  return {"blur", blurred ? StageVerdict::Failed : StageVerdict::Passed,
          print("the board moves %.2f px during the exposure (max_blur_px is %.1f)", frame.blur_px,
                options.max_blur_px)};
}

}  // namespace

std::vector<StageReport> describeFrame(const WindowAnalysis& analysis, const FrameOptions& options) {
  const FrameFinding& frame = *analysis.frame;
  std::vector<StageReport> stages{{"frame", StageVerdict::Note, whichText(frame)}};
  if (!frame.due)
    stages.push_back(
        {"rate", StageVerdict::Note, print("not used by a run (frames.rate_hz is %g)", options.rate_hz)});
  if (!frame.problem.empty()) {
    stages.push_back({frame.size_px.known() ? "board" : "picture", StageVerdict::Failed, frame.problem});
    return stages;
  }
  stages.push_back(pictureStage(analysis, options));
  stages.push_back(searchStage(analysis));
  stages.push_back(pointsStage(analysis, options));
  stages.push_back(blurStage(analysis, options));
  if (!frame.remark.empty()) stages.push_back({"print", StageVerdict::Note, frame.remark});
  if (!frame.doubt.empty()) stages.push_back({"board", StageVerdict::Failed, frame.doubt});
  return stages;
}

}  // namespace evical::ui
