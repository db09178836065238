#include "core/optimisation/uncertainty/shared_sensors.h"

#include "core/data/quantity.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/projection_difference.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/numerics/dense.h"
#include "core/optimisation/uncertainty/projected_information.h"
#include "core/optimisation/uncertainty/schur_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace evical {
namespace {

// Same quantity of the camera that represents this one's sensor; nullopt if it is not estimated.
std::optional<std::size_t> partnerOf(std::size_t quantity, const CalibrationInput& input,
                                     const ProjectedInformation& information) {
  const Quantity& own = information.quantities[quantity];
  for (std::size_t i = 0; i < information.quantities.size(); ++i)
    if (information.quantities[i].info == own.info &&
        information.quantities[i].sensor == input.sensorOf(own.sensor))
      return i;
  return std::nullopt;
}

bool isShared(const Quantity& quantity, const CalibrationInput& input) {
  return quantity.info->owner == QuantityOwner::Camera && quantity.info->of_sensor &&
         input.cameras[quantity.sensor].same_sensor_as.has_value();
}

// Difference of a camera from its sensor with both free.
struct Apart {
  double rotation_deg = 0.0, translation_mm = 0.0, lens_px = 0.0;
  double sigmas = 0.0;  // of the most significant relevant difference
};

class SensorTest {
 public:
  SensorTest(const CalibrationInput& input, const CalibrationState& state,
             const ProjectedInformation& information, const OptimisationOptions& options)
      : input_(input),
        state_(state),
        information_(information),
        options_(options),
        step_(-ScaledInverse(information.total).times(information.gradient)),
        covariance_(withoutNoise(information).total) {}

  Apart of(std::size_t camera) const {
    Apart apart;
    for (std::size_t i = 0; i < information_.quantities.size(); ++i) {
      const Quantity& quantity = information_.quantities[i];
      if (quantity.sensor == camera && isShared(quantity, input_)) add(i, apart);
    }
    return apart;
  }

 private:
  void add(std::size_t i, Apart& apart) const {
    const Quantity& quantity = information_.quantities[i];
    const std::optional<std::size_t> partner = partnerOf(i, input_, information_);
    const Eigen::Index first = information_.first_column[i], size = information_.first_column[i + 1] - first;
    Eigen::VectorXd difference = alreadyApart(quantity).head(size) + step_.segment(first, size);
    if (partner) difference -= step_.segment(information_.first_column[*partner], size);
    double sigmas = 0.0;
    for (Eigen::Index k = 0; k < size; ++k) {
      Eigen::VectorXd direction = Eigen::VectorXd::Unit(step_.size(), first + k);
      if (partner) direction[information_.first_column[*partner] + k] = -1.0;
      const double variance = direction.dot(covariance_.times(direction));
      constexpr double kMinVariance = 1e-24;
      sigmas = std::max(sigmas, std::abs(difference[k]) / std::sqrt(std::max(variance, kMinVariance)));
    }
    if (counts(quantity, difference, sigmas, apart)) apart.sigmas = std::max(apart.sigmas, sigmas);
  }

  // Difference of two separate quantities, as a tangent step; zero if they are shared.
  Eigen::VectorXd alreadyApart(const Quantity& quantity) const {
    const CameraState& camera = state_.cameras[quantity.sensor];
    const CameraState& sensor = state_.cameras[input_.sensorOf(quantity.sensor)];
    if (quantity.info->id == QuantityId::Rotation)
      return quaternionLog(sensor.reference_from_camera.rotation.conjugate() *
                           camera.reference_from_camera.rotation);
    Eigen::VectorXd numbers;
    forEachQuantity(kCameraQuantities, [&](const auto& row) {
      if (row.info.id == quantity.info->id)
        numbers = quantityDifference(row.info, row.value(camera), row.value(sensor));
    });
    return numbers;
  }

  // Difference that is significant and above any need.
  bool counts(const Quantity& quantity, const Eigen::VectorXd& difference, double sigmas,
              Apart& apart) const {
    const bool certain = sigmas > options_.other_sensor_sigmas;
    if (quantity.info->id == QuantityId::Rotation) {
      apart.rotation_deg = kDegPerRad * difference.norm();
      return certain && apart.rotation_deg > options_.needed_rotation_deg;
    }
    if (quantity.info->id == QuantityId::Translation) {
      apart.translation_mm = 1e3 * difference.norm();
      return certain && apart.translation_mm > options_.needed_translation_mm;
    }
    if (quantity.info->id != QuantityId::Intrinsics) return false;
    apart.lens_px = lensDifference_px(*state_.cameras[quantity.sensor].lens.inUse(), difference);
    return certain && apart.lens_px > options_.wrong_lens_px;
  }

