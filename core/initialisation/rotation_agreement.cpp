#include "core/initialisation/rotation_agreement.h"

#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <algorithm>

namespace evical {
namespace {

struct Turned {
  Eigen::Vector3d seen_rad, felt_rad;
};

double medianNorm(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<double> norms;
  norms.reserve(vectors.size());
  for (const Eigen::Vector3d& vector : vectors) norms.push_back(vector.norm());
  return medianOf(std::move(norms));
}

// Subtracts weighted means.
std::vector<Turned> centred(std::vector<Turned> pairs, const std::vector<double>& weights) {
  Turned mean{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double sum = 0.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    mean.seen_rad += weights[k] * pairs[k].seen_rad;
    mean.felt_rad += weights[k] * pairs[k].felt_rad;
    sum += weights[k];
  }
  for (Turned& pair : pairs) {
    pair.seen_rad -= mean.seen_rad / sum;
    pair.felt_rad -= mean.felt_rad / sum;
  }
  return pairs;
}

// The orthogonal matrix of this determinant that best maps the camera's rotations to the gyroscope's.
Eigen::Matrix3d bestOrthogonal(const std::vector<Turned>& pairs, const std::vector<double>& weights,
                               double determinant) {
  Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < pairs.size(); ++k)
    sums += weights[k] * pairs[k].felt_rad * pairs[k].seen_rad.transpose();
  return bestRotation(sums, determinant).matrix;
}

struct LeftOver {
  double rad = 0.0, share = 1.0;
};

LeftOver leftOver(const std::vector<Turned>& pairs, double determinant) {
  constexpr int kRounds = 8;
  std::vector<double> weights(pairs.size(), 1.0);
  LeftOver left;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Turned> about_means = centred(pairs, weights);
    const Eigen::Matrix3d matrix = bestOrthogonal(about_means, weights, determinant);
    std::vector<Eigen::Vector3d> rest, felt;
    for (const Turned& pair : about_means) {
      rest.push_back(pair.felt_rad - matrix * pair.seen_rad);
      felt.push_back(pair.felt_rad);
    }
    const double scale_rad = std::max(medianNorm(rest), 1e-9);
    for (std::size_t k = 0; k < rest.size(); ++k)
      weights[k] = cauchyWeight(rest[k].squaredNorm() / (scale_rad * scale_rad));
    left = {scale_rad, scale_rad / std::max(medianNorm(felt), 1e-9)};
  }
  return left;
}

}  // namespace

RotationAgreement compareRotations(const std::vector<CameraPose>& poses, const GyroRotation& gyro,
                                   double time_offset_s, const InitialisationOptions& options) {
  std::vector<Turned> turned;
  for (const RotationPair& pair : rotationPairs(poses, options.pair_gap_s, options.max_pair_s)) {
    const double from_s = pair.from_s + time_offset_s, to_s = pair.to_s + time_offset_s;
    if (!gyro.covers(from_s, to_s)) continue;
    turned.push_back({pair.seen_rad, gyro.between(from_s, to_s)});
  }
  RotationAgreement agreement;
  agreement.pairs = static_cast<int>(turned.size());
  if (turned.empty()) return agreement;
  const LeftOver rotation = leftOver(turned, 1.0);
  agreement.rotated = rotation.share;
  agreement.rest_rad = rotation.rad;
  agreement.reflected = leftOver(turned, -1.0).share;
  return agreement;
}

}  // namespace evical
