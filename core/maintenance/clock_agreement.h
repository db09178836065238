// Whether two IMUs on one body turn alike, and how their clocks lie to each other, from the norms of their rates: no
// rotation between them is needed for that.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace evical {

struct MaintenanceOptions;

// Means of a rate's norm over hundredths of a second.
class AngularSpeedSeries {
 public:
  static constexpr double kBin_s = 0.01;

  void add(double time_s, const Eigen::Vector3d& rate_rad_s);

  bool empty() const { return sums_.empty(); }
  // Of bins from the first sample's on; those without samples have the one before.
  std::vector<double> filled() const;
  long firstBin() const { return first_; }

 private:
  long first_ = 0;
  std::vector<double> sums_, counts_;
};

struct ClockAgreement {
  double later_s = 0.0;      // of the own times: what to add to the nominal offset
  double correlation = 0.0;  // at best, -1..1
  double ratio = 1.0;        // of the own norms to the reference's
  bool moved = false;        // enough to tell
};

// Times of both on the reference's clock by the nominal offset.
ClockAgreement crossCorrelateClocks(const AngularSpeedSeries& reference, const AngularSpeedSeries& own,
                                    const MaintenanceOptions& options);

}  // namespace evical
