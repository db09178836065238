// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/frame_analysis.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/frames/frame_tracker.h"
#include "core/frames/views_from_frames.h"
#include "core/numerics/robust.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace evical::ui {
namespace {

// Frames around this one that a run would process.
struct Neighbourhood {
  std::vector<std::size_t> before, after;  // the nearest ones, in order of time
  bool due = true;
};

Neighbourhood around(const FrameQuestion& question) {
  const std::vector<std::int64_t> times_ns = question.frames->times_ns();
  FrameRate rate(question.options);
  Neighbourhood found;
  for (std::size_t k = 0; k < times_ns.size() && found.after.empty(); ++k) {
    const bool due = rate.isDue(secondsSince(question.start_ns, times_ns[k]));
    if (k == question.frame) found.due = due;
    if (k == question.frame || !due) continue;
    (k < question.frame ? found.before : found.after).push_back(k);
    if (found.before.size() > question.frames_before) found.before.erase(found.before.begin());
  }
  return found;
}

std::array<double, 2> brightnessOf(const GrayImage& image) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t pixel : image.pixels) ++counts[pixel];
  const auto percentile = [&](double share) {
    std::size_t sum = 0, level = 0;
    while (level < 255 &&
           static_cast<double>(sum += counts[level]) < share * static_cast<double>(image.pixels.size()))
      ++level;
    return static_cast<double>(level);
  };
  return {percentile(0.05), percentile(0.95)};
}

// Motion blur of a view from a tracker without a limit on blur.
double blurOf(const BoardView& view, double exposure_s) {
  std::vector<double> speeds_px_s;
  for (const CircleObservation& point : view.circles) speeds_px_s.push_back(point.velocity_px_s.norm());
  return exposure_s * medianOf(std::move(speeds_px_s));
}

// Tracker over some frames, with one frame in question.
class Tracking {
 public:
  explicit Tracking(const FrameQuestion& question)
      : question_(question), tracker_(question.camera, question.board, unblurred(question.options)) {}

  void pass(std::size_t k) {
    const Frame frame = question_.frames->frame(k);
    const FrameTime time{secondsSince(question_.start_ns, frame.time_ns), frame.exposure_s};
    try {
      const GrayImage image = decodeFrame(frame, question_.camera);
      if (size_.known() && image.size_px != size_) return;
      size_ = image.size_px;
      tracker_.track(image, time);
    } catch (const CalibrationError&) {
      tracker_.skipUnreadable(time);
    }
  }
  BoardObservations finish() { return tracker_.finish(); }
  const FrameTracker& tracker() const { return tracker_; }

 private:
  // Blurred views are shown, too.
  static FrameOptions unblurred(FrameOptions options) {
    options.max_blur_px = std::numeric_limits<double>::infinity();
    return options;
  }

  const FrameQuestion& question_;
  FrameTracker tracker_;
  Resolution size_;
};

void track(const FrameQuestion& question, const Neighbourhood& neighbours, WindowAnalysis& analysis) {
  Tracking tracking(question);
  for (const std::size_t k : neighbours.before) tracking.pass(k);
  tracking.pass(question.frame);
  for (const std::size_t k : neighbours.after) tracking.pass(k);
  const BoardObservations seen = tracking.finish();
  FrameFinding& frame = *analysis.frame;
  frame.doubt = tracking.tracker().doubt();
  frame.remark = tracking.tracker().remark();
  const auto here = [&](const auto& item) { return item.time_s == analysis.time_s; };
  const auto window = std::find_if(seen.windows.begin(), seen.windows.end(), here);
  if (window == seen.windows.end()) return;
  analysis.outcome = window->outcome;
  frame.tracked = window->tracked;
  const auto view = std::find_if(seen.views.begin(), seen.views.end(), here);
  if (view == seen.views.end()) return;
  frame.points = view->circles;
  frame.blur_px = blurOf(*view, frame.exposure_s);
  if (frame.blur_px > question.options.max_blur_px) analysis.outcome = WindowOutcome::Blurred;
}

// Points are shown even if they are too few for a view.
void addPointsOfNoUse(const FrameQuestion& question, const GrayImage& image, FrameFinding& frame) {
  BoardFinder finder(question.board, question.options);
  PointsInFrame found;
  found.points = finder.find(image);
  frame.points = viewsFromFrames({found}, question.board.pointCount()).front().view.circles;
}

std::optional<GrayImage> decoded(const Frame& frame, std::string& problem) {
  try {
    return decodeFrame(frame, "frame");
  } catch (const CalibrationError& error) {
    problem = error.problem();
    return std::nullopt;
  }
}

void lookAt(const FrameQuestion& question, const GrayImage& image, WindowAnalysis& analysis) {
  FrameFinding& frame = *analysis.frame;
  frame.size_px = image.size_px;
  const auto [darkest, brightest] = brightnessOf(image);
  frame.darkest = darkest;
  frame.brightest = brightest;
  try {
    const Neighbourhood neighbours = around(question);
    frame.due = neighbours.due;
    track(question, neighbours, analysis);
    if (frame.points.empty()) addPointsOfNoUse(question, image, frame);
  } catch (const CalibrationError& error) {
    frame.problem = error.place() + " " + error.problem();  // the board's numbers cause none
  }
}

}  // namespace

WindowAnalysis analyseFrame(const FrameQuestion& question) {
  const Stopwatch stopwatch;
  WindowAnalysis analysis;
  const Frame raw = question.frames->frame(question.frame);
  FrameFinding& frame = analysis.frame.emplace();
  frame.number = question.frame + 1;
  frame.count = question.frames_read;
  frame.exposure_s = raw.exposure_s;
  analysis.time_s = secondsSince(question.start_ns, raw.time_ns);
  analysis.half_width_s = 0.5 * raw.exposure_s;
  analysis.outcome = WindowOutcome::NoLattice;
  const std::optional<GrayImage> image = decoded(raw, frame.problem);
  analysis.scene =
      std::make_shared<BoardScene>(question.board, image ? image->size_px : Resolution{}, std::nullopt);
  if (image) {
    lookAt(question, *image, analysis);
  } else {
    analysis.outcome = WindowOutcome::Unreadable;
  }
  analysis.stages = describeFrame(analysis, question.options);
  analysis.took_s = stopwatch.elapsed_s();
  return analysis;
}

bool goesFurther(const WindowAnalysis& analysis) {
  return analysis.outcome == WindowOutcome::NoLattice || analysis.outcome == WindowOutcome::TooFewInGrid ||
         analysis.outcome == WindowOutcome::Partial;
}

QImage pictureOf(const GrayImage& image) {
  QImage picture(image.size_px.width_px, image.size_px.height_px, QImage::Format_RGB32);
  const std::uint8_t* pixel = image.pixels.data();
  for (int y = 0; y < picture.height(); ++y) {
    auto* row = reinterpret_cast<QRgb*>(picture.scanLine(y));
    for (int x = 0; x < picture.width(); ++x, ++pixel) row[x] = qRgb(*pixel, *pixel, *pixel);
  }
  return picture;
}

}  // namespace evical::ui
