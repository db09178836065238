#include "core/initialisation/pose_consistency.h"

#include "core/numerics/robust.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace evical {
namespace {

constexpr double kMostNeighbours = 120.0;  // enough for a vote
// Mirrored poses agree with each other for a while, as long as the viewing direction is constant; since their
// circles fit worse, they have a lower weight.
constexpr double kSecondChoice = 0.5;

// world_from_first by either pose of one view.
struct Carried {
  Eigen::Quaterniond first, second;
  bool has_second = false;
};

double angle(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(a.dot(b))));
}

struct Vote {
  int neighbours = 0;
  double for_first = 0.0, for_second = 0.0;
};

Vote voteOn(const std::vector<Carried>& carried, const std::vector<CameraPose>& poses, std::size_t k,
            double least_cosine, double window_s) {
  const auto agreement = [&](const Eigen::Quaterniond& a, const Carried& other) {
    if (std::abs(a.dot(other.first)) > least_cosine) return 1.0;
    return other.has_second && std::abs(a.dot(other.second)) > least_cosine ? kSecondChoice : 0.0;
  };
  const auto earlier = [](const CameraPose& pose, double time_s) { return pose.time_s < time_s; };
  const auto begin =
      std::lower_bound(poses.begin(), poses.end(), poses[k].time_s - window_s, earlier) - poses.begin();
  const auto end =
      std::lower_bound(poses.begin(), poses.end(), poses[k].time_s + window_s, earlier) - poses.begin();
  const double stride = std::max(1.0, static_cast<double>(end - begin) / kMostNeighbours);
  Vote vote;
  for (auto position = static_cast<double>(begin); position < static_cast<double>(end); position += stride) {
    const auto n = static_cast<std::size_t>(position);
    if (n == k) continue;
    ++vote.neighbours;
    vote.for_first += agreement(carried[k].first, carried[n]);
    if (carried[k].has_second) vote.for_second += agreement(carried[k].second, carried[n]);
  }
  return vote;
}

double medianStep(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                  const RelativeRotation& hand_eye) {
  std::vector<double> steps;
  std::optional<Eigen::Quaterniond> before;
  for (const CameraPose& pose : poses) {
    const Eigen::Quaterniond here = pose.world_from_camera.rotation *
                                    hand_eye.reference_from_sensor.conjugate() *
                                    gyro.at(pose.time_s + hand_eye.time_offset_s).conjugate();
    if (before) steps.push_back(angle(*before, here));
    before = here;
  }
  return medianOf(std::move(steps));
}

}  // namespace

PoseConsistency keepConsistentPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                    const RelativeRotation& hand_eye, const InitialisationOptions& options) {
  const double least_cosine = std::cos(0.5 * options.largest_rotation_disagreement_rad);
  std::vector<Carried> carried;
  for (const CameraPose& pose : poses) {
    const Eigen::Quaterniond back = hand_eye.reference_from_sensor.conjugate() *
                                    gyro.at(pose.time_s + hand_eye.time_offset_s).conjugate();
    Carried c{pose.world_from_camera.rotation * back, Eigen::Quaterniond::Identity()};
    c.has_second = pose.other_world_from_camera.has_value();
    if (c.has_second) c.second = pose.other_world_from_camera->rotation * back;
    carried.push_back(c);
  }
  PoseConsistency result;
  std::vector<CameraPose> kept;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double time_s = poses[k].time_s + hand_eye.time_offset_s;
    const Vote vote = voteOn(carried, poses, k, least_cosine, options.agreement_window_s);
    // Outside the gyroscope's samples, or without neighbours, no decision is possible.
    const bool judged = gyro.covers(time_s, time_s) && vote.neighbours > 0;
    if (judged && std::max(vote.for_first, vote.for_second) < options.least_agreement * vote.neighbours) {
      ++result.dropped;
      continue;
    }
    kept.push_back(poses[k]);
    if (judged && vote.for_second > vote.for_first) {
      std::swap(kept.back().world_from_camera, *kept.back().other_world_from_camera);
      ++result.swapped;
    }
  }
  poses = std::move(kept);
  result.usual_rad = medianStep(poses, gyro, hand_eye);
  return result;
}

}  // namespace evical
