#include "core/frontend/circle_pairs.h"

#include "core/numerics/angles.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace evical {
namespace {

constexpr std::size_t kNoPartner = static_cast<std::size_t>(-1);

// Kinds of clusters that are paired in each round.
bool pairedInRound(int round, const EventCluster& leading, const EventCluster& trailing) {
  const bool run = leading.kind == ClusterKind::Run, chase = trailing.kind == ClusterKind::Chase;
  const bool any_lead = leading.kind == ClusterKind::Other, any_trail = trailing.kind == ClusterKind::Other;
  if (round == 0) return run && chase;
  if (round == 1) return (run && any_trail) || (any_lead && chase);
  return any_lead && any_trail;
}

bool othersBetween(const std::vector<EventCluster>& clusters, std::size_t a, std::size_t b) {
  const Eigen::Vector2d middle = 0.5 * (clusters[a].centroid_px + clusters[b].centroid_px);
  const double radius2 = (clusters[a].centroid_px - middle).squaredNorm();
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    if (k != a && k != b && (clusters[k].centroid_px - middle).squaredNorm() < radius2) return true;
  }
  return false;
}

// Motion of a circle from the motion of its edges, n . v = |v_n|; speeds of nearly flat planes are
// unreliable, so large errors are down-weighted.
Eigen::Vector2d circleVelocity(const std::vector<const NormalFlow*>& flows,
                               const Eigen::Vector2d& direction) {
  std::vector<double> speeds;
  for (const NormalFlow* flow : flows) speeds.push_back(flow->velocity_px_s.norm());
  const double typical = medianOf(std::move(speeds));
  Eigen::Vector2d velocity = 1.2 * typical * direction;  // the median of |cos| over an arc is near 0.8
  constexpr int kRounds = 5;
  constexpr double kScale = 0.3;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d matrix = 1e-3 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d vector = Eigen::Vector2d::Zero();
    for (const NormalFlow* flow : flows) {
      const Eigen::Vector2d v = flow->velocity_px_s.cast<double>();
      const double speed = v.norm();
      const Eigen::Vector2d n = v / speed;
      const double error = (speed - n.dot(velocity)) / (kScale * typical);
      const double w = cauchyWeight(error * error);
      matrix += w * n * n.transpose();
      vector += w * speed * n;
    }
    velocity = matrix.ldlt().solve(vector);
  }
  return velocity;
}

// x^2 + y^2 = 2 c . p + k through the pixels moved to the window's middle.
std::optional<CircleCandidate> fitCircle(const std::vector<const NormalFlow*>& flows,
                                         const Eigen::Vector2d& origin, const Eigen::Vector2d& velocity) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  const auto atMiddle = [&](const NormalFlow& flow) -> Eigen::Vector2d {
    return Eigen::Vector2d(flow.x_px, flow.y_px) - origin - flow.time_s * velocity;
  };
  for (const NormalFlow* flow : flows) {
    const Eigen::Vector2d p = atMiddle(*flow);
    const Eigen::Vector3d row(2.0 * p.x(), 2.0 * p.y(), 1.0);
    matrix += row * row.transpose();
    vector += p.squaredNorm() * row;
  }
  const Eigen::Vector3d solution = matrix.ldlt().solve(vector);
  const Eigen::Vector2d centre = solution.head<2>();
  const double radius2 = solution.z() + centre.squaredNorm();
  if (!solution.allFinite() || !(radius2 > 0.0)) return std::nullopt;
  CircleCandidate circle;
  circle.centre_px = origin + centre;
  circle.radius_px = std::sqrt(radius2);
  circle.speed_px_s = velocity.norm();
  circle.direction = velocity / circle.speed_px_s;
  for (const NormalFlow* flow : flows) {
    circle.score += std::abs((atMiddle(*flow) - centre).norm() - circle.radius_px) < 1.0 ? 1.0 : 0.0;
  }
  circle.score /= 2.0 * M_PI * circle.radius_px;
  return circle;
}

