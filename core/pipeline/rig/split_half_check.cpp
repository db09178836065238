#include "core/pipeline/rig/split_half_check.h"

#include "core/base/error.h"
#include "core/base/in_parallel.h"
#include "core/base/time.h"
#include "core/data/quantity_difference.h"
#include "core/numerics/angles.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/circle_errors.h"
#include "core/optimisation/uncertainty/covariance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace evical {
namespace {

class Blocks {
 public:
  Blocks(const CalibrationState& state, double block_s)
      : start_s_(state.world_from_imu_rotation.start_s),
        knot_s_(state.world_from_imu_rotation.knot_spacing_s) {
    const double duration_s = state.world_from_imu_rotation.endTime_s() - start_s_;
    const int pairs = std::max(2, static_cast<int>(std::lround(0.5 * duration_s / block_s)));
    length_s_ = knot_s_ * std::ceil(state.world_from_imu_rotation.segmentCount() / (2.0 * pairs));
  }

  double length_s() const { return length_s_; }

  // Half of a time; -1: too close to a border.
  int halfAt(double time_s, double margin_knots) const {
    const double place = (time_s - start_s_) / length_s_;
    const double block = std::floor(place);
    const double margin = margin_knots * knot_s_ / length_s_;
    if (place - block < margin || block + 1.0 - place < margin) return -1;
    return static_cast<int>(std::abs(static_cast<long>(block)) % 2);
  }

 private:
  double start_s_, knot_s_, length_s_ = 0.0;
};

constexpr double kMargin_knots = 0.5;  // for shifts by a time offset

std::vector<BoardView> viewsOfHalf(const BoardObservations& all, const CameraState& camera,
                                   const Blocks& blocks, int half) {
  std::vector<BoardView> views;
  for (const BoardView& view : all.views) {
    BoardView part{view.time_s, view.kind, {}};
    part.circles.reserve(view.circles.size());  // most views are in one half
    std::ranges::copy_if(view.circles, std::back_inserter(part.circles),
                         [&](const CircleObservation& circle) {
                           return blocks.halfAt(circleTime_s(camera, circle), kMargin_knots) == half;
                         });
    if (!part.circles.empty()) views.push_back(std::move(part));
  }
  return views;
}

std::vector<ImuSample> samplesOfHalf(const CalibrationInput& input, std::size_t imu, const ImuState& state,
                                     const Blocks& blocks, int half) {
  const double margin_knots = imu == input.reference_imu ? 0.0 : kMargin_knots;
  std::vector<ImuSample> samples;
  samples.reserve(input.imus[imu].samples.size() / 2);
  // With a delay, the force of a sample may belong to one side of a border and the rate to the other.
  std::ranges::copy_if(input.imus[imu].samples, std::back_inserter(samples), [&](const ImuSample& sample) {
    const double stamp_s = secondsSince(input.start_ns, sample.time_ns);
    return blocks.halfAt(referenceTime_s(state, stamp_s), margin_knots) == half &&
           blocks.halfAt(accelerometerTime_s(state, stamp_s), margin_knots) == half;
  });
  return samples;
}

// Estimate from one half.
struct Half {
  CalibrationState state;
  UncertaintyReport uncertainty;
};

Half estimateHalf(const CalibrationInput& input, const CalibrationState& solved,
                  const OptimisationOptions& options, const RunContext& context) {
  for (const CameraData& camera : input.cameras)
    if (camera.observations.views.empty())
      throw calibrationFailed(camera.name, "the board is not visible in one half of the recording");
  Half half;
  BatchSolution solution = refineBatch(input, solved, options, context);
  half.uncertainty = estimateSigmas(input, solution, options, context);
  half.state = std::move(solution.state);
  return half;
}

// Both halves in parallel need as much additional memory as the whole recording. Long recordings (over four
// minutes of one camera at usual rates) are estimated one half after the other.
bool atTheSameTime(const CalibrationInput& input) {
  constexpr std::size_t kMany = 250'000;
  std::size_t circles = 0;
  for (const CameraData& camera : input.cameras)
    for (const BoardView& view : camera.observations.views) circles += view.circles.size();
  return circles < kMany;
}

// Options of a half. Board and gravity are the same in both halves, mostly from priors: their errors are part
// of the sigmas but would not appear as differences. Parallel halves share the threads.
OptimisationOptions ofHalves(OptimisationOptions options, bool both) {
  options.free_board_size = options.free_gravity_norm = false;
  if (both) options.threads = std::max(1, options.threads / 2);
  return options;
}

Estimate estimateOf(const CalibrationInput& input, const Half& half) {
  const CalibrationState& state = half.state;
  Estimate estimate;
  estimate.cameras = state.cameras;
  estimate.imus = state.imus;
  estimate.gravity_in_world_m_s2 = state.gravity_in_world_m_s2;
  estimate.uncertainty = half.uncertainty;
  estimate.board_names.clear();
  estimate.boards.clear();
  for (std::size_t i = 0; i < input.boardCount(); ++i) {
    estimate.board_names.push_back(input.boardName(i));
    estimate.boards.push_back(state.boardAt(i));
  }
  for (const CameraData& camera : input.cameras) estimate.camera_names.push_back(camera.name);
  for (const ImuData& imu : input.imus) estimate.imu_names.push_back(imu.name);
  estimate.reference =
      input.imus.empty() ? input.cameras[input.reference_camera].name : input.imus[input.reference_imu].name;
  return estimate;
}

std::vector<QuantityDifference> differences(const CalibrationInput& input,
                                            const std::array<Half, 2>& halves) {
  Estimate even = estimateOf(input, halves[0]);
  const Estimate odd = estimateOf(input, halves[1]);
  even.uncertainty = differenceUncertainty(even.uncertainty, odd.uncertainty);
  std::vector<QuantityDifference> all = difference(even, odd);
  if (input.imus.empty()) return all;
  // Length of two tilts with this sigma each.
  const double sigma_rad = std::sqrt(2.0) * even.uncertainty.gravity_direction_std_rad;
  all.push_back({"gravity.direction", "deg", kDegPerRad * gravityDirectionDifference_rad(even, odd),
                 kDegPerRad * sigma_rad});
  return all;
}

}  // namespace

