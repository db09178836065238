#include "core/pipeline/compare/repeated_estimates.h"

#include "core/data/pixel_delay.h"
#include "core/geometry/so3.h"
#include "core/numerics/dense.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/calibration_options.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace evical {
namespace {

using Indices = std::vector<Eigen::Index>;

// Address of the first of the two tilts of gravity's direction.
constexpr QuantityAddress kGravityDirection{QuantityOwner::Rig, 0, QuantityId::Gravity, 0};
constexpr QuantityAddress kGravityNorm{QuantityOwner::Rig, 0, QuantityId::Gravity, 2};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Estimate of a recording with its common values and covariance replaced by those of all recordings: its own
// values follow from its normal equations (docs/maths.md, 14).
struct FollowingEstimate {
  std::vector<QuantityAddress> columns;  // the recording's, then common ones that it does not estimate
  Eigen::VectorXd by;                    // changes of the recording's own numbers; 0 for common ones
  Eigen::MatrixXd covariance;
};

struct Following {
  Indices columns, unknowns;         // columns of a report, and their indices among all common ones
  Eigen::MatrixXd as_weighed, gain;  // of the recording; derivative of all common ones by its own
  Eigen::VectorXd moved;             // changes of those that it estimates
};

// Computes the result from the recording's numbers and the joint common ones: own - by_common (alone -
// joint), and joint.
FollowingEstimate followingEstimate(const UncertaintyReport& report, const Following& following,
                                    const CombinedEstimate& joint,
                                    const std::vector<QuantityAddress>& unknown_columns) {
  FollowingEstimate out;
  out.columns = report.columns;
  Indices further;
  for (std::size_t u = 0; u < unknown_columns.size(); ++u)
    if (std::ranges::count(following.unknowns, static_cast<Eigen::Index>(u)) == 0) {
      further.push_back(static_cast<Eigen::Index>(u));
      out.columns.push_back(unknown_columns[u]);
    }
  const auto size = static_cast<Eigen::Index>(report.columns.size());
  const Eigen::Index all = size + static_cast<Eigen::Index>(further.size());
  const Eigen::MatrixXd by_common =
      product(following.as_weighed(Eigen::all, following.columns),
              inverseOf(following.as_weighed(following.columns, following.columns)));
  Eigen::MatrixXd from_own = Eigen::MatrixXd::Zero(all, size),
                  from_joint = Eigen::MatrixXd::Zero(all, joint.value.size());
  from_own.topRows(size).setIdentity();
  for (std::size_t k = 0; k < following.columns.size(); ++k) {
    const auto column = by_common.col(static_cast<Eigen::Index>(k));
    from_own.col(following.columns[k]).head(size) -= column;
    from_joint.col(following.unknowns[k]).head(size) += column;
  }
  for (std::size_t k = 0; k < following.columns.size(); ++k) {
    from_own.row(following.columns[k]).setZero();
    from_joint.row(following.columns[k]).setZero();
    from_joint(following.columns[k], following.unknowns[k]) = 1.0;
  }
  for (std::size_t k = 0; k < further.size(); ++k)
    from_joint(size + static_cast<Eigen::Index>(k), further[k]) = 1.0;
  const Eigen::MatrixXd covariance = report.covariance();
  // The joint values contain the recording's own errors through the gain.
  const Eigen::MatrixXd between =
      productTransposed(covariance(Eigen::all, following.columns), following.gain);
  const Eigen::MatrixXd mixed = product(product(from_own, between), from_joint.transpose());
  out.covariance =
      congruence(from_own, covariance) + congruence(from_joint, joint.covariance) + mixed + mixed.transpose();
  out.by = Eigen::VectorXd::Zero(all);
  out.by.head(size) = by_common * following.moved;
  for (const Eigen::Index column : following.columns) out.by[column] = 0.0;
  return out;
}

void setReport(const FollowingEstimate& estimate, UncertaintyReport& report) {
  constexpr double kMin = 1e-300;
  report.columns = estimate.columns;
  report.standard_deviations = estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = report.standard_deviations.cwiseMax(kMin).cwiseInverse();
  report.correlation = inverse.asDiagonal() * estimate.covariance * inverse.asDiagonal();
  report.correlation.diagonal().setOnes();
}

// Numbers of a quantity among `all`; empty if one is missing.
Eigen::VectorXd partsOf(const RigQuantity& quantity, const std::vector<QuantityAddress>& columns,
                        const Eigen::VectorXd& all) {
  Eigen::VectorXd parts(quantity.size());
  for (std::size_t k = 0; k < quantity.parts.size(); ++k) {
    const auto column = columnOf(quantity.address(k), columns);
    if (!column) return {};
    parts[static_cast<Eigen::Index>(k)] = all[*column];
  }
  return parts;
}

void moveGravity(const FollowingEstimate& estimate, CalibrationState& state) {
  const auto first = columnOf(kGravityDirection, estimate.columns);
  if (!first) return;
  Eigen::Vector3d& gravity = state.gravity_in_world_m_s2;
  const auto norm = columnOf(kGravityNorm, estimate.columns);
  const double new_norm = gravity.norm() + (norm ? estimate.by[*norm] : 0.0);
  const Eigen::Vector3d turned =
      gravity + gravity.norm() * (gravityTilts(gravity) * estimate.by.segment<2>(*first));
  gravity = new_norm * turned.normalized();
}

}  // namespace

