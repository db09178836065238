#include "core/pipeline/lens/intrinsics_bootstrap.h"

#include "core/base/time.h"
#include "core/frontend/board_tracker.h"
#include "core/frontend/detection_options.h"
#include "core/intrinsics/estimate_intrinsics.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/pipeline/detection/session_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <limits>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr double kSearched = 0.4;              // share of a slice before the search: bursts on both sides
constexpr int kSolveEvery = 3;                 // slices, once there is a camera model
constexpr std::size_t kMaxEvents = 8'000'000;  // in a slice

// Generic equidistant lenses of one parameter: wide, which suits most boards; no distortion; fisheye; and one
// still wider if a wide model is requested.
std::vector<CameraIntrinsics> genericLenses(Resolution resolution_px, bool wide_model) {
  const double width_px = std::max(resolution_px.width_px, resolution_px.height_px);
  CameraIntrinsics lens;
  lens.resolution_px = resolution_px;
  lens.principal_point_px = 0.5 * Eigen::Vector2d(resolution_px.width_px - 1, resolution_px.height_px - 1);
  std::vector<CameraIntrinsics> lenses(3, lens);
  lenses[0].focal_length_px.setConstant(0.75 * width_px);
  lenses[1].focal_length_px.setConstant(width_px);
  lenses[2].focal_length_px.setConstant(0.45 * width_px);
  lenses[0].model = lenses[2].model = CameraModel::PinholeEquidistant;
  if (!wide_model) return lenses;
  lenses.push_back(lenses[2]);
  lenses.back().focal_length_px.setConstant(0.3 * width_px);
  return lenses;
}

bool isPlane(const CameraIntrinsics& lens) {
  return lens.model == CameraModel::PinholeRadtan && lens.distortion == CameraIntrinsics{}.distortion;
}

// Detections in a slice with one lens.
struct SliceDetections {
  std::vector<SensorView> views;
  std::size_t circles() const {
    std::size_t count = 0;
    for (const SensorView& view : views) count += view.circles.size();
    return count;
  }
};

class IntrinsicsBootstrap {
 public:
  IntrinsicsBootstrap(const Session& session, const RunContext& context)
      : session_(session),
        context_(context),
        options_(*session.options.intrinsics),
        length_ns_(nanosecondsFrom(options_.first_look_length_s)),
        period_ns_(nanosecondsFrom(options_.first_look_period_s)),
        recording_(session),
        resolution_px_(recording_.resolution_px(0)),
        lenses_(genericLenses(resolution_px_, options_.model >= IntrinsicsModel::DoubleSphere)) {
    const double begin_s = session.time_range_s ? session.time_range_s->front() : 0.0;
    slice_begin_ns_ = recording_.start_ns() + nanosecondsFrom(begin_s);
    if (session.time_range_s) end_ns_ = recording_.start_ns() + nanosecondsFrom(session.time_range_s->back());
  }

  std::optional<CameraIntrinsics> run() {
    SensorPacket packet;
    while (!enough() && recording_.read(packet)) {
      context_.throwIfStopped();
      if (packet.events.front().time_ns > end_ns_) break;
      context_.progress.stageProgress(
          std::max(recording_.fractionRead(), static_cast<double>(slices_) / options_.first_look_slices));
      for (const Event& event : packet.events) {
        if (event.time_ns > end_ns_) break;
        consume(event);
      }
    }
    detectInSlice();
    solve();
    return result();
  }

 private:
  bool enough() const {
    return slices_ >= options_.first_look_slices ||
           (estimate_ && estimate_->sigma_px < options_.first_look_projection_px);
  }

  void consume(const Event& event) {
    if (event.time_ns >= slice_begin_ns_ + length_ns_) {
      detectInSlice();
      while (slice_begin_ns_ + length_ns_ <= event.time_ns) slice_begin_ns_ += period_ns_;
    }
    const bool outside = event.x_px >= resolution_px_.width_px || event.y_px >= resolution_px_.height_px;
    const bool late = !slice_.empty() && event.time_ns < slice_.back().time_ns;
    if (event.time_ns < slice_begin_ns_ || outside || late || slice_.size() >= kMaxEvents) return;
    slice_.push_back(event);
  }

