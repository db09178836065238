#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "core/egomotion/rotation_alignment.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/camera_motion.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/benchmarks/benchmark_program.h"

#include <ctime>
#include <map>

namespace evical {
namespace {

double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

int main(int argc, char** argv) {
  CLI::App app("proto");
  ScenarioArguments arguments;
  arguments.addTo(app);
  bool dump = false;
  std::vector<std::string> settings;
  app.add_flag("--dump", dump);
  app.add_option("--set", settings);
  CLI11_PARSE(app, argc, argv);
  for (const std::string& file : arguments.files)
    for (int seed = 0; seed < arguments.seeds; ++seed) {
      Scenario scenario = arguments.read(file, seed);
      CalibrationOptions options;
      for (const std::string& s : settings) {
        const auto equals = s.find('=');
        setOption(options, s.substr(0, equals), s.substr(equals + 1));
      }
      const SimulatedCamera& camera = scenario.cameras.front();
      CameraMotion motion(camera.intrinsics, options, scenario.start_ns);
      BurstExtractor bursts(camera.intrinsics.resolution_px, options.front_end.bursts);
      double own = 0.0, all = cpu_s();
      std::uint64_t events = 0, burst_count = 0;
      std::vector<EdgeBurst> found;
      simulateEvents(
          scenario, 0,
          [&](EventSpan span) {
            const double t = cpu_s();
            events += span.size();
            found.clear();
            bursts.add(span, found);
            burst_count += found.size();
            motion.add(found, bursts.completeUntil_ns());
            own += cpu_s() - t;
          },
          {}, 1);
      double t = cpu_s();
      found.clear();
      bursts.finish(found);
      motion.add(found, bursts.completeUntil_ns());
      std::vector<WindowMotion> windows = motion.finish();
      own += cpu_s() - t;
      all = cpu_s() - all;
      const std::vector<ImuSample> samples = simulateImu(scenario, 0);
      const Eigen::Quaterniond truth = camera.imu_from_camera.rotation;
      const double true_offset = camera.time_offset_s - camera.delay_s();
      t = cpu_s();
      RotationAlignment alignment =
          alignRotation(windows, {samples, scenario.start_ns, scenario.imus.front()}, {truth, true_offset},
                        options.egomotion);
      const double align = cpu_s() - t;
      std::map<int, int> uses;
      int alone = 0;
      double slopes = 0;
      for (const auto& w : windows) {
        ++uses[static_cast<int>(w.use)];
        alone += w.rotation_alone;
        slopes += static_cast<double>(w.slopes);
      }
      const SinusoidMotion true_motion(scenario);
      Eigen::Matrix3d cov = Eigen::Matrix3d::Zero();
      Eigen::Vector3d err2 = Eigen::Vector3d::Zero(), rate2 = err2;
      Eigen::Matrix3d xty = cov, xtx = cov;
      int n = 0;
      double speed2 = 0;
      for (const auto& w : windows) {
        if (w.use != WindowUse::Used) continue;
        const double tt = w.middle_s() + true_offset;
        const MotionState s = true_motion.cameraAt(0, tt);
        const Eigen::Vector3d e = w.rate_rad_s - s.angular_velocity_in_body_rad_s;
        err2 += e.cwiseAbs2();
        rate2 += s.angular_velocity_in_body_rad_s.cwiseAbs2();
        xty += s.angular_velocity_in_body_rad_s * w.rate_rad_s.transpose();
        xtx += s.angular_velocity_in_body_rad_s * s.angular_velocity_in_body_rad_s.transpose();
        speed2 += s.velocity_in_world_m_s.squaredNorm();
        if (dump) {
          const Eigen::Vector3d v = s.world_from_body.rotation.conjugate() * s.velocity_in_world_m_s;
          const Eigen::Vector3d sg = w.covariance.diagonal().cwiseSqrt();
          fmt::print(
              "D {:.3f} n {} in {:.2f} w {:.3f} {:.3f} {:.3f} est {:.3f} {:.3f} {:.3f} sig {:.4f} {:.4f} "
              "{:.4f} v {:.2f} {:.2f} {:.2f} est {:.2f} {:.2f} {:.2f} alone {}\n",
              tt, w.slopes, w.inliers, s.angular_velocity_in_body_rad_s.x(),
              s.angular_velocity_in_body_rad_s.y(), s.angular_velocity_in_body_rad_s.z(), w.rate_rad_s.x(),
              w.rate_rad_s.y(), w.rate_rad_s.z(), sg.x(), sg.y(), sg.z(), v.x(), v.y(), v.z(),
              w.velocity_1_s.x(), w.velocity_1_s.y(), w.velocity_1_s.z(), w.rotation_alone);
        }
        ++n;
      }
      fmt::print("events {} bursts {} slopes/window {:.0f} cpu all {:.1f} own {:.2f} align {:.2f}; windows",
                 events, burst_count, slopes / static_cast<double>(windows.size()), all, own, align);
      for (auto [k, c] : uses) fmt::print(" {}:{}", k, c);
      const Eigen::Matrix3d M = (xtx.inverse() * xty).transpose();
      fmt::print(" alone {}\n  rate rms {:.3f} {:.3f} {:.3f} err rms {:.4f} {:.4f} {:.4f} speed {:.2f}\n",
                 alone, std::sqrt(rate2.x() / n), std::sqrt(rate2.y() / n), std::sqrt(rate2.z() / n),
                 std::sqrt(err2.x() / n), std::sqrt(err2.y() / n), std::sqrt(err2.z() / n),
                 std::sqrt(speed2 / n));
      fmt::print("  M {:.4f} {:.4f} {:.4f} | {:.4f} {:.4f} {:.4f} | {:.4f} {:.4f} {:.4f}\n", M(0, 0), M(0, 1),
                 M(0, 2), M(1, 0), M(1, 1), M(1, 2), M(2, 0), M(2, 1), M(2, 2));
      if (!alignment.found()) {
        fmt::print("  FAILED {}\n", alignment.failure);
        continue;
      }
      const Eigen::Vector3d turn = kDegPerRad * quaternionLog(alignment.imu_from_camera * truth.conjugate());
      const Eigen::Vector4d sigma = alignment.covariance.diagonal().cwiseSqrt();
      const double dt = 1e3 * (alignment.time_offset_s - true_offset);
      fmt::print(
          "  rot err {:.3f} {:.3f} {:.3f} deg (sigma {:.3f} {:.3f} {:.3f}), offset err {:.3f} ms ({:.3f}), "
          "scale {:.4f}, blocks {}, misfit {:.4f}\n",
          turn.x(), turn.y(), turn.z(), kDegPerRad * sigma[0], kDegPerRad * sigma[1], kDegPerRad * sigma[2],
          dt, 1e3 * sigma[3], alignment.scale, alignment.blocks, alignment.misfit_rms_rad_s);
      std::fflush(stdout);
    }
  return 0;
}

}  // namespace
}  // namespace evical

int main(int argc, char** argv) {
  return evical::guarded(evical::main, argc, argv);
}
