#include "core/pipeline/compare/compared_quantities.h"

#include "core/base/number.h"
#include "core/data/pixel_delay.h"
#include "core/data/quantity.h"
#include "core/data/quantity_difference.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/so3.h"
#include "core/numerics/dense.h"
#include "core/optimisation/optimisation_options.h"
#include "core/report/truth_comparison.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>

namespace evical {
namespace {

constexpr double kPerCent = 100.0;

// Units and thresholds for changes of a quantity.
struct Judged {
  const char* unit;
  double factor;  // from SI units
  double allowed_drift, required_detectability;
};

std::optional<Judged> judgedBy(const QuantityInfo& info, const CheckOptions& options) {
  switch (info.id) {
    case QuantityId::Rotation:
      return Judged{"deg", kDegPerRad, options.stability_rotation_deg, options.matters_rotation_deg};
    case QuantityId::Translation:
      return Judged{"mm", 1e3, options.stability_translation_mm, options.matters_translation_mm};
    case QuantityId::TimeOffset:
      return Judged{"ms", 1e3, options.stability_time_offset_ms, options.matters_time_offset_ms};
    case QuantityId::Intrinsics:
      return Judged{"px", 1.0, options.stability_lens_px, options.matters_lens_px};
    case QuantityId::GyroscopeScaleMisalignment:
    case QuantityId::AccelerometerScaleMisalignment:
      return Judged{"%", kPerCent, kPerCent * options.stability_imu_scale, 0.0};
    case QuantityId::GyroscopeRotation:
      return Judged{"deg", kDegPerRad, options.stability_rotation_deg, 0.0};
    case QuantityId::AccelerometerDelay:
      return Judged{"ms", 1e3, options.stability_time_offset_ms, 0.0};
    case QuantityId::Scale:
    case QuantityId::Stretch:
      return Judged{"", 1.0, kStableSheet, 0.0};
    default:
      return std::nullopt;  // not part of the rig's calibration: biases, drifts, edge localisation biases
  }
}

// One number of a result: its column in the report, or a separate sigma for older results without columns.
struct Uncertain {
  QuantityAddress number;
  std::optional<Eigen::Index> column = {};
  double sigma = 0.0;
};

double covarianceOf(const UncertaintyReport& report, const Uncertain& a, const Uncertain& b, bool same) {
  if (a.column && b.column)
    return report.standard_deviations[*a.column] * report.correlation(*a.column, *b.column) *
           report.standard_deviations[*b.column];
  return same ? a.sigma * a.sigma : 0.0;
}

// Effect of light on pixel delays, which is part of the sigmas of time offsets. For one camera it is the same
// in both results, up to the stability.
double pixelDelay_s(const NamedResult& named) {
  double delay_ms = VerdictOptions().pixel_delay_ms;
  for (const OptionRow& row : named.options)
    if (row.name == "optimisation.verdict.pixel_delay_ms") delay_ms = realFrom(row.value).value_or(delay_ms);
  return 1e-3 * delay_ms;
}

std::vector<Eigen::Vector2d> placesInImage(Resolution size_px, bool border_only) {
  constexpr int kColumns = 12, kRows = 9;
  std::vector<Eigen::Vector2d> places;
  for (int row = 0; row <= kRows; ++row)
    for (int column = 0; column <= kColumns; ++column) {
      const bool border = row == 0 || row == kRows || column == 0 || column == kColumns;
      if (border || !border_only)
        places.emplace_back(static_cast<double>(column) / kColumns * (size_px.width_px - 1),
                            static_cast<double>(row) / kRows * (size_px.height_px - 1));
    }
  return places;
}

// Derivatives of pixels with respect to the first `count` intrinsics, where rays exist.
std::vector<Eigen::MatrixXd> byIntrinsics(const CameraIntrinsics& camera, Eigen::Index count,
                                          bool border_only) {
  std::vector<Eigen::MatrixXd> all;
  for (const Eigen::Vector2d& pixel : placesInImage(camera.resolution_px, border_only)) {
    const auto ray = unprojectRay(camera, pixel);
    IntrinsicsJacobian jacobian;
    if (ray && project(camera, *ray, nullptr, &jacobian)) all.emplace_back(jacobian.leftCols(count));
  }
  return all;
}

// Derivatives with respect to rotations about the reference's axes.
std::vector<Eigen::MatrixXd> byTurn(const CameraState& camera) {
  std::vector<Eigen::MatrixXd> all;
  const CameraIntrinsics& lens = *camera.lens.inUse();
  const Eigen::Matrix3d camera_from_reference =
      camera.reference_from_camera.rotation.conjugate().toRotationMatrix();
  for (const Eigen::Vector2d& pixel : placesInImage(lens.resolution_px, true)) {
    const auto ray = unprojectRay(lens, pixel);
    Eigen::Matrix<double, 2, 3> by_point;
    if (ray && project(lens, *ray, &by_point))
      all.emplace_back(by_point * skew(*ray) * camera_from_reference);
  }
  return all;
}

// The size of a lens change is the RMS displacement in the image: its square is a quadratic form of the
// change.
Eigen::MatrixXd lensToSize(const CameraIntrinsics& camera, Eigen::Index count) {
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(count, count);
  const std::vector<Eigen::MatrixXd> places = byIntrinsics(camera, count, false);
  for (const Eigen::MatrixXd& place : places) form += product(place.transpose(), place);
  form /= std::max(1.0, static_cast<double>(places.size()));
  return Eigen::LLT<Eigen::MatrixXd>(form).matrixU();
}

class Comparison {
 public:
  Comparison(const ComparedResults& results, const CheckOptions& options)
      : results_(results),
        options_(options),
        before_(estimateOf(results.before)),
        now_(estimateOf(results.now)) {}

