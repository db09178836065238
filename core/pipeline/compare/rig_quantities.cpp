#include "core/pipeline/compare/rig_quantities.h"

#include "core/data/board_bow.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"
#include "core/numerics/dense.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/weak_priors.h"
#include "core/pipeline/compare/compared_quantities.h"

#include <utility>

namespace evical {
namespace {

QuantityShare shareOf(const QuantityInfo& info) {
  switch (info.id) {
    case QuantityId::Rotation:
    case QuantityId::Translation:
      return info.owner == QuantityOwner::Board ? QuantityShare::Own : QuantityShare::Common;
    case QuantityId::TimeOffset:
      return QuantityShare::Compared;
    case QuantityId::TimeOffsetDrift:
    case QuantityId::EdgeLocalisationBias:
    case QuantityId::SlowEdgeLocalisationBias:
    case QuantityId::GyroscopeBias:
    case QuantityId::AccelerometerBias:
    case QuantityId::Gravity:
      return QuantityShare::Own;
    default:
      return QuantityShare::Common;
  }
}

// Stability as in a check: allowed drift of all numbers together.
double ownStability(const QuantityInfo& info, const CheckOptions& options, const PriorOwner& owner) {
  constexpr double kSheet_m = 1e-4;  // typical bend of a sheet on a board
  if (info.release == QuantityRelease::BoardBow) return kSheet_m / bowHeight_m2(info.id, *owner.board);
  return stabilityOf(info, options).value_or(0.0);
}

void moveValue(const QuantityInfo&, const Eigen::VectorXd& by, double& value) {
  value += by[0];
}
void moveValue(const QuantityInfo&, const Eigen::VectorXd& by, Eigen::Vector3d& value) {
  value += by;
}
void moveValue(const QuantityInfo& info, const Eigen::VectorXd& by, Eigen::Quaterniond& value) {
  const Eigen::Quaterniond turn = quaternionExp(by);
  value = (info.shape == QuantityShape::LocalRotation ? value * turn : turn * value).normalized();
}
void moveValue(const QuantityInfo&, const Eigen::VectorXd& by, Eigen::Matrix3d& value) {
  setQuantityNumbers(quantityNumbers(value) + by, value);
}
void moveValue(const QuantityInfo&, const Eigen::VectorXd& by, std::optional<CameraIntrinsics>& value) {
  Eigen::VectorXd numbers = quantityNumbers(value);
  numbers.head(by.size()) += by;
  value = intrinsicsFrom(numbers.data(), value->model, value->resolution_px);
}

Eigen::MatrixXd informationOf(const Eigen::VectorXd& sigmas) {
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

// Only a given lens has a prior: a lens from the recording adds no information. The information of the
// estimated coefficients is conditional on all others.
void setLensPrior(const OptimisationOptions& options, CameraLens& mean, RigQuantity& quantity) {
  if (!mean.given || !mean.detection_intrinsics) return;
  quantity.prior_information =
      inverseOf(lensPriorCovariance(mean, options)).topLeftCorner(quantity.size(), quantity.size());
  mean.solved = mean.given;
}

class Listing {
 public:
  Listing(const Session& session, const CalibrationState& state, RigQuantities& out)
      : session_(session), state_(state), out_(out) {}

  template <class Kind>
  void addSensor(Kind kind, std::size_t k) {
    const auto& sensor = kind.of(session_)[k];
    const PriorOwner owner{imageHeight_px(sensor, k)};
    forEachQuantity(kind.rows(), [&](const auto& row) {
      add(row, sensor.name, k, owner, kind.of(state_).at(k));
      if (row.info.id == QuantityId::Intrinsics)
        setLensPrior(*session_.options.optimisation, out_.prior_means.cameras[k].lens, out_.all.back());
      else
        setPrior(row, owner, sensor.prior, kind.of(out_.prior_means)[k]);
    });
  }

  void addBoard(std::size_t k) {
    const SessionBoard* const further = k == 0 ? nullptr : &session_.further_boards[k - 1];
    const double spacing_sigma = session_.options.optimisation->board_spacing_sigma;
    const PriorOwner owner{0, further == nullptr ? &session_.board : &further->board,
                           further == nullptr ? spacing_sigma : further->spacing_std.value_or(spacing_sigma)};
    forEachQuantity(kBoardQuantities, [&](const auto& row) {
      if (row.info.relative && further == nullptr) return;
      add(row, further == nullptr ? session_.board_name : further->name, k, owner, state_.boardAt(k));
      setPrior(row, owner, NoPrior{}, out_.prior_means.boardAt(k));
    });
  }

 private:
  // The lens in use has the resolution of the recording, which the session may not give.
  int imageHeight_px(const SessionCamera&, std::size_t camera) const {
    const std::optional<CameraIntrinsics>& lens = state_.cameras.at(camera).lens.inUse();
    return lens ? lens->resolution_px.height_px : session_.sensor(camera).resolution_px.height_px;
  }
  int imageHeight_px(const SessionImu&, std::size_t) const { return 0; }

  template <class Row, class State>
  void add(const Row& row, const std::string& sensor, std::size_t k, const PriorOwner& owner,
           const State& state) {
    const auto& value = row.value(state);
    out_.all.push_back({sensor, &row.info, quantityAddress(row.info, k, value),
                        quantityParts(row.info, value), shareOf(row.info),
                        ownStability(row.info, *session_.options.check, owner)});
  }

  // Adds the batch's prior to the quantity that was added last.
  template <class Row, class Prior, class State>
  void setPrior(const Row& row, const PriorOwner& owner, const Prior& prior, State& mean) {
    RigQuantity& quantity = out_.all.back();
    if (quantity.share != QuantityShare::Common) return;
    if constexpr (Row::kHasPrior)
      if (const auto& known = row.prior(prior)) {
        if (known->isGiven()) return;
        row.value(mean) = known->value;
        quantity.prior_information = informationOf(quantityNumbers(*known->sigma));
        return;
      }
    const std::optional<double> sigma = weakSigma(row.info, *session_.options.optimisation, owner);
    if (!sigma) return;
    const State none;
    row.value(mean) = row.value(none);
    quantity.prior_information = informationOf(Eigen::VectorXd::Constant(quantity.size(), *sigma));
  }

  const Session& session_;
  const CalibrationState& state_;
  RigQuantities& out_;
};

}  // namespace

QuantityAddress RigQuantity::address(std::size_t part) const {
  QuantityAddress number = first;
  number.component += part;
  return number;
}

Eigen::VectorXd RigQuantity::numbers(const CalibrationState& state) const {
  Eigen::VectorXd numbers;
  visitQuantity(first, std::tie(state), [&](const auto& row, const auto& owner) {
    numbers = quantityNumbers(row.value(owner)).head(size());
  });
  return numbers;
}

Eigen::VectorXd RigQuantity::difference(const CalibrationState& a, const CalibrationState& b) const {
  Eigen::VectorXd numbers;
  visitQuantity(first, std::tie(a, b), [&](const auto& row, const auto& in_a, const auto& in_b) {
    numbers = quantityDifference(row.info, row.value(in_a), row.value(in_b)).head(size());
  });
  return numbers;
}

void RigQuantity::move(const Eigen::VectorXd& by, CalibrationState& state) const {
  visitQuantity(first, std::tie(state), [&](const auto& row, auto& owner) {
    auto value = row.value(std::as_const(owner));
    moveValue(row.info, by, value);
    row.value(owner) = value;
  });
}

void RigQuantity::copy(const CalibrationState& from, CalibrationState& to) const {
  visitQuantity(first, std::tie(from, to), [](const auto& row, const auto& source, auto& owner) {
    row.value(owner) = row.value(source);
  });
}

Eigen::MatrixXd RigQuantity::moving(const CalibrationState& at) const {
  if (info->id == QuantityId::Intrinsics)
    return lensCovariance(*at.cameras.at(first.sensor).lens.inUse(), size(), stability);
  return stability * stability * Eigen::MatrixXd::Identity(size(), size());
}

RigQuantities::RigQuantities(const Session& session, const CalibrationState& state) : prior_means(state) {
  Listing listing(session, state, *this);
  forEachSensorKind([&](auto kind) {
    for (std::size_t k = 0; k < kind.of(session).size(); ++k) listing.addSensor(kind, k);
  });
  for (std::size_t k = 0; k <= session.further_boards.size(); ++k) listing.addBoard(k);
}

}  // namespace evical
