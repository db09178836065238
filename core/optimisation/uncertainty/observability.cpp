#include "core/optimisation/uncertainty/observability.h"

#include "core/data/quality_warning.h"
#include "core/numerics/angles.h"
#include "core/numerics/dense.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>

namespace evical {
namespace {

Eigen::MatrixXd ownCovariance(const QuantityCovariance& covariance, std::size_t quantity) {
  const Eigen::Index first = covariance.first_column[quantity],
                     size = covariance.first_column[quantity + 1] - first;
  return covariance.covariance.block(first, first, size, size);
}

bool hasSigmas(const QuantityCovariance& covariance, std::size_t quantity) {
  const Eigen::MatrixXd own = ownCovariance(covariance, quantity);
  return own.allFinite() && own.diagonal().minCoeff() > 0.0;
}

// Sigma in the worst direction.
struct Worst {
  double sigma;
  Eigen::VectorXd direction;
};
Worst worstOf(const QuantityCovariance& covariance, std::size_t quantity) {
  const SymmetricEigen eigen = symmetricEigen(ownCovariance(covariance, quantity));
  const Eigen::Index last = eigen.values.size() - 1;
  return {std::sqrt(std::max(0.0, eigen.values[last])), eigen.vectors.col(last)};
}

bool isCamera(const Quantity& quantity) {
  return quantity.info->owner == QuantityOwner::Camera;
}

const std::string& sensorName(const CalibrationInput& input, const Quantity& quantity) {
  return isCamera(quantity) ? input.cameras[quantity.sensor].name : input.imus[quantity.sensor].name;
}

class Judge {
 public:
  Judge(const CalibrationInput& input, const CalibrationState& state, const QuantityCovariance& covariance,
        const OptimisationOptions& options)
      : input_(input), state_(state), covariance_(covariance), options_(options) {}

  Observability judge() const;

 private:
  struct Part {
    std::size_t quantity;
    Eigen::Index at, size;  // rows among the needed quantities
    QuantityNeed need;
  };
  // A direction in the reference IMU's frame, given in the sensor's own: its axis, or the components.
  std::string axisWords(const Quantity& quantity, const Eigen::Vector3d& in_reference) const;
  std::string partWords(const Quantity& quantity, QuantityNeed need, const Eigen::VectorXd& direction) const;
  std::string directionWords(const std::vector<Part>& parts, const Eigen::VectorXd& direction) const;
  std::string unmetNeed(const Part& part) const;

