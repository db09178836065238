// What a log says of IMUs that were calibrated before: what of them has changed since, what changed on the way and when,
// and how small a change would have shown.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace evical {

enum class MaintenanceVerdict { Unchanged, Changed, CannotTell };

// What a number comes from.
enum class MaintenanceSource { Stops, Trajectory, OtherImu };

// One number of a quantity, in shown units.
struct MaintainedNumber {
  std::string name, unit;                   // "accelerometer_bias.x", "m/s^2"
  double before = 0.0, before_sigma = 0.0;  // as the old result has it
  double now = 0.0, now_sigma = 0.0;        // as the log says; sigma 0 where it says nothing
};

// A quantity as a whole, in one unit.
struct MaintainedQuantity {
  std::string sensor, against, name, title, unit;  // `against` the IMU that it is relative to; empty: none
  MaintenanceSource source = MaintenanceSource::Stops;
  std::vector<MaintainedNumber> numbers;
  double change = 0.0, change_sigma = 0.0;  // if this alone has changed
  double chi_square = 0.0, limit = 0.0;
  double would_notice = 0.0;  // the smallest change that is found with 95 %, in any direction
  double matters = 0.0;       // what is asked of that
  bool changed = false;

  bool told() const { return would_notice <= matters; }
};

// Something that changed on the way; `against` is empty where several IMUs tell that it was this one.
struct MaintenanceStep {
  std::string sensor, against, name, title, unit;
  double at_s = 0.0, noticed_s = 0.0;  // since the log's start, on the reference IMU's clock
  double size = 0.0, size_sigma = 0.0;
  std::vector<MaintainedNumber> numbers;
  double chi_square = 0.0, limit = 0.0;
  std::vector<std::string> or_else;  // quantities that explain it nearly as well
};

struct MaintainedStop {
  double from_s = 0.0, to_s = 0.0;
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero(),
                  rate_rad_s = Eigen::Vector3d::Zero();  // means, as measured
  double residual_m_s2 = 0.0, sigma_m_s2 = 0.0;  // of |M^-1 (f - b)| less gravity, with the numbers of now
  bool used = true;
};

// Of one IMU alone.
struct MaintainedImu {
  std::string name, stream;
  double from_s = 0.0, to_s = 0.0, rate_hz = 0.0;
  std::vector<MaintainedStop> stops;
  std::string weakest;  // what stops tell least, in words; empty without any
  double weakest_sigma = 0.0;
  double misfit = 0.0;  // RMS of the stops' residuals over their sigmas; 0: too few to tell
};

// How numbers went over time: each with its sigma behind it.
struct MaintenanceTrack {
  std::string sensor, against;
  std::vector<std::string> columns;  // "rotation.x [deg]"
  std::vector<double> times_s;
  std::vector<std::vector<double>> values, sigmas;  // by column
};

// Whether it shows there: of the pair itself, or of the IMU that the pair is held against.
inline bool isIn(const MaintenanceStep& step, const MaintenanceTrack& track) {
  return step.sensor == track.sensor ? step.against == track.against
                                     : step.against.empty() && step.sensor == track.against;
}

struct Maintenance {
  MaintenanceVerdict verdict = MaintenanceVerdict::CannotTell;
  std::string reason;  // a sentence without its full stop
  std::vector<MaintainedImu> imus;
  std::vector<MaintainedQuantity> quantities;
  std::vector<MaintenanceStep> steps;
  std::vector<MaintenanceTrack> tracks;
  std::vector<std::string> notes, advice;
  double false_alarms = 0.0;  // how often a log in which nothing changes has an alarm, at most
  double duration_s = 0.0, took_s = 0.0, memory_peak_mb = 0.0;
  std::vector<std::string> logs;  // as people know them
  std::string before, version;
};

}  // namespace evical