RepeatedEstimates::RepeatedEstimates(const Session& session, std::vector<RecordedEstimate> recorded)
    : session_(session), recorded_(std::move(recorded)), quantities_(session, resultOf(0).state) {
  for (const RigQuantity& quantity : quantities_.all) {
    const auto tells = [&](const RecordedEstimate& each) {
      return columnOf(quantity.first, each.result->uncertainty.columns).has_value();
    };
    if (quantity.share != QuantityShare::Common || quantity.parts.empty() ||
        std::none_of(recorded_.begin(), recorded_.end(), tells))
      continue;
    unknowns_.push_back({&quantity, static_cast<Eigen::Index>(columns_.size())});
    for (std::size_t part = 0; part < quantity.parts.size(); ++part)
      columns_.push_back(quantity.address(part));
  }
  linearise(resultOf(0).state);
  std::vector<std::size_t> everyone(recorded_.size());
  for (std::size_t k = 0; k < everyone.size(); ++k) everyone[k] = k;
  // Linearise again at the solution, the reference of rotations and priors.
  linearise(moved(combination_->combine(everyone).value, at_));
}

std::vector<Eigen::Index> RepeatedEstimates::columnsOf(std::size_t recording) const {
  Indices columns;
  for (const Eigen::Index unknown : estimated_[recording])
    columns.push_back(
        *columnOf(columns_[static_cast<std::size_t>(unknown)], resultOf(recording).uncertainty.columns));
  return columns;
}

Eigen::MatrixXd RepeatedEstimates::asWeighed(std::size_t recording) const {
  const Eigen::MatrixXd& known = recorded_[recording].as_weighed;
  return known.size() > 0 ? known : resultOf(recording).uncertainty.covariance();
}

void RepeatedEstimates::linearise(const CalibrationState& at) {
  at_ = at;
  const auto size = static_cast<Eigen::Index>(columns_.size());
  CommonKnowledge known{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size),
                        Eigen::MatrixXd::Zero(size, size)};
  for (const Unknowns& each : unknowns_) {
    const Eigen::Index count = each.quantity->size();
    known.moving.block(each.first, each.first, count, count) = each.quantity->moving(at_);
    if (each.quantity->prior_information.size() == 0) continue;
    known.information.block(each.first, each.first, count, count) = each.quantity->prior_information;
    known.value.segment(each.first, count) = each.quantity->difference(quantities_.prior_means, at_);
  }
  std::vector<PartialEstimate> estimates;
  estimated_.clear();
  for (std::size_t k = 0; k < recorded_.size(); ++k) {
    Eigen::VectorXd values(size);
    for (const Unknowns& each : unknowns_)
      values.segment(each.first, each.quantity->size()) = each.quantity->difference(resultOf(k).state, at_);
    Indices& estimated = estimated_.emplace_back();
    for (Eigen::Index u = 0; u < size; ++u)
      if (columnOf(columns_[static_cast<std::size_t>(u)], resultOf(k).uncertainty.columns))
        estimated.push_back(u);
    const Indices columns = columnsOf(k);
    estimates.push_back({estimated, values(estimated), inverseOf(asWeighed(k)(columns, columns)),
                         resultOf(k).uncertainty.covariance()(columns, columns)});
  }
  combination_.emplace(estimates, std::move(known));
  varying_.clear();
  for (std::size_t k = 0; k < recorded_.size(); ++k) varying_.push_back(combination_->varyingSigmas(k));
}

