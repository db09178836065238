#include "core/optimisation/weak_priors.h"

#include "core/data/board_bow.h"
#include "core/numerics/angles.h"

namespace evical {

std::optional<double> weakSigma(const QuantityInfo& info, const OptimisationOptions& options,
                                const PriorOwner& owner) {
  constexpr double kBoardWithin_m = 100.0;  // limits a board without views
  switch (info.id) {
    case QuantityId::Translation:
      return info.owner == QuantityOwner::Board ? kBoardWithin_m : options.translation_sigma_m;
    case QuantityId::TimeOffsetDrift:
      return options.time_offset_drift_sigma_ppm;
    case QuantityId::LineDelay:
      return 1e3 * options.longest_readout_ms / owner.image_height_px;
    case QuantityId::ExposureShare:
      return options.exposure_share_sigma;
    case QuantityId::EdgeLocalisationBias:
      return options.edge_localisation_bias_sigma_px;
    case QuantityId::SlowEdgeLocalisationBias:
      return options.slow_edge_localisation_bias_sigma_px;
    case QuantityId::GyroscopeBias:
      return options.gyroscope_bias_sigma_rad_s;
    case QuantityId::AccelerometerBias:
      return options.accelerometer_bias_sigma_m_s2;
    case QuantityId::GyroscopeScaleMisalignment:
    case QuantityId::AccelerometerScaleMisalignment:
      return options.mapping_sigma;
    case QuantityId::AccelerometerDelay:
      return options.accelerometer_delay_sigma_s;
    case QuantityId::GyroscopeRotation:
      return kRadPerDeg * options.gyroscope_rotation_sigma_deg;
    case QuantityId::Scale:
      return owner.spacing_sigma;
    case QuantityId::Stretch:
      return boardStretchSigma(owner.spacing_sigma);
    case QuantityId::RowCurvature:
    case QuantityId::ColumnCurvature:
    case QuantityId::Twist:
      return 1e-3 * options.board_bow_sigma_mm / bowHeight_m2(info.id, *owner.board);
    case QuantityId::Rotation:
    case QuantityId::TimeOffset:
    case QuantityId::Intrinsics:  // LensPrior
    case QuantityId::Gravity:
    case QuantityId::Latency:
      break;
  }
  return std::nullopt;
}

}  // namespace evical
