// A small random generator with the same numbers on every machine, seeded by a few integers at any point, so
// that random numbers do not depend on threads or order. S. Vigna, "splitmix64" (public domain algorithm).
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <numbers>

namespace evical {

class Random {
 public:
  // Different for any difference in the integers.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0, std::uint64_t index = 0)
      : state_(mix(mix(mix(seed) ^ stream) ^ index)) {}

  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15ull); }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }  // [0, 1)
  static constexpr double kLargestNormal = 8.6;  // no normal() is further from 0: sqrt(2 log 2^53)
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  // Uniform numbers, the last one first. Arguments of a constructor would be drawn in an order that depends
  // on the compiler.
  Eigen::Vector2d uniformPair() {
    const double y = uniform(), x = uniform();
    return {x, y};
  }
  Eigen::Vector3d uniformVector() {
    const double z = uniform(), y = uniform(), x = uniform();
    return {x, y, z};
  }
  Eigen::Vector3d normalVector() {
    const double x = normal(), y = normal(), z = normal();
    return {x, y, z};
  }
  double exponential(double mean) { return -mean * std::log(1.0 - uniform()); }

 private:
  static std::uint64_t mix(std::uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
    return (v ^ (v >> 31)) + 0x9e3779b97f4a7c15ull;
  }

  std::uint64_t state_;
};

}  // namespace evical