CalibrationState RepeatedEstimates::moved(const Eigen::VectorXd& by, CalibrationState state) const {
  for (const Unknowns& each : unknowns_)
    each.quantity->move(by.segment(each.first, each.quantity->size()), state);
  return state;
}

EstimateDistance RepeatedEstimates::distance(std::size_t one, std::span<const std::size_t> others) const {
  return combination_->distance(one, others);
}

CalibrationResult RepeatedEstimates::joint(std::span<const std::size_t> chosen) const {
  const std::size_t last = chosen.back();
  const CalibrationResult& own = resultOf(last);
  const CombinedEstimate combined = combination_->combine(chosen);
  Eigen::VectorXd moved_by(static_cast<Eigen::Index>(estimated_[last].size()));
  for (const Unknowns& each : unknowns_) {
    const Eigen::VectorXd was = each.quantity->difference(own.state, at_);
    for (Eigen::Index k = 0; k < was.size(); ++k) {
      const auto estimated = std::ranges::find(estimated_[last], each.first + k);
      if (estimated != estimated_[last].end())
        moved_by[estimated - estimated_[last].begin()] = combined.value[each.first + k] - was[k];
    }
  }
  const FollowingEstimate estimate = followingEstimate(
      own.uncertainty,
      {columnsOf(last), estimated_[last], asWeighed(last), combination_->gain(last, chosen), moved_by},
      combined, columns_);
  CalibrationResult joint;
  joint.start_ns = own.start_ns;
  joint.state = own.state;
  joint.state.world_from_imu_rotation = {};
  joint.state.imu_in_world_m = {};
  for (const Unknowns& each : unknowns_) each.quantity->copy(at_, joint.state);
  joint.state = moved(combined.value, std::move(joint.state));
  joint.uncertainty = own.uncertainty;
  setReport(estimate, joint.uncertainty);
  for (const RigQuantity& quantity : quantities_.all)
    if (const Eigen::VectorXd by = partsOf(quantity, estimate.columns, estimate.by);
        by.size() > 0 && quantity.share != QuantityShare::Common)
      quantity.move(by, joint.state);
  moveGravity(estimate, joint.state);
  setSigmas(joint.uncertainty);
  // These belong to one recording and are no longer valid.
  joint.uncertainty.observability.clear();
  joint.uncertainty.directions.clear();
  joint.uncertainty.weakest.clear();
  for (std::size_t k = 0; k < session_.cameras.size(); ++k) {
    const std::size_t sensor = session_.sensorOf(k);
    if (sensor == k || !session_.options.optimisation->share_sensors) continue;
    joint.state.cameras[k].reference_from_camera = joint.state.cameras[sensor].reference_from_camera;
    joint.state.cameras[k].lens.solved = joint.state.cameras[sensor].lens.solved;
    joint.uncertainty.cameras[k].rotation_std_rad = joint.uncertainty.cameras[sensor].rotation_std_rad;
    joint.uncertainty.cameras[k].translation_std_m = joint.uncertainty.cameras[sensor].translation_std_m;
    joint.uncertainty.cameras[k].intrinsics_std = joint.uncertainty.cameras[sensor].intrinsics_std;
  }
  return joint;
}

