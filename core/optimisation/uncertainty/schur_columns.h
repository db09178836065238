// Quantities that are removed from the information, as if known exactly, or that are tied to others.
#pragma once

#include "core/optimisation/uncertainty/projected_information.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

class KeptColumns {
 public:
  explicit KeptColumns(const ProjectedInformation& all) : first_column_(all.first_column) {}

  // In the order of the quantities; those that are not kept are removed.
  void keep(std::size_t quantity);
  // Ties a quantity to a kept one of equal size.
  void tie(std::size_t quantity, std::size_t to_kept);

  const std::vector<std::size_t>& quantities() const { return quantities_; }
  // d(all columns) / d(kept ones).
  Eigen::MatrixXd allFromKept() const;

 private:
  struct Tie {
    std::size_t quantity, to;
  };

  Eigen::Index sizeOf(std::size_t quantity) const {
    return first_column_[quantity + 1] - first_column_[quantity];
  }

  std::vector<Eigen::Index> first_column_;  // of all quantities
  std::vector<std::size_t> quantities_;
  std::vector<Tie> ties_;
};

ProjectedInformation withColumns(const KeptColumns& kept, ProjectedInformation information);

// Noise-corrected information: in directions without motion, noise in the trajectory's rates looks like
// motion and would count as a measurement.

// Subtracts a multiple of the noise's contribution from the measurements' information and from the scores,
// direction by direction. If nothing remains, only priors count. Recordings with motion hardly change.
ProjectedInformation withoutNoise(ProjectedInformation information);

}  // namespace evical
