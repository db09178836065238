#include "core/pipeline/maintain/maintain_imus.h"

#include "core/base/child_process.h"
#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/number.h"
#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/maintenance/clock_agreement.h"
#include "core/maintenance/imu_pairs.h"
#include "core/maintenance/maintenance_options.h"
#include "core/numerics/angles.h"
#include "core/pipeline/maintain/imu_logs.h"
#include "core/pipeline/maintain/maintained_quantities.h"
#include "core/pipeline/maintain/maintained_trajectory.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/recording/inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace evical {
namespace {

// Variances relative to white noise from which a note, and advice, is given.
constexpr double kWorthANote = 1.5;
constexpr double kWorthAdvice = 4.0;

// Sample times of one sensor.
struct SampleTimes {
  double first_s = 0.0, last_s = 0.0, max_gap_s = 0.0, longest_gap_at_s = 0.0;
  std::uint64_t samples = 0;

  void add(double time_s) {
    if (samples == 0) first_s = last_s = time_s;
    if (time_s - last_s > max_gap_s) {
      max_gap_s = time_s - last_s;
      longest_gap_at_s = last_s;
    }
    ++samples;
    last_s = std::max(last_s, time_s);
  }
  double rate_hz() const {
    return last_s > first_s ? static_cast<double>(samples - 1) / (last_s - first_s) : 0.0;
  }
};

// Sample times of both sensors of an IMU, which may be sampled separately.
struct ImuTimes {
  SampleTimes rates, forces;

  void add(double time_s, const ImuSample& sample) {
    if (measuresRate(sample)) rates.add(time_s);
    if (measuresForce(sample)) forces.add(time_s);
  }
  double from_s() const { return std::min(rates.first_s, forces.first_s); }
  double to_s() const { return std::max(rates.last_s, forces.last_s); }
  const SampleTimes& withLongestGap() const { return forces.max_gap_s > rates.max_gap_s ? forces : rates; }
};

// Data of one IMU over the whole log.
struct ImuPass {
  WindowMeans means;
  ImuTimes times;

  void add(double time_s, const ImuSample& sample) {
    times.add(time_s, sample);
    means.add(time_s, sample);
  }
};

// Data of the log's beginning.
struct InitialSegment {
  AngularSpeedSeries norms;
  ImuTimes times;
  std::vector<ImuSample> samples;
};

// Rejects streams without one of the sensors, which would look like a large change.
void checkBothSensors(const std::string& imu, const std::string& stream,
                      const std::vector<ImuSample>& samples) {
  bool rates = false, forces = false;
  std::vector<ImuSample> whole;
  for (const ImuSample& sample : samples) {
    rates = rates || (measuresRate(sample) && !sample.angular_rate_rad_s.isZero(0.0));
    forces = forces || (measuresForce(sample) && !sample.specific_force_m_s2.isZero(0.0));
    if (sample.measured_by == MeasuredBy::Both) whole.push_back(sample);
  }
  const bool alternating = imuStreamKind(whole) == ImuStreamKind::Alternating;
  if (samples.empty() || (rates && forces && !alternating)) return;
  if (alternating)
    throw badInput(
        imu, fmt::format("the messages of {} alternate between gyroscope and accelerometer", stream),
        "Name it for both sensors: " + howTo(HowTo::NameLogOfImu, {imu, fmt::format("'{0} + {0}'", stream)}));
  throw badInput(
      imu, fmt::format("{} has no measurements of the {}", stream, rates ? "accelerometer" : "gyroscope"),
      "Name both streams: " + howTo(HowTo::NameLogOfImu, {imu, "'GYROSCOPE + ACCELEROMETER'"}));
}

class Maintainer {
 public:
  Maintainer(const MaintainInput& input, const RunContext& context) : input_(input), context_(context) {}

  Maintenance run() {
    const Stopwatch all;
    gravity_m_s2_ = input_.options->gravity_m_s2 > 0.0
                        ? input_.options->gravity_m_s2
                        : input_.before.result->state.gravity_in_world_m_s2.norm();
    scanBeginning();
    readAll();
    describe();
    checkLogs();
    const double tests = 4.0 * static_cast<double>(imus_.size()) +
                         5.0 * static_cast<double>(imus_.size() - 1) +
                         (input_.trajectory.empty() ? 0.0 : 3.0);
    const double one_test = 0.5 * input_.options->false_alarms / tests;
    addStops(one_test);
    addTrajectory(one_test);
    addPairs(one_test);
    maintenance_.false_alarms = input_.options->false_alarms;
    nameChangedReference(maintenance_);
    judge(maintenance_);
    advise();
    maintenance_.took_s = all.elapsed_s();
    maintenance_.memory_peak_mb = peakMemory_mb();
    return std::move(maintenance_);
  }

