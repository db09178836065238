#include "core/pipeline/compare/rig_quantities.h"

#include "core/data/board_bow.h"
#include "core/geometry/intrinsics_numbers.h"
#include "core/geometry/so3.h"
#include "core/numerics/dense.h"
#include "core/optimisation/lens_prior.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/compare/compared_quantities.h"

#include <fmt/format.h>

#include <type_traits>
#include <utility>

namespace evical {
namespace {

QuantityShare shareOf(const QuantityInfo& info) {
  switch (info.need) {
    case QuantityNeed::Rotation:
    case QuantityNeed::Translation:
      return QuantityShare::Common;
    case QuantityNeed::TimeOffset:
      return QuantityShare::Compared;
    case QuantityNeed::None:
      break;
  }
  switch (info.release) {
    case QuantityRelease::ImuIntrinsics:
    case QuantityRelease::GyroscopeRotation:
    case QuantityRelease::BoardSize:
    case QuantityRelease::BoardBow:
    case QuantityRelease::LineDelay:
    case QuantityRelease::ExposureShare:
      return QuantityShare::Common;
    default:
      return info.shape == QuantityShape::Intrinsics ? QuantityShare::Common : QuantityShare::Own;
  }
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

// As the tables have states and their sensors; of one table all sensors are of one type.
template <class Sensor>
using SensorIn = std::function<Sensor&(CalibrationState&)>;
template <class Uncertainty>
using UncertaintyIn = std::function<Uncertainty&(UncertaintyReport&)>;

template <class Sensor, class Uncertainty>
struct Place {
  std::string name;
  SensorIn<Sensor> sensor;
  UncertaintyIn<Uncertainty> uncertainty;
};

template <class Value>
void copyValue(const Value& from, Value& to) {
  to = from;
}

// Reading changes nothing, but the tables' members are found in states that could be changed.
template <class Sensor>
const Sensor& sensorOf(const SensorIn<Sensor>& sensor, const CalibrationState& state) {
  return sensor(const_cast<CalibrationState&>(state));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

// As a check takes it: the stability is what all numbers together may move by.
double stabilityOf(const QuantityInfo& info, const CheckOptions& options) {
  if (info.need == QuantityNeed::Rotation || info.release == QuantityRelease::GyroscopeRotation)
    return kRadPerDeg * options.stability_rotation_deg;
  if (info.need == QuantityNeed::Translation) return 1e-3 * options.stability_translation_mm;
  if (info.shape == QuantityShape::UpperTriangle) return options.stability_imu_scale;
  if (info.release == QuantityRelease::ImuIntrinsics) return 1e-3 * options.stability_time_offset_ms;
  return info.release == QuantityRelease::BoardSize ? kStableSheet : 0.0;
}

template <class Row, class Sensor, class Uncertainty>
RigQuantity quantityOf(const Row& row, const Place<Sensor, Uncertainty>& place, const CalibrationState& state,
                       const CheckOptions& options) {
  RigQuantity quantity;
  quantity.sensor = place.name;
  quantity.info = &row.info;
  quantity.share = shareOf(row.info);
  quantity.parts = quantityParts(row.info, row.value(sensorOf(place.sensor, state)));
  for (const QuantityPart& part : quantity.parts)
    quantity.names.push_back(fmt::format("{}.{} [{}]", place.name, part.name, part.unit));
  const auto count = static_cast<Eigen::Index>(quantity.parts.size());
  const SensorIn<Sensor> sensor = place.sensor;
  const UncertaintyIn<Uncertainty> uncertainty = place.uncertainty;
  const Row* const of = &row;
  quantity.numbers = [=](const CalibrationState& in) -> Eigen::VectorXd {
    return quantityNumbers(of->value(sensorOf(sensor, in))).head(count);
  };
  quantity.difference = [=](const CalibrationState& a, const CalibrationState& b) -> Eigen::VectorXd {
    return quantityDifference(of->info, of->value(sensorOf(sensor, a)), of->value(sensorOf(sensor, b)))
        .head(count);
  };
  quantity.setSigmas = [=](const Eigen::VectorXd& sigmas, UncertaintyReport& report) {
    Eigen::VectorXd all = sigmas;
    if (of->info.shape == QuantityShape::Intrinsics) {
      all = Eigen::VectorXd::Zero(kIntrinsicsCount);
      all.head(count) = sigmas;
    }
    setQuantityNumbers(all, of->sigma(uncertainty(report)));
  };
  if constexpr (std::is_same_v<std::remove_cvref_t<decltype(row.value_at)>, LensIntrinsics>) {
    quantity.move = [=](const Eigen::VectorXd& by, CalibrationState& in) {
      CameraLens& lens = sensor(in).lens;
      Eigen::VectorXd numbers = quantityNumbers(lens.inUse());
      numbers.head(count) += by;
      lens.solved = intrinsicsFrom(numbers.data(), lens.inUse()->model, lens.inUse()->resolution_px);
    };
    quantity.copy = [=](const CalibrationState& from, CalibrationState& to) {
      sensor(to).lens.solved = sensorOf(sensor, from).lens.inUse();
    };
  } else {
    quantity.move = [=](const Eigen::VectorXd& by, CalibrationState& in) {
      moveValue(of->info, by, of->value(sensor(in)));
    };
    quantity.copy = [=](const CalibrationState& from, CalibrationState& to) {
      copyValue(of->value(sensorOf(sensor, from)), of->value(sensor(to)));
    };
  }
  const double stability = stabilityOf(row.info, options);
  quantity.moving = [=](const CalibrationState&) -> Eigen::MatrixXd {
    return stability * stability * Eigen::MatrixXd::Identity(count, count);
  };
  return quantity;
}

Eigen::MatrixXd informationOf(const Eigen::VectorXd& sigmas) {
  return sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
}

// Around one value, for all numbers alike.
template <class Row, class Sensor, class Value>
WeighedPrior around(const Row& row, const SensorIn<Sensor>& sensor, const Value& value,
                    const Eigen::VectorXd& sigmas) {
  const Row* const of = &row;
  return {informationOf(sigmas), [=](const CalibrationState& from) -> Eigen::VectorXd {
            return quantityDifference(of->info, value, of->value(sensorOf(sensor, from)));
          }};
}

class Priors {
 public:
  Priors(const Session& session, const CalibrationState& state)
      : session_(session), options_(*session.options.optimisation), state_(state) {}

  // As the batch has them (prior_residuals.cpp).
  template <class Row>
  std::optional<WeighedPrior> ofCamera(const Row& row, std::size_t k,
                                       const SensorIn<CameraState>& sensor) const {
    if constexpr (Row::kHasPrior)
      if (const auto& known = row.prior(session_.cameras[k].prior))
        return known->isGiven() ? std::nullopt : weighed(row, *known, sensor);
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(row.value_at)>, LensIntrinsics>)
      return ofLens(state_.cameras[k].lens, sensor);
    else if constexpr (std::is_same_v<decltype(row.value(std::declval<CameraState&>())), double&>) {
      if (row.info.release == QuantityRelease::LineDelay)
        return around(row, sensor, 0.0,
                      Eigen::VectorXd::Constant(
                          1, 1e3 * options_.longest_readout_ms / session_.sensor(k).resolution_px.height_px));
      if (row.info.release == QuantityRelease::ExposureShare)
        return around(row, sensor, 0.0, Eigen::VectorXd::Constant(1, options_.exposure_share_sigma));
    } else if constexpr (std::is_same_v<decltype(row.value(std::declval<CameraState&>())), Eigen::Vector3d&>)
      return ofTranslation(row, sensor);
    return std::nullopt;
  }

  template <class Row>
  std::optional<WeighedPrior> ofImu(const Row& row, std::size_t k, const SensorIn<ImuState>& sensor) const {
    if constexpr (Row::kHasPrior)
      if (const auto& known = row.prior(session_.imus[k].prior))
        return known->isGiven() ? std::nullopt : weighed(row, *known, sensor);
    using Value = decltype(row.value(std::declval<ImuState&>()));
    if constexpr (std::is_same_v<Value, Eigen::Matrix3d&>)
      return around(row, sensor, Eigen::Matrix3d(Eigen::Matrix3d::Identity()),
                    Eigen::VectorXd::Constant(6, options_.mapping_sigma));
    if constexpr (std::is_same_v<Value, double&>)
      if (row.info.release == QuantityRelease::ImuIntrinsics)
        return around(row, sensor, 0.0, Eigen::VectorXd::Constant(1, options_.accelerometer_delay_sigma_s));
    if constexpr (std::is_same_v<Value, Eigen::Quaterniond&>)
      if (row.info.release == QuantityRelease::GyroscopeRotation)
        return around(row, sensor, Eigen::Quaterniond(Eigen::Quaterniond::Identity()),
                      Eigen::VectorXd::Constant(3, kRadPerDeg * options_.gyroscope_rotation_sigma_deg));
    if constexpr (std::is_same_v<Value, Eigen::Vector3d&>) return ofTranslation(row, sensor);
    return std::nullopt;
  }

  template <class Row>
  std::optional<WeighedPrior> ofBoard(const Row& row, std::size_t index,
                                      const SensorIn<BoardState>& sensor) const {
    const Board& board = index == 0 ? session_.board : session_.further_boards[index - 1].board;
    double spacing_sigma = options_.board_spacing_sigma;
    if (index > 0) spacing_sigma = session_.further_boards[index - 1].spacing_std.value_or(spacing_sigma);
    if (row.info.release == QuantityRelease::BoardBow)
      return around(
          row, sensor, 0.0,
          Eigen::VectorXd::Constant(1, 1e-3 * options_.board_bow_sigma_mm / bowHeight_m2(row.info, board)));
    const bool is_scale = &row.info == &quantityInfo(kBoardQuantities, &BoardState::scale);
    return around(row, sensor, is_scale ? 1.0 : 0.0,
                  Eigen::VectorXd::Constant(1, is_scale ? spacing_sigma : boardStretchSigma(spacing_sigma)));
  }

 private:
  template <class Row, class Sensor, class Known>
  std::optional<WeighedPrior> weighed(const Row& row, const Known& known,
                                      const SensorIn<Sensor>& sensor) const {
    return around(row, sensor, known.value, quantityNumbers(*known.sigma));
  }

  template <class Row, class Sensor>
  std::optional<WeighedPrior> ofTranslation(const Row& row, const SensorIn<Sensor>& sensor) const {
    if (row.info.need != QuantityNeed::Translation) return std::nullopt;
    return around(row, sensor, Eigen::Vector3d(Eigen::Vector3d::Zero()),
                  Eigen::VectorXd::Constant(3, options_.translation_sigma_m));
  }

  // Of a lens that each recording finds first, priors lie around what that recording itself says: they say nothing of
  // their own.
  std::optional<WeighedPrior> ofLens(const CameraLens& lens, const SensorIn<CameraState>& sensor) const {
    if (!lens.given || !lens.seen_with) return std::nullopt;
    const auto count = static_cast<Eigen::Index>(4 + distortionCount(*lens.seen_with));
    const Eigen::VectorXd given = quantityNumbers(lens.given).head(count);
    // Coefficients that the model does without are held, which is what the others' information is for.
    return WeighedPrior{inverseOf(lensPriorCovariance(lens, options_)).topLeftCorner(count, count),
                        [=](const CalibrationState& from) -> Eigen::VectorXd {
                          return given - quantityNumbers(sensorOf(sensor, from).lens.inUse()).head(count);
                        }};
  }

  const Session& session_;
  const OptimisationOptions& options_;
  const CalibrationState& state_;
};

}  // namespace

std::vector<RigQuantity> rigQuantities(const Session& session, const CalibrationState& state) {
  std::vector<RigQuantity> all;
  const Priors priors(session, state);
  for (std::size_t k = 0; k < session.cameras.size(); ++k) {
    const Place<CameraState, CameraUncertainty> place{
        session.cameras[k].name, [k](CalibrationState& in) -> CameraState& { return in.cameras.at(k); },
        [k](UncertaintyReport& in) -> CameraUncertainty& { return in.cameras.at(k); }};
    forEachQuantity(kCameraQuantities, [&](const auto& row) {
      all.push_back(quantityOf(row, place, state, *session.options.check));
      RigQuantity& quantity = all.back();
      if (quantity.share != QuantityShare::Common) return;
      quantity.prior = priors.ofCamera(row, k, place.sensor);
      if (row.info.shape == QuantityShape::Intrinsics)
        quantity.moving = [k, count = static_cast<Eigen::Index>(quantity.parts.size()),
                           rms_px = session.options.check->stability_lens_px](const CalibrationState& at) {
          return lensCovariance(*at.cameras.at(k).lens.inUse(), count, rms_px);
        };
    });
  }
  for (std::size_t k = 0; k < session.imus.size(); ++k) {
    const Place<ImuState, ImuUncertainty> place{
        session.imus[k].name, [k](CalibrationState& in) -> ImuState& { return in.imus.at(k); },
        [k](UncertaintyReport& in) -> ImuUncertainty& { return in.imus.at(k); }};
    forEachQuantity(kImuQuantities, [&](const auto& row) {
      all.push_back(quantityOf(row, place, state, *session.options.check));
      if (all.back().share == QuantityShare::Common) all.back().prior = priors.ofImu(row, k, place.sensor);
    });
  }
  for (std::size_t k = 0; k <= session.further_boards.size(); ++k) {
    const Place<BoardState, BoardUncertainty> place{
        k == 0 ? session.board_name : session.further_boards[k - 1].name,
        [k](CalibrationState& in) -> BoardState& { return in.boardAt(k); },
        [k](UncertaintyReport& in) -> BoardUncertainty& { return in.boardAt(k); }};
    if (k > 0)
      forEachQuantity(kBoardQuantities, [&](const auto& row) {
        if (row.info.relative) all.push_back(quantityOf(row, place, state, *session.options.check));
      });
    forEachSheetQuantity([&](const auto& row) {
      all.push_back(quantityOf(row, place, state, *session.options.check));
      all.back().prior = priors.ofBoard(row, k, place.sensor);
      if (row.info.release == QuantityRelease::BoardBow) {
        constexpr double kSheet_m = 1e-4;  // a sheet on a board bends by so much by itself
        const double sigma_1_m =
            kSheet_m / bowHeight_m2(row.info, k == 0 ? session.board : session.further_boards[k - 1].board);
        all.back().moving = [=](const CalibrationState&) -> Eigen::MatrixXd {
          return Eigen::MatrixXd::Constant(1, 1, sigma_1_m * sigma_1_m);
        };
      }
    });
  }
  return all;
}

}  // namespace evical
