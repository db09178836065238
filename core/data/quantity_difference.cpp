#include "core/data/quantity_difference.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/data/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

class Differences {
 public:
  // Without sigmas if `sigmas` is empty.
  void add(const std::string& sensor, const QuantityInfo& info, const std::vector<QuantityPart>& parts,
           const Eigen::VectorXd& differences, const Eigen::VectorXd& sigmas) {
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      all.push_back({sensor + "." + parts[k].name, parts[k].shown_unit, info.shown_factor * differences[i],
                     info.shown_factor * sigmas[i]});
    }
  }

  std::vector<QuantityDifference> all;
};

// Coefficients of different models are not comparable.
template <class Value>
bool comparable(const Value&, const Value&) {
  return true;
}
bool comparable(const std::optional<CameraIntrinsics>& a, const std::optional<CameraIntrinsics>& b) {
  return a && b && a->model == b->model;
}

bool isEstimated(const Eigen::VectorXd& sigmas) {
  return !sigmas.isZero(0.0);
}

// One sensor in one of the two estimates.
template <class State, class Uncertainty>
struct Side {
  const State& state;
  const Uncertainty& uncertainty;
};
template <class State, class Uncertainty>
Side(const State&, const Uncertainty&) -> Side<State, Uncertainty>;

template <class Row, class Sensor>
bool isCompared(const Row& row, const Sensor& a, const Sensor& b) {
  if (!comparable(row.value(a.state), row.value(b.state))) return false;
  const bool in_a = isEstimated(quantityNumbers(row.sigma(a.uncertainty)));
  switch (row.info.presence) {
    case QuantityPresence::Always:
      return true;
    case QuantityPresence::WhereNotZero:
      return !quantityNumbers(row.value(a.state)).isZero(0.0) ||
             !quantityNumbers(row.value(b.state)).isZero(0.0);
    case QuantityPresence::WhereEstimated:
      return in_a;
    case QuantityPresence::WhereBothEstimated:
      break;
  }
  return in_a && isEstimated(quantityNumbers(row.sigma(b.uncertainty)));
}

// Offsets of drifting clocks are compared at the same time.
template <class Sensor>
Sensor atTimeOf(const Sensor& other, Sensor sensor) {
  sensor.time_offset_s = timeOffsetAt_s(sensor, other.time_offset_at_s);
  sensor.time_offset_at_s = other.time_offset_at_s;
  return sensor;
}

template <class Rows, class Sensor>
void compareSensor(const Rows& rows, const std::string& name, const Sensor& a, const Sensor& b,
                   bool without_place, Differences& differences) {
  forEachQuantity(rows, [&](const auto& row) {
    if ((row.info.relative && without_place) || !isCompared(row, a, b)) return;
    const auto& value = row.value(a.state);
    differences.add(name, row.info, quantityParts(row.info, value),
                    quantityDifference(row.info, value, row.value(b.state)),
                    quantityNumbers(row.sigma(a.uncertainty)));
  });
}

template <class Matrix>
void addInQuadrature(Matrix& sum, const Matrix& other) {
  sum = (sum.array().square() + other.array().square()).sqrt().matrix().eval();
}
void addInQuadrature(double& sum, const double& other) {
  sum = std::hypot(sum, other);
}
void addInQuadrature(std::optional<std::array<double, 9>>& sum,
                     const std::optional<std::array<double, 9>>& other) {
  for (std::size_t k = 0; sum && other && k < other->size(); ++k) addInQuadrature((*sum)[k], (*other)[k]);
}

template <class Rows, class Uncertainty>
void addSigmas(const Rows& rows, Uncertainty& sum, const Uncertainty& other) {
  forEachQuantity(rows, [&](const auto& row) { addInQuadrature(row.sigma(sum), row.sigma(other)); });
}
template <class Rows, class Uncertainty>
void addSensors(const Rows& rows, std::vector<Uncertainty>& sums, const std::vector<Uncertainty>& others) {
  for (std::size_t i = 0; i < sums.size() && i < others.size(); ++i) addSigmas(rows, sums[i], others[i]);
}