 private:
  const NamedResult& before() const { return input_.before; }
  const ImuState& state(std::size_t imu) const { return before().result->state.imus[imu]; }
  const std::string& name(std::size_t imu) const { return before().imus[imu].name; }

  // Reads the first seconds: existing IMUs, their rates, and offsets between their clocks.
  void scanBeginning();
  // Reads the whole log into means and pairs.
  void readAll();
  void describe();
  void checkLogs() const;
  void addStops(double false_alarms);
  void addTrajectory(double false_alarms);
  void addPairs(double false_alarms);
  void advise();

  PairNominal nominalOf(std::size_t imu) const;
  void agreeClocks(const std::vector<InitialSegment>& seen);
  bool isNearNominal(const PairTrack& track) const;
  PairTrack trackOf(std::size_t k, double false_alarms) const;

  const MaintainInput& input_;
  const RunContext& context_;
  Maintenance maintenance_;
  double gravity_m_s2_ = 9.81, smoothing_s_ = 0.02;
  std::vector<std::size_t> imus_;  // of the result, the reference first
  std::vector<PairNominal> nominal_, nominal_before_;
  std::vector<ImuPass> passes_;
  std::vector<std::vector<PairWindow>> windows_;
  std::vector<std::string> disagreeing_;
  std::string shaken_;  // a pair with correlated noise between its IMUs
  std::vector<std::string> streams_;
  std::vector<double> stamp_steps_s_;
};

// An IMU relative to the reference, independent of the result's reference.
PairNominal Maintainer::nominalOf(std::size_t imu) const {
  const ImuState &own = state(imu), &reference = state(imus_.front());
  PairNominal nominal;
  nominal.reference_from_imu = inverse(reference.reference_from_imu) * own.reference_from_imu;
  nominal.time_offset_s = own.time_offset_s - reference.time_offset_s;
  return nominal;
}

void Maintainer::scanBeginning() {
  constexpr double kLook_s = 90.0;
  constexpr std::size_t kLooked = 20'000;  // samples in which both sensors must have measured
  context_.progress.stageStarted("look");
  ImuLogs logs(input_.logs, before(), input_.settings, input_.readings, context_.stop);
  imus_ = logs.imus();
  const auto reference = std::find_if(imus_.begin(), imus_.end(),
                                      [&](std::size_t imu) { return name(imu) == before().reference; });
  if (reference != imus_.end()) std::rotate(imus_.begin(), reference, reference + 1);
  for (const std::size_t imu : imus_) {
    nominal_.push_back(nominalOf(imu));
    streams_.push_back(logs.stream(imu).name);
  }
  nominal_before_ = nominal_;
  maintenance_.notes = logs.notes();
  std::vector<InitialSegment> seen(imus_.size());
  SensorPacket packet;
  while (logs.read(packet)) {
    context_.throwIfStopped();
    const auto k =
        static_cast<std::size_t>(std::find(imus_.begin(), imus_.end(), packet.sensor) - imus_.begin());
    for (const ImuSample& sample : packet.imu_samples) {
      const double time_s = secondsSince(logs.start_ns(), sample.time_ns);
      seen[k].times.add(time_s, sample);
      if (seen[k].samples.size() < kLooked) seen[k].samples.push_back(sample);
      if (!measuresRate(sample)) continue;
      seen[k].norms.add(time_s + nominal_[k].time_offset_s,
                        sample.angular_rate_rad_s - state(packet.sensor).gyroscope_bias_rad_s);
    }
    if (std::all_of(seen.begin(), seen.end(),
                    [](const InitialSegment& imu) { return imu.times.to_s() > kLook_s; }))
      break;
  }
  context_.throwIfStopped();
  for (std::size_t k = 0; k < seen.size(); ++k)
    checkBothSensors(name(imus_[k]), streams_[k], std::exchange(seen[k].samples, {}));
  double slowest_hz = 0.0;
  for (const InitialSegment& imu : seen)
    for (const double rate_hz : {imu.times.rates.rate_hz(), imu.times.forces.rate_hz()})
      if (rate_hz > 0.0 && (slowest_hz == 0.0 || rate_hz < slowest_hz)) slowest_hz = rate_hz;
  smoothing_s_ = smoothingFor(slowest_hz, *input_.options);
  agreeClocks(seen);
}

void Maintainer::agreeClocks(const std::vector<InitialSegment>& seen) {
  constexpr double kNear_s = 0.004;
  for (std::size_t k = 1; k < imus_.size(); ++k) {
    const ClockAgreement clocks = crossCorrelateClocks(seen.front().norms, seen[k].norms, *input_.options);
    if (!clocks.moved) continue;
    if (clocks.correlation < input_.options->same_motion) {
      disagreeing_.push_back(name(imus_[k]));
      continue;
    }
    constexpr double kDegrees = kDegPerRad;
    for (const double wrong : {kDegrees, 1.0 / kDegrees})
      if (clocks.ratio > 0.8 * wrong && clocks.ratio < 1.25 * wrong)
        throw badInput(
            name(imus_[k]),
            fmt::format(
                "its rates are {:.1f} times those of {}: one of the logs has a wrong unit (deg/s or rad/s)",
                clocks.ratio, name(imus_.front())),
            "Convert the wrong log, or give " + howTo(HowTo::SetAngularRateUnit, {"UNIT"}) +
                " if all logs have the same unit");
    if (std::abs(clocks.later_s) > kNear_s) nominal_[k].time_offset_s += clocks.later_s;
  }
}

void Maintainer::readAll() {
  context_.progress.stageStarted("read");
  ImuLogs logs(input_.logs, before(), input_.settings, input_.readings, context_.stop);
  passes_.assign(imus_.size(), {});
  std::vector<ImuState> states;
  for (const std::size_t imu : imus_) states.push_back(state(imu));
  ImuPairs pairs(states, nominal_, smoothing_s_, *input_.options);
  SensorPacket packet;
  while (logs.read(packet)) {
    context_.throwIfStopped();
    const auto k =
        static_cast<std::size_t>(std::find(imus_.begin(), imus_.end(), packet.sensor) - imus_.begin());
    for (const ImuSample& sample : packet.imu_samples) {
      const double time_s = secondsSince(logs.start_ns(), sample.time_ns);
      passes_[k].add(time_s, sample);
      if (imus_.size() > 1) pairs.add(k, time_s, sample);
    }
    context_.progress.stageProgress(logs.fractionRead());
  }
  context_.throwIfStopped();
  pairs.finish();
  for (ImuPass& pass : passes_) pass.means.finish();
  windows_ = pairs.windows();
  stamp_steps_s_.clear();
  for (const std::size_t imu : imus_) stamp_steps_s_.push_back(logs.stampStep_s(imu));
  if (!maintenance_.imus.empty()) return;  // second reading: already reported
  for (const RecordingFault& fault : logs.faults()) {
    context_.progress.log(LogLevel::Warning, fault.text);
    if (maintenance_.notes.size() < 20) maintenance_.notes.push_back(fault.text);
  }
}

void Maintainer::describe() {
  for (std::size_t k = 0; k < imus_.size(); ++k) {
    MaintainedImu& imu = maintenance_.imus.emplace_back();
    imu.name = name(imus_[k]);
    imu.stream = streams_[k];
    const ImuTimes& times = passes_[k].times;
    const SampleTimes& gaps = times.withLongestGap();
    imu.from_s = times.from_s();
    imu.to_s = times.to_s();
    imu.rate_hz = times.rates.rate_hz();
    maintenance_.duration_s = std::max(maintenance_.duration_s, imu.to_s);
    if (gaps.max_gap_s > input_.options->gap_s)
      maintenance_.notes.push_back(
          fmt::format("{}: samples are missing, for {:.2f} s at {:.2f} s and possibly elsewhere; windows "
                      "with gaps are excluded",
                      imu.name, gaps.max_gap_s, gaps.longest_gap_at_s));
  }
}

void Maintainer::checkLogs() const {
  const auto samplesOf = [](const ImuPass& pass) {
    return std::max(pass.times.rates.samples, pass.times.forces.samples);
  };
  if (std::ranges::all_of(passes_, [&](const ImuPass& pass) { return samplesOf(pass) < kFewestImuSamples; }))
    throw badInput(
        input_.logs.front().string(),
        fmt::format("{} has {}", name(imus_.front()), counted(samplesOf(passes_.front()), "sample")),
        "Record again, or copy the file again");
  const auto means = [this](std::size_t k) { return ImuMeans{name(imus_[k]), passes_[k].means.windows()}; };
  for (std::size_t k = 0; k < imus_.size(); ++k) {
    checkUnits(means(k));
    if (k > 0)
      checkDirection(means(k), means(0), nominal_[k].reference_from_imu.rotation, nominal_[k].time_offset_s);
  }
}

void Maintainer::addStops(double false_alarms) {
  for (std::size_t k = 0; k < imus_.size(); ++k) {
    const std::vector<MeansWindow>& windows = passes_[k].means.windows();
    const StopCalibration found =
        calibrateFromStops(windows, state(imus_[k]), gravity_m_s2_, *input_.options);
    MaintainedImu& imu = maintenance_.imus[k];
    if (found.stops.empty()) {
      maintenance_.notes.push_back(
          fmt::format("{}: it is never at rest for {:g} s", imu.name, input_.options->min_stop_s));
      continue;
    }
    const MaintainedImu from_stops = maintainedImu(found);
    imu.stops = from_stops.stops;
    imu.weakest = from_stops.weakest;
    imu.weakest_sigma = from_stops.weakest_sigma;
    imu.misfit = from_stops.misfit;
    addStopQuantities(found, before(), imus_[k], *input_.options, false_alarms, maintenance_);
  }
}

void Maintainer::addTrajectory(double false_alarms) {
  if (input_.trajectory.empty()) return;
  const std::size_t imu = imus_.front();
  const TrajectoryRun run = runTrajectory(input_, imu, gravity_m_s2_, context_);
  if (run.later_s != 0.0)
    maintenance_.notes.push_back(
        fmt::format("the trajectory's clock differs by {:.1f} ms from that of {}; this is corrected",
                    1e3 * run.later_s, name(imu)));
  if (run.lags.empty())
    maintenance_.notes.push_back(
        fmt::format("the trajectory has no gap-free piece of {:g} s with samples of {}",
                    0.5 * input_.options->lag_s, name(imu)));
  if (run.sum.inflation > kWorthANote)
    maintenance_.notes.push_back(fmt::format(
        "pieces of the trajectory differ by more than their sigmas, which are therefore {:.1f} times larger",
        std::sqrt(run.sum.inflation)));
  addTrajectoryQuantities(run.lags, run.sum, before(), imu, *input_.options, false_alarms, maintenance_);
}

PairTrack Maintainer::trackOf(std::size_t k, double false_alarms) const {
  const SensorDescription &own = before().imus[imus_[k]], &reference = before().imus[imus_.front()];
  const auto walk = [](double a, double b, double otherwise) {
    return std::hypot(a > 0.0 ? a : otherwise, b > 0.0 ? b : otherwise);
  };
  PairModel model;
  model.gyroscope_walk = walk(own.noise.gyroscope_random_walk, reference.noise.gyroscope_random_walk,
                              input_.options->gyroscope_walk);
  model.accelerometer_walk =
      walk(own.noise.accelerometer_random_walk, reference.noise.accelerometer_random_walk,
           input_.options->accelerometer_walk);
  model.smoothing_s = smoothing_s_;
  model.lever_m = nominal_[k].reference_from_imu.translation_m;
  return trackPair(windows_[k], model, false_alarms, *input_.options);
}

// True if the pair is close enough to its linearisation point.
bool Maintainer::isNearNominal(const PairTrack& track) const {
  constexpr double kRotation_rad = 0.02, kOffset_s = 0.004;
  const auto known = [&](Eigen::Index first, Eigen::Index count) {
    return track.start_covariance.diagonal().segment(first, count).maxCoeff() < 1e-4;
  };
  return !(known(0, 3) && track.start.head<3>().norm() > kRotation_rad) &&
         !(known(6, 1) && std::abs(track.start[6]) > kOffset_s);
}

void Maintainer::addPairs(double false_alarms) {
  if (imus_.size() < 2) return;
  const double of_pair = 0.5 * input_.options->false_alarms / static_cast<double>(imus_.size() - 1);
  constexpr int kRounds = 3;
  std::vector<PairTrack> tracks(imus_.size());
  for (int round = 0; round < kRounds; ++round) {
    bool again = false;
    context_.progress.stageStarted("follow");
    for (std::size_t k = 1; k < imus_.size(); ++k) {
      context_.throwIfStopped();
      tracks[k] = trackOf(k, of_pair);
      if (tracks[k].times_s.empty() || isNearNominal(tracks[k]) || round + 1 == kRounds) continue;
      RigidTransform& pose = nominal_[k].reference_from_imu;
      pose.rotation = (quaternionExp(tracks[k].start.head<3>()) * pose.rotation).normalized();
      nominal_[k].time_offset_s += tracks[k].start[6];
      again = true;
    }
    if (!again) break;
    readAll();
  }
  for (std::size_t k = 1; k < imus_.size(); ++k) {
    const std::string pair = fmt::format("{} against {}", name(imus_[k]), name(imus_.front()));
    if (tracks[k].times_s.empty()) {
      maintenance_.notes.push_back(pair + ": the two do not overlap in time");
      continue;
    }
    addPairQuantities({imus_[k], imus_.front(), nominal_[k], nominal_before_[k], tracks[k],
                       0.5 * std::hypot(stamp_steps_s_[k], stamp_steps_s_.front())},
                      before(), *input_.options, false_alarms, maintenance_);
    double wider = 1.0;
    for (const NoiseAutocorrelation& colour : tracks[k].colours) wider = std::max(wider, colour.ofMany());
    if (wider > kWorthAdvice) shaken_ = pair;
    if (wider > kWorthANote)
      maintenance_.notes.push_back(
          fmt::format("{}: the residuals between the two are not white noise; sigmas are therefore up to "
                      "{:.1f} times larger",
                      pair, std::sqrt(wider)));
  }
}

void Maintainer::advise() {
  for (const std::string& imu : disagreeing_) {
    maintenance_.notes.push_back(
        fmt::format("the rotation of {} does not match that of {}: their clocks differ by more than {:g} s, "
                    "or they are not on one body",
                    imu, name(imus_.front()), input_.options->time_offset_search_s));
    maintenance_.advice.emplace_back(
        "Record the IMUs with one clock, or increase maintain.time_offset_search_s");
  }
  // Numbers of IMUs that do not move together are not meaningful.
  if (!disagreeing_.empty()) {
    maintenance_.verdict = Verdict::CannotTell;
    maintenance_.reason = fmt::format("the rotation of {} does not match that of {}", disagreeing_.front(),
                                      name(imus_.front()));
    return;
  }
  if (maintenance_.verdict != Verdict::CannotTell) return;
  for (const MaintainedImu& imu : maintenance_.imus) {
    if (imu.stops.empty() && imus_.size() < 2)
      maintenance_.advice.emplace_back(
          "Keep the rig at rest for a few seconds in each of at least nine different orientations");
    else if (!imu.weakest.empty() && imus_.size() < 2)
      maintenance_.advice.push_back(
          fmt::format("Keep the rig at rest in more orientations: the weakest direction is {} of {}",
                      imu.weakest, imu.name));
  }
  if (!shaken_.empty())
    maintenance_.advice.push_back(fmt::format(
        "The residuals between {} are correlated: mount them more stiffly, or reduce vibration", shaken_));
  if (imus_.size() > 1)
    maintenance_.advice.emplace_back("Rotate the rig about all its axes, briskly and for one minute");
}

}  // namespace

MaintainInput::MaintainInput() = default;

MaintainInput readMaintainInput(const std::vector<std::filesystem::path>& logs,
                                const std::filesystem::path& result) {
  MaintainInput input;
  input.logs = logs;
  input.before = readOldResult(result, "maintained");
  input.before_name = result.string();
  if (input.before.imus.empty())
    throw badInput(resultFileOf(result).string(), "has no IMUs",
                   "Give the result of a calibration with IMUs");
  if (const std::optional<Session> session = sessionOfOldResult(result))
    for (const SessionImu& imu : session->imus) input.readings[imu.name] = imu;
  return input;
}

Maintenance maintainImus(const MaintainInput& input, const RunContext& context) {
  Maintenance maintenance = Maintainer(input, context).run();
  for (const std::filesystem::path& log : input.logs) maintenance.inputs.push_back(log.string());
  maintenance.before = input.before_name;
  return maintenance;
}

}  // namespace evical