  ComparedQuantities run() {
    forEachSensorKind([&](auto kind) {
      for (std::size_t k = 0; k < kind.of(now_).size(); ++k) addSensor(kind, k);
    });
    if (results_.same_board) addBoard();
    fillCovariance();
    return std::move(out_);
  }

 private:
  template <class State, class Uncertainty>
  struct Side {
    std::size_t index;
    const State& state;
    const Uncertainty& sigma;
  };
  template <class State, class Uncertainty>
  struct Pair {
    std::string sensor;
    bool without_place;
    Side<State, Uncertainty> before, now;
  };

  template <class Kind>
  void addSensor(Kind kind, std::size_t k) {
    const std::string& name = kind.namesOf(now_)[k];
    const std::size_t j = sensorIndex(name, kind.namesOf(before_), kind.kKey);
    const auto& now = kind.of(now_)[k];
    const auto& sigma = kind.of(now_.uncertainty)[k];
    const Pair<std::remove_cvref_t<decltype(now)>, std::remove_cvref_t<decltype(sigma)>> pair{
        name,
        name == now_.reference,
        {j, kind.of(before_)[j], kind.of(before_.uncertainty)[j]},
        {k, now, sigma}};
    forEachQuantity(kind.rows(), [&](const auto& row) {
      if (ComparedQuantity* const added = add(row, pair)) addImageOf(now, row.info, *added);
    });
  }

  // Adds the effect in the image of a change of the quantity that was added last.
  void addImageOf(const CameraState& now, const QuantityInfo& info, ComparedQuantity& added) {
    if (!now.lens.inUse()) return;
    if (info.id == QuantityId::Rotation) added.at_edge = byTurn(now);
    if (info.id != QuantityId::Intrinsics) return;
    ChangeGroup& group = out_.groups.back();
    added.at_edge = byIntrinsics(*now.lens.inUse(), group.size, true);
    group.to_size = lensToSize(*now.lens.inUse(), group.size);
    group.stable_covariance = lensCovariance(*now.lens.inUse(), group.size, group.allowed_drift);
  }
  void addImageOf(const ImuState&, const QuantityInfo&, ComparedQuantity&) {}

  // Adds the board; a sheet's allowed drift is the effect of humidity on paper.
  void addBoard() {
    const Pair<BoardState, BoardUncertainty> pair{now_.board_names[0],
                                                  true,
                                                  {0, before_.boards[0], before_.uncertainty.board},
                                                  {0, now_.boards[0], now_.uncertainty.board}};
    forEachSheetQuantity([&](const auto& row) {
      if (const auto judged = judgedBy(row.info, options_)) addNumbers(row, pair, *judged, false);
    });
  }