std::optional<CircleCandidate> circleOf(const EventCluster& leading, const EventCluster& trailing,
                                        const NormalFlowField& field, const FrontEndOptions& options) {
  std::vector<const NormalFlow*> flows;
  for (const EventCluster* cluster : {&leading, &trailing}) {
    for (const std::uint32_t i : cluster->flows) flows.push_back(&field[i]);
  }
  const Eigen::Vector2d direction = (leading.direction + trailing.direction).normalized();
  const Eigen::Vector2d velocity = circleVelocity(flows, direction);
  if (!(velocity.norm() > 1e-6)) return std::nullopt;
  const Eigen::Vector2d middle = 0.5 * (leading.centroid_px + trailing.centroid_px);
  std::optional<CircleCandidate> circle = fitCircle(flows, middle, velocity);
  if (!circle || circle->radius_px < options.detection.min_radius_px ||
      circle->radius_px > options.detection.max_radius_px)
    return std::nullopt;
  return circle;
}

// Best partner of each unpaired cluster, and its distance.
struct Partner {
  std::size_t cluster = kNoPartner;
  double distance_px = std::numeric_limits<double>::infinity();

  void offer(std::size_t other, double distance) {
    if (distance >= distance_px) return;
    cluster = other;
    distance_px = distance;
  }
};

bool moveAlike(const EventCluster& leading, const EventCluster& trailing, const FrontEndOptions& options) {
  const double cosine = std::cos(options.normal_flow.max_pair_angle_deg * kRadPerDeg);
  const Eigen::Vector2d line = leading.centroid_px - trailing.centroid_px;
  const double length = line.norm();
  return length > 0.0 && length <= 2.0 * options.detection.max_radius_px &&
         leading.direction.dot(trailing.direction) >= cosine &&
         leading.direction.dot(line) >= cosine * length && trailing.direction.dot(line) >= cosine * length;
}

}  // namespace

std::vector<ArcPair> pairClusters(const std::vector<EventCluster>& clusters, const NormalFlowField& field,
                                  const FrontEndOptions& options) {
  constexpr int kRounds = 3;
  std::vector<ArcPair> pairs;
  std::vector<bool> paired(clusters.size(), false);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Partner> partners(clusters.size());
    for (std::size_t a = 0; a < clusters.size(); ++a) {
      if (!clusters[a].leading || paired[a]) continue;
      for (std::size_t b = 0; b < clusters.size(); ++b) {
        if (clusters[b].leading || paired[b] || !pairedInRound(round, clusters[a], clusters[b])) continue;
        if (!moveAlike(clusters[a], clusters[b], options) || othersBetween(clusters, a, b)) continue;
        const double distance = (clusters[a].centroid_px - clusters[b].centroid_px).norm();
        partners[a].offer(b, distance);
        partners[b].offer(a, distance);
      }
    }
    for (std::size_t a = 0; a < clusters.size(); ++a) {
      const std::size_t b = partners[a].cluster;
      if (!clusters[a].leading || b == kNoPartner || partners[b].cluster != a) continue;
      paired[a] = paired[b] = true;
      if (const auto circle = circleOf(clusters[a], clusters[b], field, options)) {
        pairs.push_back({a, b, *circle});
      }
    }
  }
  return pairs;
}

NormalFlowStages findArcs(const BurstWindow& window, const FrontEndOptions& options) {
  NormalFlowStages stages;
  stages.flow = estimateNormalFlow(ActiveEventSurface(window, options.normal_flow.plane_radius_px),
                                   options.normal_flow);
  stages.clusters = clusterFlow(stages.flow, window.resolution_px(), options.normal_flow);
  stages.pairs = pairClusters(stages.clusters, stages.flow, options);
  return stages;
}

std::vector<CircleCandidate> pairArcs(const BurstWindow& window, const FrontEndOptions& options) {
  std::vector<CircleCandidate> candidates;
  for (const ArcPair& pair : findArcs(window, options).pairs) candidates.push_back(pair.circle);
  std::sort(candidates.begin(), candidates.end(),
            [](const CircleCandidate& a, const CircleCandidate& b) { return a.score > b.score; });
  return candidates;
}

}  // namespace evical
