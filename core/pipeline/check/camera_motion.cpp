#include "core/pipeline/check/camera_motion.h"

#include <span>
#include <utility>

namespace evical {

CameraMotion::CameraMotion(const CameraIntrinsics& lens, const CalibrationOptions& options,
                           std::int64_t start_ns)
    : lens_(lens),
      options_(*options.egomotion),
      start_ns_(start_ns),
      slopes_(lens.resolution_px, *options.edge_slopes, options.egomotion->window_s,
              [this](std::int64_t begin_ns, std::span<const EdgeSlope> slopes) {
                std::vector<WindowMotion>& windows = record_.windows;
                windows.push_back(estimateWindowMotion(slopes, lens_, {start_ns_, begin_ns}, options_));
                if (windows.back().use == WindowUse::Used)
                  record_.slopes.add(windows.size() - 1, begin_ns, slopes, options_);
              }) {}

CameraRecord CameraMotion::finish() {
  slopes_.finish();
  return std::move(record_);
}

}  // namespace evical
