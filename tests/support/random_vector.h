// A vector of random numbers, drawn from the last to the first. As arguments of a constructor they would be
// drawn in an order that depends on the compiler.
#pragma once

#include <Eigen/Core>

namespace evical::test {

template <int Size, class Draw>
Eigen::Matrix<double, Size, 1> randomVector(Draw&& draw) {
  Eigen::Matrix<double, Size, 1> vector;
  for (Eigen::Index k = Size; k-- > 0;) vector(k) = draw();
  return vector;
}

}  // namespace evical::test