// Renames the only sensor of a kind; the reference keeps referring to it.
void matchOnly(const char* kind, const std::vector<std::string>& names,
               const std::vector<std::string>& others, std::vector<std::string>& renamed,
               MatchedEstimate& matched) {
  if (renamed.size() != 1 || names.size() != 1 || renamed[0] == names[0]) return;
  const bool taken = std::find(others.begin(), others.end(), names[0]) != others.end();
  if (taken) return;
  matched.notes.push_back(
      fmt::format("'{}' is compared with '{}': each is the only {}", names[0], renamed[0], kind));
  if (matched.estimate.reference == renamed[0]) matched.estimate.reference = names[0];
  renamed[0] = names[0];
}

}  // namespace

MatchedEstimate matchedByPlace(const Estimate& a, Estimate b) {
  MatchedEstimate matched{std::move(b), {}};
  Estimate& estimate = matched.estimate;
  matchOnly("camera", a.camera_names, estimate.imu_names, estimate.camera_names, matched);
  matchOnly("IMU", a.imu_names, estimate.camera_names, estimate.imu_names, matched);
  return matched;
}

std::size_t sensorIndex(const std::string& name, const std::vector<std::string>& names, const char* key) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw badInput(key, fmt::format("the truth does not contain '{}'", name), nameAdvice(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<QuantityDifference> difference(const Estimate& a, const Estimate& b) {
  if (a.reference != b.reference)
    throw badInput("reference",
                   fmt::format("the result has '{}', the truth has '{}'", a.reference, b.reference),
                   "Compare results of the same sensors; if only the names differ, rename the sensors");
  Differences differences;
  forEachSensorKind([&](auto kind) {
    const std::vector<std::string>& names = kind.namesOf(a);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::size_t j = sensorIndex(names[i], kind.namesOf(b), kind.kKey);
      const auto other = atTimeOf(kind.of(a).at(i), kind.of(b).at(j));
      compareSensor(kind.rows(), names[i], Side{kind.of(a).at(i), kind.of(a.uncertainty).at(i)},
                    Side{other, kind.of(b.uncertainty).at(j)}, names[i] == a.reference, differences);
    }
  });
  for (std::size_t i = 0; i < a.boards.size(); ++i) {
    const std::size_t j = i == 0 ? 0 : sensorIndex(a.board_names.at(i), b.board_names, "boards");
    compareSensor(kBoardQuantities, a.board_names.at(i), Side{a.boards[i], a.uncertainty.boardAt(i)},
                  Side{b.boards.at(j), b.uncertainty.boardAt(j)}, i == 0, differences);
  }
  if (const double sigma = a.uncertainty.gravity_norm_std_m_s2; sigma > 0.0)
    differences.all.push_back({"gravity.norm", kGravityQuantity.shown_unit,
                               a.gravity_in_world_m_s2.norm() - b.gravity_in_world_m_s2.norm(), sigma});
  return std::move(differences.all);
}

double gravityDirectionDifference_rad(const Estimate& a, const Estimate& b) {
  const Eigen::Vector3d first = a.gravity_in_world_m_s2.normalized();
  const Eigen::Vector3d second = b.gravity_in_world_m_s2.normalized();
  return std::atan2(first.cross(second).norm(), first.dot(second));
}

UncertaintyReport differenceUncertainty(const UncertaintyReport& a, const UncertaintyReport& b) {
  UncertaintyReport sum = a;
  forEachSensorKind([&](auto kind) { addSensors(kind.rows(), kind.of(sum), kind.of(b)); });
  addSigmas(kBoardQuantities, sum.board, b.board);
  addSensors(kBoardQuantities, sum.further_boards, b.further_boards);
  sum.gravity_norm_std_m_s2 = std::hypot(a.gravity_norm_std_m_s2, b.gravity_norm_std_m_s2);
  sum.gravity_direction_std_rad = std::hypot(a.gravity_direction_std_rad, b.gravity_direction_std_rad);
  return sum;
}

double normalisedRms(const std::vector<QuantityDifference>& quantities) {
  double sum = 0.0;
  int count = 0;
  for (const QuantityDifference& each : quantities) {
    if (!(each.sigma > 0.0)) continue;
    sum += each.normalised() * each.normalised();
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(sum / count);
}

}  // namespace evical
