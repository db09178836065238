#include "core/optimisation/uncertainty/schur_columns.h"

#include <cassert>
#include <utility>

namespace evical {

void KeptColumns::keep(std::size_t quantity) {
  quantities_.push_back(quantity);
  ties_.push_back({quantity, quantity});
}

void KeptColumns::tie(std::size_t quantity, std::size_t to_kept) {
  assert(sizeOf(quantity) == sizeOf(to_kept));
  ties_.push_back({quantity, to_kept});
}

Eigen::MatrixXd KeptColumns::allFromKept() const {
  std::vector<Eigen::Index> first(first_column_.size(), -1);
  Eigen::Index columns = 0;
  for (const std::size_t quantity : quantities_) {
    first[quantity] = columns;
    columns += sizeOf(quantity);
  }
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(first_column_.back(), columns);
  for (const Tie& tie : ties_) {
    const Eigen::Index size = sizeOf(tie.quantity);
    matrix.block(first_column_[tie.quantity], first[tie.to], size, size).setIdentity();
  }
  return matrix;
}

ProjectedInformation withColumns(const KeptColumns& kept, ProjectedInformation information) {
  const Eigen::MatrixXd all_from_kept = kept.allFromKept();
  std::vector<Quantity> quantities;
  std::vector<Eigen::Index> first_column = {0};
  for (const std::size_t quantity : kept.quantities()) {
    quantities.push_back(information.quantities[quantity]);
    first_column.push_back(first_column.back() + information.first_column[quantity + 1] -
                           information.first_column[quantity]);
  }
  information.quantities = std::move(quantities);
  information.first_column = std::move(first_column);
  const auto reduceMatrix = [&](Eigen::MatrixXd& matrix) {
    matrix = (all_from_kept.transpose() * matrix * all_from_kept).eval();
  };
  const auto reduceVector = [&](Eigen::VectorXd& vector) {
    vector = (all_from_kept.transpose() * vector).eval();
  };
  reduceMatrix(information.total);
  reduceMatrix(information.from_noise);
  reduceVector(information.gradient);
  for (MeasurementGroup& group : information.groups) reduceMatrix(group.information);
  for (Eigen::VectorXd& score : information.scores) reduceVector(score);
  for (Eigen::MatrixXd& share : information.information_by_stretch) reduceMatrix(share);
  for (Eigen::VectorXd& effect : information.pixel_errors) reduceVector(effect);
  for (ClusterScatter& each : information.clusters) reduceMatrix(each.scatter);
  if (information.drift_by_quantities.size() > 0)
    information.drift_by_quantities = (information.drift_by_quantities * all_from_kept).eval();
  return information;
}

}  // namespace evical