  template <class Row, class Sensors>
  ComparedQuantity* add(const Row& row, const Sensors& pair) {
    const std::optional<Judged> judged = judgedBy(row.info, options_);
    if (!judged || (row.info.relative && pair.without_place)) return nullptr;
    if (!addNumbers(row, pair, *judged, true)) {
      if (row.info.presence == QuantityPresence::Always &&
          quantityNumbers(row.sigma(pair.now.sigma)).isZero(0.0))
        out_.not_told.push_back(fmt::format("{} of {}", row.info.title, pair.sensor));
      return nullptr;
    }
    return &out_.quantities.back();
  }

  // False if it is not estimated now. Numbers of a shared sensor are estimated once, under its own name.
  template <class Row, class Sensors>
  bool addNumbers(const Row& row, const Sensors& pair, const Judged& judged, bool tested) {
    const QuantityInfo& info = row.info;
    const std::vector<QuantityPart> all = quantityParts(info, row.value(pair.now.state));
    std::vector<Uncertain> before, now;
    const Eigen::VectorXd sigmas_before = quantityNumbers(row.sigma(pair.before.sigma));
    QuantityAddress number = quantityAddress(info, pair.now.index, row.value(pair.now.state)), was = number;
    was.sensor = pair.before.index;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(all.size()); ++i) {
      const auto column = columnOf(number, now_.uncertainty.columns);
      if (!column) break;
      now.push_back({number, column});
      before.push_back({was, columnOf(was, before_.uncertainty.columns),
                        i < sigmas_before.size() ? sigmas_before[i] : 0.0});
      ++number.component;
      ++was.component;
    }
    if (now.empty()) return false;
    const auto size = static_cast<Eigen::Index>(now.size());
    const Eigen::VectorXd difference =
        quantityDifference(info, row.value(pair.now.state), row.value(pair.before.state)).head(size);
    ChangeGroup group{
        next_, size, judged.factor * Eigen::MatrixXd::Identity(size, size), judged.allowed_drift, {}, tested};
    group.stable_covariance = stableCovariance(group);
    out_.groups.push_back(group);
    next_ += size;
    differences_.insert(differences_.end(), difference.begin(), difference.end());
    columns_before_.insert(columns_before_.end(), before.begin(), before.end());
    columns_now_.insert(columns_now_.end(), now.begin(), now.end());
    if (tested) out_.quantities.push_back(shownQuantity(row, pair, judged, all));
    return true;
  }

  static Eigen::MatrixXd stableCovariance(const ChangeGroup& group) {
    const Eigen::MatrixXd from_size = inverseOf(group.to_size);
    return group.allowed_drift * group.allowed_drift * productTransposed(from_size, from_size);
  }

  template <class Row, class Sensors>
  ComparedQuantity shownQuantity(const Row& row, const Sensors& pair, const Judged& judged,
                                 const std::vector<QuantityPart>& parts) const {
    const QuantityInfo& info = row.info;
    ComparedQuantity compared;
    Finding& shown = compared.shown;
    shown.sensor = pair.sensor;
    shown.id = info.id;
    shown.quantity = info.name;
    shown.title = titleOf(info);
    shown.unit = judged.unit;
    shown.allowed_drift = judged.allowed_drift;
    shown.required_detectability = judged.required_detectability;
    const double factor = info.shown_factor;
    const Eigen::VectorXd before = factor * quantityNumbers(row.value(pair.before.state)),
                          now = factor * quantityNumbers(row.value(pair.now.state)),
                          sigma_before = factor * quantityNumbers(row.sigma(pair.before.sigma)),
                          sigma_now = factor * quantityNumbers(row.sigma(pair.now.sigma));
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      shown.numbers.push_back({parts[k].name,
                               parts[k].shown_unit,
                               {before[i], i < sigma_before.size() ? sigma_before[i] : 0.0},
                               {now[i], i < sigma_now.size() ? sigma_now[i] : 0.0}});
    }
    return compared;
  }

