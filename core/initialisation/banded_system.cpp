#include "core/initialisation/banded_system.h"

#include <algorithm>
#include <cmath>

namespace evical {

void BandedMatrix::addOuter(Eigen::Index first, const Eigen::Vector4d& weights, double scale) {
  for (int i = 0; i < kBand; ++i) {
    for (int j = 0; j <= i; ++j) rows_(i - j, first + i) += scale * weights(i) * weights(j);
  }
}

bool BandedMatrix::factorise() {
  for (Eigen::Index i = 0; i < size(); ++i) {
    const auto reach = static_cast<int>(std::min<Eigen::Index>(kBand - 1, i));
    for (int d = reach; d >= 0; --d) {
      const Eigen::Index j = i - d;
      double sum = rows_(d, i);
      const auto shared = static_cast<int>(std::min<Eigen::Index>(kBand - 1 - d, j));
      for (int s = 1; s <= shared; ++s) sum -= rows_(d + s, i) * rows_(s, j);
      if (d > 0) {
        rows_(d, i) = sum / rows_(0, j);
      } else if (sum > 0.0) {
        rows_(0, i) = std::sqrt(sum);
      } else {
        return false;
      }
    }
  }
  return true;
}

void BandedMatrix::solveInPlace(Eigen::Ref<Eigen::MatrixXd> right) const {
  for (Eigen::Index c = 0; c < right.cols(); ++c) {
    auto x = right.col(c);
    for (Eigen::Index i = 0; i < size(); ++i) {
      double sum = x(i);
      for (int d = 1; d < kBand && d <= i; ++d) sum -= rows_(d, i) * x(i - d);
      x(i) = sum / rows_(0, i);
    }
    for (Eigen::Index i = size() - 1; i >= 0; --i) {
      double sum = x(i);
      for (int d = 1; d < kBand && i + d < size(); ++d) sum -= rows_(d, i + d) * x(i + d);
      x(i) = sum / rows_(0, i);
    }
  }
}

}  // namespace evical
