#include "core/optimisation/unknown_columns.h"

#include "core/optimisation/calibration_problem.h"

#include <ceres/problem.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace evical {
namespace {

constexpr Eigen::Index kNoColumn = std::numeric_limits<Eigen::Index>::max();

Unknown sizedBlock(ceres::Problem& problem, double* block) {
  Unknown unknown;
  unknown.values = block;
  unknown.size = problem.ParameterBlockSize(block);
  return unknown;
}

Unknown freeBlock(ceres::Problem& problem, double* block) {
  Unknown unknown = sizedBlock(problem, block);
  unknown.columns = problem.ParameterBlockTangentSize(block);
  unknown.manifold = problem.GetManifold(block);
  unknown.leading =
      unknown.manifold == nullptr || dynamic_cast<const So3Manifold*>(unknown.manifold) != nullptr;
  constexpr double kUnbounded = std::numeric_limits<double>::max();
  std::vector<double> lower, upper;
  for (int i = 0; i < unknown.size; ++i) {
    lower.push_back(problem.GetParameterLowerBound(block, i));
    upper.push_back(problem.GetParameterUpperBound(block, i));
  }
  const auto below = [](double bound) { return bound > -kUnbounded; };
  const auto above = [](double bound) { return bound < kUnbounded; };
  if (std::any_of(lower.begin(), lower.end(), below) || std::any_of(upper.begin(), upper.end(), above)) {
    unknown.lower = std::move(lower);
    unknown.upper = std::move(upper);
  }
  return unknown;
}

}  // namespace

UnknownColumns::UnknownColumns(CalibrationProblem& problem) {
  addUnknowns(problem);
  addBlocks(problem);
  makeParts();
}

void UnknownColumns::addUnknowns(CalibrationProblem& problem) {
  for (double* block : problem.splineBlocks()) {
    Unknown& unknown = unknowns_.emplace_back(freeBlock(problem.problem(), block));
    unknown.spline = true;
    unknown.first = spline_size_;
    spline_size_ += unknown.columns;
  }
  Eigen::Index border = 0;
  const auto add = [&](double* block) {
    Unknown& unknown = unknowns_.emplace_back(freeBlock(problem.problem(), block));
    unknown.first = border;
    border += unknown.columns;
  };
  for (const Quantity& quantity : problem.quantities()) {
    first_column_.push_back(border);
    add(quantity.block);
  }
  first_column_.push_back(border);
  for (const Quantity& knot : problem.driftBlocks()) add(knot.block);
  drift_size_ = border - first_column_.back();
}

void UnknownColumns::addBlocks(CalibrationProblem& problem) {
  std::unordered_map<const double*, std::int32_t> index_of;
  for (std::size_t i = 0; i < unknowns_.size(); ++i)
    index_of[unknowns_[i].values] = static_cast<std::int32_t>(i);
  std::vector<double*> values;
  for (const BlockInfo& info : problem.blocks()) {
    problem.problem().GetParameterBlocksForResidualBlock(info.id, &values);
    Block block{problem.problem().GetCostFunctionForResidualBlock(info.id), info.view,
                unknown_indices_.size(), 0, kNoColumn};
    for (double* const each : values) {
      const auto [found, is_new] = index_of.try_emplace(each, static_cast<std::int32_t>(unknowns_.size()));
      if (is_new) {
        assert(problem.problem().IsParameterBlockConstant(each));
        unknowns_.push_back(sizedBlock(problem.problem(), each));
      }
      unknown_indices_.push_back(found->second);
      const Unknown& unknown = unknowns_[static_cast<std::size_t>(found->second)];
      if (!unknown.spline) continue;
      block.first_column = std::min(block.first_column, unknown.first);
      block.last_column = std::max(block.last_column, unknown.first + unknown.columns - 1);
    }
    block.end = unknown_indices_.size();
    if (block.last_column >= 0)
      half_bandwidth_ = std::max(half_bandwidth_, block.last_column - block.first_column);
    blocks_.push_back(block);
  }
}

void UnknownColumns::makeParts() {
  constexpr std::size_t kParts = 16;  // enough to balance two threads, few enough to keep sums cheap
  order_.resize(blocks_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return blocks_[a].first_column < blocks_[b].first_column;
  });
  const std::size_t length = (order_.size() + kParts - 1) / kParts;
  for (std::size_t begin = 0; begin < order_.size(); begin += length) {
    const std::size_t end = std::min(begin + length, order_.size());
    const Eigen::Index next = end < order_.size() ? blocks_[order_[end]].first_column : kNoColumn;
    parts_.push_back({begin, end, std::min(blocks_[order_[begin]].first_column, spline_size_),
                      std::min(next, spline_size_)});
  }
}

std::span<const std::int32_t> UnknownColumns::unknownsOf(std::size_t block) const {
  return {unknown_indices_.data() + blocks_[block].begin, unknown_indices_.data() + blocks_[block].end};
}

Eigen::VectorXd UnknownNumbers::read() const {
  std::vector<double> numbers;
  for (const Unknown& each : columns_.unknowns())
    if (each.columns > 0) numbers.insert(numbers.end(), each.values, each.values + each.size);
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

void UnknownNumbers::write(const Eigen::VectorXd& numbers) const {
  const double* next = numbers.data();
  for (const Unknown& each : columns_.unknowns()) {
    if (each.columns == 0) continue;
    std::copy_n(next, each.size, each.values);
    next += each.size;
  }
}

void UnknownNumbers::writeMoved(const Eigen::VectorXd& numbers, const Eigen::VectorXd& step) const {
  const double* from = numbers.data();
  for (const Unknown& each : columns_.unknowns()) {
    if (each.columns == 0) continue;
    const double* const by = step.data() + columns_.firstOf(each);
    if (each.manifold != nullptr) {
      each.manifold->Plus(from, by, each.values);
    } else {
      for (int i = 0; i < each.size; ++i) each.values[i] = from[i] + by[i];
    }
    for (std::size_t i = 0; i < each.lower.size(); ++i)
      each.values[i] = std::clamp(each.values[i], each.lower[i], each.upper[i]);
    from += each.size;
  }
}

}  // namespace evical
