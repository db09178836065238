// Rotation and time offset from all kept edges of all windows at once (docs/maths.md, 16.4). In each window
// the gyroscope gives the camera's rotation, and only its velocity and the depths are estimated. Internal to
// this folder.
#pragma once

#include "core/base/progress.h"
#include "core/egomotion/alignment_fit.h"
#include "core/egomotion/camera_record.h"
#include "core/egomotion/integrated_rates.h"
#include "core/egomotion/lens_rays.h"
#include "core/egomotion/turning_model.h"
#include "core/egomotion/window_fit.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace evical {

struct JointInput {
  const CameraRecord& record;  // used windows covered by the gyroscope
  const LensRays& lens;
  const SummedRates& rates;
  Eigen::Matrix3d imu_from_measured;
  std::int64_t start_ns;  // of the recording
  int threads;
  const RunContext& context;  // for stop requests and progress
};

class JointFit {
 public:
  // `still`: without translation, as if all image motion were rotation.
  JointFit(const JointInput& input, const EgomotionOptions& options, bool still = false);

  // Gauss-Newton from `state`. False if it does not converge. Progress goes from `from` to `to`. Throws
  // Cancelled.
  bool solve(AlignmentState& state, double from, double to);

  // A window's part of the normal equations at the last solution: velocity and depths are eliminated.
  struct Part {
    JointMatrix normal = JointMatrix::Zero();
    JointVector right = JointVector::Zero();
    double middle_s = 0.0;
  };
  const std::vector<Part>& parts() const { return parts_; }
  const JointMatrix& normal() const { return normal_; }  // their sum, with the priors

 private:
  void expectVelocities();
  std::optional<WindowFit> fitWindow(std::size_t k, const TurningModel& model, const WindowRates& rates);
  void findPart(std::size_t k, const AlignmentState& state);
  JointVector sumParts(const AlignmentState& state);

  const JointInput& input_;
  EgomotionOptions options_;
  bool still_;
  double velocity_information_;
  std::vector<const KeptSlopes::Window*> windows_;
  std::vector<WindowState> states_;
  std::vector<Part> parts_;
  JointMatrix normal_ = JointMatrix::Zero();
};

}  // namespace evical
