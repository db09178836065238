#include "core/data/unit_quaternion.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {

Eigen::Quaterniond unitQuaternion(const YamlNode& node, const Eigen::Vector4d& xyzw,
                                  const std::string& advice) {
  Eigen::Quaterniond rotation(xyzw);
  const double norm = rotation.norm();
  if (!(std::abs(norm - 1.0) < 1e-3))
    throw node.error(fmt::format("is no unit quaternion: its norm is {:.6g}", norm), advice);
  // Dividing only where it matters leaves what we wrote ourselves as it was, to the last bit.
  if (std::abs(norm - 1.0) > 1e-12) rotation.normalize();
  return rotation;
}

}  // namespace evical
