// Quantities that are dropped from what is known, as if they were exactly what they are, or that are one and the same.
#pragma once

#include "core/optimisation/uncertainty/projected_information.h"

#include <Eigen/Core>

#include <vector>

namespace evical {

class KeptColumns {
 public:
  explicit KeptColumns(const ProjectedInformation& all) : first_column_(all.first_column) {}

  // In the order of the quantities; those that are never kept are dropped.
  void keep(std::size_t quantity);
  // A quantity moves with one that is kept, and is as long.
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

  std::vector<Eigen::Index> first_column_;  // of all
  std::vector<std::size_t> quantities_;
  std::vector<Tie> ties_;
};

ProjectedInformation withColumns(const KeptColumns& kept, ProjectedInformation information);

}  // namespace evical