  const CalibrationInput& input_;
  const CalibrationState& state_;
  const QuantityCovariance& covariance_;
  const OptimisationOptions& options_;
};

std::string Judge::axisWords(const Quantity& quantity, const Eigen::Vector3d& in_reference) const {
  const bool camera = isCamera(quantity);
  const Eigen::Quaterniond& reference_from_sensor =
      camera ? state_.cameras[quantity.sensor].reference_from_camera.rotation
             : state_.imus[quantity.sensor].reference_from_imu.rotation;
  Eigen::Vector3d direction = (reference_from_sensor.conjugate() * in_reference).normalized();
  Eigen::Index axis = 0;
  const double share = direction.cwiseAbs().maxCoeff(&axis);
  if (direction[axis] < 0.0) direction = -direction;
  const std::string owner =
      camera && input_.cameras.size() == 1 ? "the camera" : sensorName(input_, quantity);
  constexpr double kAlmostAlong = 0.9;
  if (share > kAlmostAlong) return fmt::format("{}'s {} axis", owner, std::string(1, "xyz"[axis]));
  return fmt::format("({:.2f}, {:.2f}, {:.2f}) in {}'s frame", direction.x(), direction.y(), direction.z(),
                     owner);
}

std::string Judge::partWords(const Quantity& quantity, QuantityNeed need,
                             const Eigen::VectorXd& direction) const {
  switch (need) {
    case QuantityNeed::Rotation:
      return "rotation about " + axisWords(quantity, direction);
    case QuantityNeed::Translation:
      return "translation along " + axisWords(quantity, direction);
    default:
      return "time offset of " + sensorName(input_, quantity);
  }
}

std::string Judge::directionWords(const std::vector<Part>& parts, const Eigen::VectorXd& direction) const {
  std::vector<std::pair<double, std::string>> words;
  for (const Part& part : parts) {
    const Eigen::VectorXd own = direction.segment(part.at, part.size);
    words.emplace_back(own.norm(), partWords(covariance_.quantities[part.quantity], part.need, own));
  }
  std::sort(words.begin(), words.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  constexpr double kWorthNaming = 0.5;  // a quarter of the direction's square
  std::string text = words.front().second;
  if (words.size() > 1 && words[1].first > kWorthNaming) text += " together with " + words[1].second;
  return text;
}

const char* nameOf(QuantityNeed need) {
  return need == QuantityNeed::Rotation      ? "rotation"
         : need == QuantityNeed::Translation ? "translation"
                                             : "time offset";
}

// "1.04": as many digits as show that the sigma is larger than needed.
std::string beyondNeed(double sigma, double needed) {
  std::string text;
  constexpr int kFewest = 2, kMax = 6;
  for (int digits = kFewest; digits <= kMax; ++digits) {
    text = fmt::format("{:.{}g}", sigma, digits);
    if (!(std::stod(text) <= needed)) break;
  }
  return text;
}

// Empty if the part is certain enough in every direction.
std::string Judge::unmetNeed(const Part& part) const {
  const Quantity& quantity = covariance_.quantities[part.quantity];
  // A singular problem has NaN sigmas, which no comparison would reject.
  if (!hasSigmas(covariance_, part.quantity))
    return fmt::format("the {} of {} has no sigma: splines or sensors have no measurements",
                       nameOf(part.need), sensorName(input_, quantity));
  const auto [sigma, direction] = worstOf(covariance_, part.quantity);
  if (!(sigma > neededSigma(part.need, options_))) return {};
  const std::string words = partWords(quantity, part.need, direction);
  constexpr double kHopeless = 100.0;
  if (sigma > kHopeless * neededSigma(part.need, options_))
    return words + " is not observable in this recording";
  switch (part.need) {
    case QuantityNeed::Rotation:
      return fmt::format("{} has a sigma of {} deg (needed: {:.2g})", words,
                         beyondNeed(kDegPerRad * sigma, options_.needed_rotation_deg),
                         options_.needed_rotation_deg);
    case QuantityNeed::Translation:
      return fmt::format("{} has a sigma of {} mm (needed: {:.2g})", words,
                         beyondNeed(1e3 * sigma, options_.needed_translation_mm),
                         options_.needed_translation_mm);
    default:
      return fmt::format("{} has a sigma of {} ms (needed: {:.2g})", words,
                         beyondNeed(1e3 * sigma, options_.needed_time_offset_ms),
                         options_.needed_time_offset_ms);
  }
}

Observability Judge::judge() const {
  std::vector<Part> parts;
  std::vector<Eigen::Index> columns;
  std::vector<double> units;
  for (std::size_t i = 0; i < covariance_.quantities.size(); ++i) {
    const QuantityNeed need = covariance_.quantities[i].info->need;
    if (need == QuantityNeed::None) continue;
    const Eigen::Index first = covariance_.first_column[i], size = covariance_.first_column[i + 1] - first;
    parts.push_back({i, static_cast<Eigen::Index>(columns.size()), size, need});
    for (Eigen::Index k = 0; k < size; ++k) {
      columns.push_back(first + k);
      units.push_back(neededSigma(need, options_));
    }
  }
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd in_needs(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      in_needs(i, j) = covariance_.covariance(columns[a], columns[b]) / (units[a] * units[b]);
    }
  }
  Observability result;
  if (count == 0) return result;
  const SymmetricEigen eigen = symmetricEigen(in_needs);
  for (Eigen::Index i = count - 1; i >= 0; --i) {
    result.eigenvalues.push_back(1.0 / std::max(eigen.values[i], 1e-12));
    result.directions.push_back(directionWords(parts, eigen.vectors.col(i)));
  }
  if (!options_.judge_sigmas) return result;
  for (const Part& part : parts) {
    const std::string unmet = unmetNeed(part);
    if (unmet.empty()) continue;
    result.status = CalibrationStatus::Doubtful;
    result.reason += (result.reason.empty() ? "" : "; ") + unmet;
  }
  if (result.status == CalibrationStatus::Doubtful) {
    result.reason +=
        ". Record again: rotate about all three axes and move along all three, faster or for longer";
  }
  return result;
}

}  // namespace

double neededSigma(QuantityNeed need, const OptimisationOptions& options) {
  switch (need) {
    case QuantityNeed::Rotation:
      return kRadPerDeg * options.needed_rotation_deg;
    case QuantityNeed::Translation:
      return options.needed_translation_mm * 1e-3;
    default:
      return options.needed_time_offset_ms * 1e-3;
  }
}

Observability judgeObservability(const CalibrationInput& input, const CalibrationState& state,
                                 const QuantityCovariance& covariance, const QuantityCovariance& scale_known,
                                 const OptimisationOptions& options) {
  Observability result = Judge(input, state, scale_known, options).judge();
  for (const CameraData& camera : input.cameras) {
    const double uncertain_ms = 0.5e3 * camera.observations.stamp_step_s;
    if (!options.judge_sigmas || input.imus.empty() || uncertain_ms <= options.needed_time_offset_ms)
      continue;
    flagDoubtful(
        fmt::format("the event time stamps of {} have steps of {:.3g} ms, which leave an error of "
                    "{} ms in its time offset (needed: {:.2g}): record the sensor's own stamps in us",
                    camera.name, 2.0 * uncertain_ms, beyondNeed(uncertain_ms, options.needed_time_offset_ms),
                    options.needed_time_offset_ms),
        result);
  }
  for (std::size_t i = 0; i < covariance.quantities.size(); ++i) {
    const QuantityInfo& info = *covariance.quantities[i].info;
    if (info.need != QuantityNeed::Translation || !options.judge_sigmas) continue;
    const double whole_mm = 1e3 * worstOf(covariance, i).sigma, own_mm = 1e3 * worstOf(scale_known, i).sigma;
    if (whole_mm < options.needed_scale_mm || own_mm > options.needed_translation_mm) continue;
    flagDoubtful(
        fmt::format("the translation of {} has a sigma of {} mm with the board's size uncertainty (needed: "
                    "{:.2g}): measure the board more accurately and set board.spacing_std, or move closer",
                    sensorName(input, covariance.quantities[i]),
                    beyondNeed(whole_mm, options.needed_scale_mm), options.needed_scale_mm),
        result);
  }
  return result;
}

}  // namespace evical
