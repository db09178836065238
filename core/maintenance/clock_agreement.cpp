#include "core/maintenance/clock_agreement.h"

#include "core/maintenance/maintenance_options.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

struct Moments {
  double count = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;

  double varianceA() const { return aa / count - (a / count) * (a / count); }
  double varianceB() const { return bb / count - (b / count) * (b / count); }
  double correlation() const {
    const double scale = std::sqrt(std::max(varianceA(), 0.0) * std::max(varianceB(), 0.0));
    return count > 0.0 && scale > 0.0 ? (ab / count - a / count * b / count) / scale : 0.0;
  }
};

Moments momentsAt(const std::vector<double>& reference, const std::vector<double>& own, long shift) {
  Moments sum;
  const long begin = std::max(0L, -shift);
  const long end = std::min(static_cast<long>(reference.size()), static_cast<long>(own.size()) - shift);
  for (long i = begin; i < end; ++i) {
    const double a = reference[static_cast<std::size_t>(i)], b = own[static_cast<std::size_t>(i + shift)];
    sum.count += 1.0;
    sum.a += a;
    sum.b += b;
    sum.aa += a * a;
    sum.bb += b * b;
    sum.ab += a * b;
  }
  return sum;
}

}  // namespace

void AngularSpeedSeries::add(double time_s, const Eigen::Vector3d& rate_rad_s) {
  const long bin = std::lround(std::floor(time_s / kBin_s));
  if (sums_.empty()) first_ = bin;
  constexpr long kMax = 100'000;  // a thousand seconds
  if (bin < first_ || bin - first_ >= kMax) return;
  const auto place = static_cast<std::size_t>(bin - first_);
  if (place >= sums_.size()) {
    sums_.resize(place + 1, 0.0);
    counts_.resize(place + 1, 0.0);
  }
  sums_[place] += rate_rad_s.norm();
  counts_[place] += 1.0;
}

std::vector<double> AngularSpeedSeries::filled() const {
  std::vector<double> values(sums_.size(), 0.0);
  for (std::size_t i = 0; i < sums_.size(); ++i)
    values[i] = counts_[i] > 0.0 ? sums_[i] / counts_[i] : i > 0 ? values[i - 1] : 0.0;
  return values;
}

ClockAgreement crossCorrelateClocks(const AngularSpeedSeries& reference, const AngularSpeedSeries& own,
                                    const MaintenanceOptions& options) {
  constexpr double kFewest = 300.0;  // bins
  constexpr double kNone = -2.0;     // if the overlap is too short
  ClockAgreement best;
  const std::vector<double> a = reference.filled(), b = own.filled();
  const long between = own.firstBin() - reference.firstBin();
  const long reach = std::lround(std::ceil(options.time_offset_search_s / AngularSpeedSeries::kBin_s));
  std::vector<double> correlations;
  for (long lag = -reach; lag <= reach; ++lag) {
    const Moments sum = momentsAt(a, b, lag - between);
    const bool enough =
        sum.count >= kFewest && std::sqrt(std::max(sum.varianceA(), 0.0)) > options.min_rate_rad_s;
    correlations.push_back(enough ? sum.correlation() : kNone);
    if (!enough) continue;
    best.moved = true;
    if (correlations.back() <= best.correlation) continue;
    best.correlation = correlations.back();
    best.later_s = -static_cast<double>(lag) * AngularSpeedSeries::kBin_s;
    best.ratio = std::sqrt(std::max(sum.varianceB(), 0.0) / sum.varianceA());
  }
  // Interpolated between bins by a parabola.
  const long at = reach - std::lround(best.later_s / AngularSpeedSeries::kBin_s);
  if (best.moved && at > 0 && at < 2 * reach) {
    const auto i = static_cast<std::size_t>(at);
    const double bend = correlations[i - 1] - 2.0 * correlations[i] + correlations[i + 1];
    if (bend < 0.0 && correlations[i - 1] > kNone && correlations[i + 1] > kNone)
      best.later_s -= 0.5 * AngularSpeedSeries::kBin_s * (correlations[i - 1] - correlations[i + 1]) / bend;
  }
  return best;
}

}  // namespace evical