CalibrationInput halfOf(const CalibrationInput& input, const CalibrationState& state, double block_s,
                        int half) {
  const Blocks blocks(state, block_s);
  CalibrationInput part;
  part.start_ns = input.start_ns;
  part.board_name = input.board_name;
  part.board = input.board;
  part.further_boards = input.further_boards;
  part.reference_imu = input.reference_imu;
  part.reference_camera = input.reference_camera;
  part.gravity_norm_m_s2 = input.gravity_norm_m_s2;
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    const CameraData& camera = input.cameras[i];
    BoardObservations& seen = part.cameras
                                  .emplace_back(CameraData{camera.name,
                                                           camera.lens,
                                                           {},
                                                           camera.prior,
                                                           camera.shutter,
                                                           camera.same_sensor_as,
                                                           camera.board})
                                  .observations;
    seen.camera = camera.name;
    seen.kind = camera.observations.kind;
    seen.views = viewsOfHalf(camera.observations, state.cameras[i], blocks, half);
  }
  for (std::size_t i = 0; i < input.imus.size(); ++i) {
    const ImuData& imu = input.imus[i];
    part.imus.push_back(
        {imu.name, imu.noise, samplesOfHalf(input, i, state.imus[i], blocks, half), imu.prior});
  }
  return part;
}

SplitHalfCheck checkHalves(const CalibrationInput& input, const CalibrationState& solved,
                           const OptimisationOptions& options, double block_s, const RunContext& context) {
  SplitHalfCheck validation;
  validation.block_s = Blocks(solved, block_s).length_s();
  const bool both = atTheSameTime(input);
  const OptimisationOptions of_halves = ofHalves(options, both);
  const RunContext quiet{silentProgress(), context.stop};
  std::array<Half, 2> halves;
  std::array<std::string, 2> failures;
  std::atomic<int> done = 0;
  inParallel(both ? options.threads : 1, 2, [&](std::size_t half) {
    try {
      const CalibrationInput part = halfOf(input, solved, block_s, static_cast<int>(half));
      for (const CameraData& camera : part.cameras)
        validation.windows[half] += static_cast<int>(camera.observations.views.size());
      halves[half] = estimateHalf(part, solved, of_halves, quiet);
    } catch (const CalibrationError& error) {
      failures[half] = error.what();
    }
    context.progress.stageProgress(0.5 * ++done);
  });
  for (const std::string& failure : failures)
    if (validation.failure.empty()) validation.failure = failure;
  if (!validation.failure.empty()) return validation;
  validation.quantities = differences(input, halves);
  validation.rms_sigmas = normalisedRms(validation.quantities);
  return validation;
}

}  // namespace evical
