// Agreement of the rotation of two IMUs on one body, and their clock offset, from the norms of their rates:
// independent of the rotation between them.
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
  // Values of bins from the first sample on; bins without samples repeat the previous value.
  std::vector<double> filled() const;
  long firstBin() const { return first_; }

 private:
  long first_ = 0;
  std::vector<double> sums_, counts_;
};

struct ClockAgreement {
  double later_s = 0.0;      // correction to add to the nominal offset
  double correlation = 0.0;  // largest one, -1..1
  double ratio = 1.0;        // of this IMU's norms to the reference's
  bool moved = false;        // true if the motion suffices
};

// Times of both are on the reference's clock with the nominal offset.
ClockAgreement crossCorrelateClocks(const AngularSpeedSeries& reference, const AngularSpeedSeries& own,
                                    const MaintenanceOptions& options);

}  // namespace evical
