#include "core/data/unit_quaternion.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {

Eigen::Quaterniond unitQuaternion(const YamlNode& node, const Eigen::Vector4d& xyzw,
                                  const std::string& advice) {
  Eigen::Quaterniond rotation(xyzw);
  const double norm = rotation.norm();
  if (!(std::abs(norm - 1.0) < 1e-3))
    throw node.error(fmt::format("is not a unit quaternion: its norm is {:.6g}", norm), advice);
  // Normalised only if necessary, so that the values of our own files stay bit-identical.
  if (std::abs(norm - 1.0) > 1e-12) rotation.normalize();
  return rotation;
}

}  // namespace evical