  static std::string titleOf(const QuantityInfo& info) {
    if (info.id == QuantityId::Rotation) return "rotation";
    if (info.id == QuantityId::Intrinsics) return "lens";
    if (info.shape == QuantityShape::UpperTriangle) return std::string(info.title) + " scale and axes";
    return info.title;
  }

  void fillCovariance() {
    const auto size = static_cast<Eigen::Index>(differences_.size());
    out_.change.difference = Eigen::Map<const Eigen::VectorXd>(differences_.data(), size);
    out_.change.covariance.resize(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto a = static_cast<std::size_t>(i);
      for (Eigen::Index j = 0; j < size; ++j) {
        const auto b = static_cast<std::size_t>(j);
        double before = covarianceOf(before_.uncertainty, columns_before_[a], columns_before_[b], i == j);
        double now = covarianceOf(now_.uncertainty, columns_now_[a], columns_now_[b], i == j);
        if (i == j) {
          before = withoutDelay(before, results_.before, columns_before_[a].number);
          now = withoutDelay(now, results_.now, columns_now_[a].number);
        }
        out_.change.covariance(i, j) = before + now;
      }
    }
  }

  static double withoutDelay(double variance, const NamedResult& named, const QuantityAddress& number) {
    const bool offset = number.owner == QuantityOwner::Camera && number.id == QuantityId::TimeOffset;
    return offset && holdsPixelDelay(cameraKinds(named), number.sensor, !named.imus.empty())
               ? withoutPixelDelay_s2(variance, pixelDelay_s(named))
               : variance;
  }

  const ComparedResults& results_;
  const CheckOptions& options_;
  const Estimate before_, now_;
  ComparedQuantities out_;
  Eigen::Index next_ = 0;
  std::vector<double> differences_;
  std::vector<Uncertain> columns_before_, columns_now_;
};

double sizeAlong(const GroupTestResult& test, const ChangeGroup& group) {
  const Eigen::VectorXd change = group.to_size * test.change;
  const Eigen::MatrixXd covariance = group.to_size * test.covariance * group.to_size.transpose();
  if (!(change.norm() > 0.0)) return std::sqrt(std::max(0.0, covariance.diagonal().maxCoeff()));
  const Eigen::VectorXd direction = change.normalized();
  return std::sqrt(std::max(0.0, direction.dot(covariance * direction)));
}

}  // namespace

Finding testedQuantity(const ComparedQuantity& compared, const GroupTestResult& test,
                       const ChangeGroup& group) {
  Finding finding = compared.shown;
  finding.change = (group.to_size * test.change).norm();
  finding.change_sigma = sizeAlong(test, group);
  finding.sigmas = test.sigmas;
  finding.limit_sigmas = test.limit;
  finding.smallest_detectable_change = test.smallest_detectable_change;
  finding.changed = test.changed;
  for (const Eigen::MatrixXd& place : compared.at_edge)
    finding.edge_px = std::max(finding.edge_px, (place * test.change).norm());
  return finding;
}

std::optional<double> stabilityOf(const QuantityInfo& info, const CheckOptions& options) {
  switch (info.id) {
    case QuantityId::Rotation:
    case QuantityId::GyroscopeRotation:
      return kRadPerDeg * options.stability_rotation_deg;
    case QuantityId::Translation:
      return 1e-3 * options.stability_translation_mm;
    case QuantityId::TimeOffset:
    case QuantityId::AccelerometerDelay:
      return 1e-3 * options.stability_time_offset_ms;
    case QuantityId::Intrinsics:
      return options.stability_lens_px;
    case QuantityId::GyroscopeScaleMisalignment:
    case QuantityId::AccelerometerScaleMisalignment:
      return options.stability_imu_scale;
    case QuantityId::Scale:
    case QuantityId::Stretch:
      return kStableSheet;
    default:
      return std::nullopt;
  }
}

Eigen::MatrixXd lensCovariance(const CameraIntrinsics& camera, Eigen::Index count, double rms_px) {
  const Eigen::MatrixXd from_size = inverseOf(lensToSize(camera, count));
  return rms_px * rms_px / static_cast<double>(count) * productTransposed(from_size, from_size);
}

ComparedQuantities compareQuantities(const ComparedResults& results, const CheckOptions& options) {
  return Comparison(results, options).run();
}

}  // namespace evical