double RepeatedEstimates::varyingSigma(std::size_t recording, const RigQuantity& quantity,
                                       std::size_t part) const {
  const auto unknown = columnOf(quantity.address(part), columns_);
  if (unknown) {
    const auto estimated = std::ranges::find(estimated_[recording], *unknown);
    return varying_[recording][estimated - estimated_[recording].begin()];
  }
  // The sigmas of time offsets include the effect of light on pixel delays, which is the same in all
  // recordings.
  const UncertaintyReport& report = resultOf(recording).uncertainty;
  const double sigma = report.standard_deviations[*columnOf(quantity.address(part), report.columns)];
  if (!quantity.info->is(QuantityOwner::Camera, QuantityId::TimeOffset) ||
      !holdsPixelDelay(recorded_[recording].cameras, quantity.first.sensor, !session_.imus.empty()))
    return sigma;
  return std::sqrt(withoutPixelDelay_s2(sigma * sigma, 1e-3 * session_.options.optimisation->pixel_delay_ms));
}

void RepeatedEstimates::fillStatistics(std::span<const std::size_t> chosen, const CalibrationResult& joint,
                                       const RigQuantity& quantity, RepeatedQuantity& shown) const {
  const double factor = quantity.info->shown_factor;
  Eigen::VectorXd means = Eigen::VectorXd::Zero(quantity.size());
  for (std::size_t part = 0; part < quantity.parts.size(); ++part) {
    const auto i = static_cast<Eigen::Index>(part);
    RepeatedNumber& number = shown.numbers[part];
    std::vector<double> values;
    double variances = 0.0;
    for (const std::size_t k : chosen) {
      if (std::isnan(number.values[k])) continue;
      values.push_back(quantity.difference(resultOf(k).state, at_)[i]);
      variances += std::pow(varyingSigma(k, quantity, part), 2);
    }
    number.count = static_cast<int>(values.size());
    if (values.empty()) continue;
    const auto count = static_cast<double>(values.size());
    for (const double value : values) means[i] += value / count;
    double squares = 0.0;
    for (const double value : values) squares += std::pow(value - means[i], 2);
    if (values.size() > 1) number.deviation = factor * std::sqrt(squares / (count - 1.0));
    number.mean_sigma = factor * std::sqrt(variances / count);
  }
  CalibrationState mean = at_;
  quantity.move(means, mean);
  const Eigen::VectorXd mean_numbers = quantity.numbers(mean), joint_numbers = quantity.numbers(joint.state);
  for (std::size_t part = 0; part < quantity.parts.size(); ++part) {
    const auto i = static_cast<Eigen::Index>(part);
    RepeatedNumber& number = shown.numbers[part];
    number.mean = factor * mean_numbers[i];
    const auto column = columnOf(quantity.address(part), joint.uncertainty.columns);
    if (!shown.common || !column) continue;
    number.joint = factor * joint_numbers[i];
    number.joint_sigma = factor * joint.uncertainty.standard_deviations[*column];
  }
}

std::vector<RepeatedQuantity> RepeatedEstimates::quantities(std::span<const std::size_t> chosen) const {
  std::vector<RepeatedQuantity> shown;
  const CalibrationResult together = joint(chosen);
  for (const RigQuantity& quantity : quantities_.all) {
    if (quantity.share == QuantityShare::Own || quantity.parts.empty()) continue;
    RepeatedQuantity row{quantity.sensor,
                         quantity.info->name,
                         quantity.info->title,
                         quantity.share == QuantityShare::Common,
                         {}};
    bool estimated = false;
    const double factor = quantity.info->shown_factor;
    for (std::size_t part = 0; part < quantity.parts.size(); ++part) {
      RepeatedNumber& number = row.numbers.emplace_back();
      number.name = quantity.parts[part].name;
      number.unit = quantity.parts[part].shown_unit;
      for (const RecordedEstimate& each : recorded_) {
        const CalibrationResult* const result = each.result.get();
        const auto column = columnOf(quantity.address(part), result->uncertainty.columns);
        estimated = estimated || column;
        number.values.push_back(
            column ? factor * quantity.numbers(result->state)[static_cast<Eigen::Index>(part)] : kNone);
        number.sigmas.push_back(column ? factor * result->uncertainty.standard_deviations[*column] : kNone);
      }
    }
    if (!estimated) continue;
    fillStatistics(chosen, together, quantity, row);
    shown.push_back(std::move(row));
  }
  return shown;
}

}  // namespace evical