  static double lensDifference_px(const CameraIntrinsics& lens, const Eigen::VectorXd& difference) {
    std::array<double, 9> numbers{};
    writeIntrinsics(lens, numbers.data());
    for (Eigen::Index k = 0; k < difference.size(); ++k)
      numbers[static_cast<std::size_t>(k)] -= difference[k];
    return projectionDifference(intrinsicsFrom(numbers.data(), lens.model, lens.resolution_px), lens).rms_px;
  }

  const CalibrationInput& input_;
  const CalibrationState& state_;
  const ProjectedInformation& information_;
  const OptimisationOptions& options_;
  Eigen::VectorXd step_;
  ScaledInverse covariance_;
};

// Sigma of the difference of two cameras' time offsets.
double differenceSigma(const UncertaintyReport& report, std::size_t first, std::size_t second) {
  const auto offsetOf = [&](std::size_t camera) {
    return columnOf({QuantityOwner::Camera, camera, QuantityId::TimeOffset}, report.columns);
  };
  const std::optional<Eigen::Index> a = offsetOf(first), b = offsetOf(second);
  const auto sigma = [&](const std::optional<Eigen::Index>& i) {
    return i ? report.standard_deviations[*i] : 0.0;
  };
  const double correlation = a && b ? report.correlation(*a, *b) : 0.0;
  const double variance = sigma(a) * sigma(a) + sigma(b) * sigma(b) - 2.0 * correlation * sigma(a) * sigma(b);
  return std::sqrt(std::max(0.0, variance));
}

}  // namespace

std::string doubtOfSensors(const CalibrationInput& input, const CalibrationState& state,
                           const ProjectedInformation& information, const OptimisationOptions& options) {
  std::string doubts;
  std::optional<SensorTest> test;
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    if (!input.cameras[i].same_sensor_as) continue;
    if (!test) test.emplace(input, state, information, options);
    const Apart apart = test->of(i);
    if (apart.sigmas == 0.0) continue;
    doubts += fmt::format(
        "{}{} is not the same sensor as {}: separate poses differ by {:.2g} deg and {:.2g} mm, and lenses by "
        "{:.2g} px ({:.0f} sigmas); remove same_sensor_as, or check the "
        "streams",
        doubts.empty() ? "" : "; ", input.cameras[i].name, input.cameras[input.sensorOf(i)].name,
        apart.rotation_deg, apart.translation_mm, apart.lens_px, apart.sigmas);
  }
  return doubts;
}

ProjectedInformation withSharedSensors(const CalibrationInput& input, const OptimisationOptions& options,
                                       ProjectedInformation information) {
  if (!options.share_sensors) return information;
  KeptColumns kept(information);
  for (std::size_t i = 0; i < information.quantities.size(); ++i) {
    if (!isShared(information.quantities[i], input))
      kept.keep(i);
    else if (const std::optional<std::size_t> partner = partnerOf(i, input, information))
      kept.tie(i, *partner);
  }
  return withColumns(kept, std::move(information));
}

void reportSharedSensors(const CalibrationInput& input, const OptimisationOptions& options,
                         UncertaintyReport& report) {
  if (!options.share_sensors) return;
  for (std::size_t i = 0; i < report.cameras.size(); ++i)
    forEachQuantity(kCameraQuantities, [&](const auto& row) {
      if (row.info.of_sensor) row.sigma(report.cameras[i]) = row.sigma(report.cameras[input.sensorOf(i)]);
    });
}

std::vector<SensorLatency> sensorLatencies(const CalibrationInput& input, const CalibrationState& state,
                                           const UncertaintyReport& report) {
  std::vector<SensorLatency> latencies;
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    if (!input.cameras[i].same_sensor_as) continue;
    std::size_t later = i, other = input.sensorOf(i);
    if (input.cameras[later].observations.kind != CameraKind::Events) std::swap(later, other);
    const CameraState& a = state.cameras[later];
    const CameraState& b = state.cameras[other];
    latencies.push_back({later, other,
                         timeOffsetAt_s(b, b.time_offset_at_s) - timeOffsetAt_s(a, a.time_offset_at_s),
                         differenceSigma(report, later, other)});
  }
  return latencies;
}

}  // namespace evical
