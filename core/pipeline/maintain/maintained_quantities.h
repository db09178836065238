// Results from stops, other IMUs and trajectories as displayed quantities and steps, and the verdict from
// them.
#pragma once

#include "core/data/assessment.h"
#include "core/maintenance/pair_tracking.h"
#include "core/maintenance/stop_calibration.h"
#include "core/maintenance/trajectory_segment.h"
#include "core/report/result_yaml.h"

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

struct MaintenanceOptions;

// `false_alarms`: of one test.
void addStopQuantities(const StopCalibration& found, const NamedResult& before, std::size_t imu,
                       const MaintenanceOptions& options, double false_alarms, Maintenance& maintenance);
MaintainedImu maintainedImu(const StopCalibration& found);

// Quantities from a trajectory, with their course over its pieces.
void addTrajectoryQuantities(const std::vector<LagEstimate>& lags, const LagSum& sum,
                             const NamedResult& before, std::size_t imu, const MaintenanceOptions& options,
                             double false_alarms, Maintenance& maintenance);

// An IMU and the reference, both of the old result; the track is relative to the nominal pair.
struct TrackedPair {
  std::size_t imu = 0, reference = 0;
  PairNominal nominal, before;
  PairTrack track;
  double stamp_error_s = 0.0;  // sigma that coarse stamps of the two leave in the time offset
};
void addPairQuantities(const TrackedPair& pair, const NamedResult& before, const MaintenanceOptions& options,
                       double false_alarms, Maintenance& maintenance);

// Verdict. "Unchanged" requires conclusive results for quantities between IMUs, or for those of a single IMU
// itself.
void judge(Maintenance& maintenance);

// If all IMUs change relative to one of them at the same time, that one has changed.

// Steps of one quantity that all pairs have at the same time become one step of the reference IMU. Its
// numbers are omitted, since each pair has them in other axes. For a single pair it is ambiguous which IMU
// has changed.
void nameChangedReference(Maintenance& maintenance);

}  // namespace evical