  void detectInSlice() {
    if (slice_.empty() || enough()) return;
    std::vector<EdgeCrossing> bursts;
    BurstExtractor extractor(resolution_px_, burstsFor(session_.board, session_.options.front_end->bursts));
    extractor.add(slice_, bursts);
    extractor.finish(bursts);
    slice_.clear();
    SliceDetections detections;
    if (estimate_) detections = detectWith(estimate_->intrinsics, bursts);
    if (detections.views.empty()) {
      detections = detectWithGenericLenses(bursts);
      if (detections.views.empty()) return;
      estimate_.reset();  // it does not show the board that they show
    }
    ++slices_;
    views_.insert(views_.end(), detections.views.begin(), detections.views.end());
    if (!estimate_ || slices_ % kSolveEvery == 0) solve();
  }

  // Tries first the lens that showed most in the last slice, and no others if it shows almost the whole
  // board: failing searches take longest.
  SliceDetections detectWithGenericLenses(const std::vector<EdgeCrossing>& bursts) {
    constexpr double kNearlyAll = 0.75;
    SliceDetections best = detectWith(lenses_.front(), bursts);
    const double all = static_cast<double>(best.views.size()) * session_.board.pointCount();
    if (!best.views.empty() && static_cast<double>(best.circles()) >= kNearlyAll * all) return best;
    std::vector<std::future<SliceDetections>> others;
    for (std::size_t k = 1; k < lenses_.size(); ++k)
      others.push_back(std::async(std::launch::async, [&, k] { return detectWith(lenses_[k], bursts); }));
    std::size_t best_lens = 0;
    for (std::size_t k = 1; k < lenses_.size(); ++k) {
      SliceDetections detections = others[k - 1].get();
      if (detections.circles() <= best.circles()) continue;
      best = std::move(detections);
      best_lens = k;
    }
    std::swap(lenses_.front(), lenses_[best_lens]);
    return best;
  }

  SliceDetections detectWith(const CameraIntrinsics& lens, const std::vector<EdgeCrossing>& bursts) const {
    context_.throwIfStopped();
    const auto camera = isPlane(lens) ? std::nullopt : std::optional(lens);
    FrontEndOptions options = *session_.options.front_end;
    options.detection.search_interval_s = options_.first_look_length_s;  // one search per slice
    BoardTracker tracker(session_.board, resolution_px_, camera, options, recording_.start_ns());
    tracker.addBursts(bursts, slice_begin_ns_ + nanosecondsFrom(kSearched * options_.first_look_length_s),
                      slice_begin_ns_ + length_ns_);
    return {sensorViews(tracker.finish(), session_.board, camera, options_)};
  }

  void solve() {
    constexpr int kMinSlices = 3;  // views of one slice are similar
    if (slices_ < kMinSlices || solved_views_ == views_.size()) return;
    solved_views_ = views_.size();
    auto estimate = roughCamera(views_, session_.board, estimate_ ? estimate_->intrinsics : lenses_.front(),
                                options_, context_);
    if (estimate) estimate_ = std::move(estimate);
  }

  // A lens that shows the board, or parts of it; absent if none did.
  std::optional<CameraIntrinsics> result() const {
    context_.progress.log(
        LogLevel::Debug,
        fmt::format("first look: {} slices, {} views{}", slices_, views_.size(),
                    estimate_ ? fmt::format(", projection sigma {:.2f} px", estimate_->sigma_px)
                              : std::string(", not enough for a camera model")));
    if (estimate_) return estimate_->intrinsics;
    return isPlane(lenses_.front()) ? std::nullopt : std::optional(lenses_.front());
  }

  const Session& session_;
  const RunContext& context_;
  const IntrinsicsOptions& options_;
  std::int64_t length_ns_, period_ns_;  // of the slices
  SessionRecording recording_;
  Resolution resolution_px_;
  std::vector<CameraIntrinsics> lenses_;  // generic ones, first the one that showed most in the last slice
  std::optional<RoughCamera> estimate_;
  std::vector<SensorView> views_;
  std::size_t solved_views_ = 0;
  std::vector<Event> slice_;
  std::int64_t slice_begin_ns_ = 0, end_ns_ = std::numeric_limits<std::int64_t>::max();
  int slices_ = 0;  // with the board in view
};

}  // namespace

std::optional<CameraIntrinsics> bootstrapIntrinsics(const Session& session, const RunContext& context) {
  return IntrinsicsBootstrap(session, context).run();
}

}  // namespace evical
