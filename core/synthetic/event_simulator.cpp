#include "core/synthetic/event_simulator.h"

#include "core/base/time.h"
#include "core/synthetic/scene_renderer.h"
#include "core/synthetic/sinusoid_motion.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

namespace evical {
namespace {

constexpr double kPacket_s = 0.01;
constexpr double kStepTravel_px = 0.25;  // the image moves no further in one step
constexpr double kLongestStep_s = 0.005;

double uniform(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11) * 0x1.0p-53;
}

struct PixelState {
  float level = 0.0f;      // low-passed log intensity
  float input = 0.0f;      // log intensity at the end of the last step
  float reference = 0.0f;  // level at the last event
  float threshold_on = 0.0f, threshold_off = 0.0f;
  double last_event_s = -1.0;
};

// One instant of a step: time on the reference's clock and what the renderer needs.
struct Step {
  double begin_s, end_s;
  SceneRenderer::Instant at_end;
};

class PixelArray {
 public:
  PixelArray(const Scenario& scenario, std::size_t camera)
      : scenario_(scenario),
        camera_(scenario.cameras[camera]),
        renderer_(scenario, camera),
        width_px_(camera_.intrinsics.resolution_px.width_px),
        height_px_(camera_.intrinsics.resolution_px.height_px),
        pixels_(static_cast<std::size_t>(width_px_ * height_px_)) {
    std::mt19937_64 generator(scenario.seed * 2654435761u + camera);
    std::normal_distribution<double> normal;
    constexpr double kLeastFactor = 0.3;
    for (PixelState& pixel : pixels_) {
      const double on = std::max(1.0 + camera_.pixel.threshold_mismatch * normal(generator), kLeastFactor);
      const double off = std::max(1.0 + camera_.pixel.threshold_mismatch * normal(generator), kLeastFactor);
      pixel.threshold_on = static_cast<float>(camera_.pixel.threshold_on * on);
      pixel.threshold_off = static_cast<float>(camera_.pixel.threshold_off * off);
    }
    for (int y = 0; y < height_px_; ++y)
      row_noise_.emplace_back(scenario.seed * 1099511628211ull + 7u * y + camera);
    for (int k = 0; k < camera_.pixel.hot_pixels; ++k) {
      const auto x = static_cast<int>(uniform(generator) * width_px_);
      const auto y = static_cast<int>(uniform(generator) * height_px_);
      hot_pixels_.push_back({x, y});
    }
  }

  const SceneRenderer& renderer() const { return renderer_; }
  int rows() const { return height_px_; }

  void reset(const SceneRenderer::Instant& instant, int row_begin, int row_end) {
    for (int y = row_begin; y < row_end; ++y) {
      for (int x = 0; x < width_px_; ++x) {
        PixelState& pixel = at(x, y);
        pixel.level = pixel.input = renderer_.logIntensity(instant, x, y);
        // Pixels have been running before: their references lie anywhere within the thresholds.
        const double part = uniform(row_noise_[static_cast<std::size_t>(y)]);
        pixel.reference = pixel.level +
                          static_cast<float>(part * (pixel.threshold_on + pixel.threshold_off)) -
                          pixel.threshold_on;
      }
    }
  }

  void run(const std::vector<Step>& steps, int row_begin, int row_end, std::vector<Event>& events) {
    for (const Step& step : steps) {
      for (int y = row_begin; y < row_end; ++y) {
        for (int x = 0; x < width_px_; ++x) advance(step, x, y, events);
      }
    }
    for (int y = row_begin; y < row_end; ++y) addNoise(steps.front().begin_s, steps.back().end_s, y, events);
  }

 private:
  PixelState& at(int x, int y) { return pixels_[static_cast<std::size_t>(y * width_px_ + x)]; }

  // The low-pass filter's exact answer to an input that changes linearly over the step; crossings are
  // interpolated.
  void advance(const Step& step, int x, int y, std::vector<Event>& events) {
    PixelState& pixel = at(x, y);
    const float input = renderer_.logIntensity(step.at_end, x, y);
    const double dt = step.end_s - step.begin_s;
    const double before = pixel.level;
    double after = input;
    if (camera_.pixel.low_pass_s > 0.0) {
      const double lag = (input - pixel.input) / dt * camera_.pixel.low_pass_s;
      after = input - lag + (before - pixel.input + lag) * std::exp(-dt / camera_.pixel.low_pass_s);
    }
    pixel.input = input;
    pixel.level = static_cast<float>(after);
    const double slope = (after - before) / dt;
    double level = before, time_s = step.begin_s;
    for (;;) {
      const bool on = after > pixel.reference;
      const double crossing =
          on ? pixel.reference + pixel.threshold_on : pixel.reference - pixel.threshold_off;
      if (on ? after < crossing : after > crossing) return;
      double crossing_s = on == (level >= crossing) ? time_s : step.begin_s + (crossing - before) / slope;
      crossing_s = std::clamp(crossing_s, time_s, step.end_s);
      if (crossing_s < pixel.last_event_s + camera_.pixel.refractory_s) {
        // Held in reset until the refractory period ends: the level then is the new reference.
        const double free_s = pixel.last_event_s + camera_.pixel.refractory_s;
        if (free_s > step.end_s) {
          pixel.reference = static_cast<float>(after);
          return;
        }
        level = before + slope * (free_s - step.begin_s);
        pixel.reference = static_cast<float>(level);
        pixel.last_event_s = -1.0;
        time_s = free_s;
        continue;
      }
      pixel.reference = static_cast<float>(crossing);
      pixel.last_event_s = crossing_s;
      level = crossing;
      time_s = crossing_s;
      push(crossing_s, x, y, on, events);
    }
  }

  void addNoise(double begin_s, double end_s, int y, std::vector<Event>& events) {
    std::mt19937_64& generator = row_noise_[static_cast<std::size_t>(y)];
    std::poisson_distribution<int> count(
        std::max(camera_.pixel.background_rate_hz * width_px_ * (end_s - begin_s), 1e-12));
    for (int k = count(generator); k > 0; --k) {
      const double time_s = begin_s + uniform(generator) * (end_s - begin_s);
      const auto x = static_cast<int>(uniform(generator) * width_px_);
      push(time_s, x, y, uniform(generator) < 0.5, events);
    }
    for (const auto& [hot_x, hot_y] : hot_pixels_) {
      if (hot_y != y) continue;
      std::poisson_distribution<int> hot(
          std::max(camera_.pixel.hot_pixel_rate_hz * (end_s - begin_s), 1e-12));
      for (int k = hot(generator); k > 0; --k) {
        push(begin_s + uniform(generator) * (end_s - begin_s), hot_x, y, uniform(generator) < 0.5, events);
      }
    }
  }

  // The stamp: latency, jitter, the camera's clock, whole microseconds.
  void push(double time_s, int x, int y, bool on, std::vector<Event>& events) {
    double stamp_s = time_s + camera_.pixel.latency_s - camera_.time_offset_s;
    if (camera_.pixel.stamp_jitter_s > 0.0) {
      std::normal_distribution<double> normal(0.0, camera_.pixel.stamp_jitter_s);
      stamp_s += std::abs(normal(row_noise_[static_cast<std::size_t>(y)]));
    }
    const auto stamp_us = static_cast<std::int64_t>(std::llround(stamp_s * 1e6));
    events.push_back({scenario_.start_ns + 1000 * stamp_us, static_cast<std::uint16_t>(x),
                      static_cast<std::uint16_t>(y), on});
  }

  const Scenario& scenario_;
  const SimulatedCamera& camera_;
  SceneRenderer renderer_;
  int width_px_, height_px_;
  std::vector<PixelState> pixels_;
  std::vector<std::mt19937_64> row_noise_;
  std::vector<std::pair<int, int>> hot_pixels_;
};

// Fastest image motion of the board's corners.
double fastestMotion_px_s(const SinusoidMotion& motion, const Scenario& scenario, std::size_t camera,
                          double time_s) {
  const MotionState state = motion.cameraAt(camera, time_s);
  const RigidTransform camera_from_world = inverse(state.world_from_body);
  const Eigen::Vector3d velocity = camera_from_world.rotation * state.velocity_in_world_m_s;
  double fastest = 1.0;
  const CircleBoard& board = scenario.board;
  for (const int corner : {0, board.cols - 1, board.index(board.rows - 1, 0), board.circleCount() - 1}) {
    const Eigen::Vector2d centre = board.centre_m(corner);
    const Eigen::Vector3d point = camera_from_world * Eigen::Vector3d(centre.x(), centre.y(), 0.0);
    Eigen::Matrix<double, 2, 3> jacobian;
    if (!project(scenario.cameras[camera].intrinsics, point, &jacobian)) continue;
    const Eigen::Vector2d v = jacobian * (-velocity - state.angular_velocity_in_body_rad_s.cross(point));
    fastest = std::max(fastest, v.norm());
  }
  return fastest;
}

std::vector<Step> stepsOf(double begin_s, double end_s, const SinusoidMotion& motion,
                          const Scenario& scenario, std::size_t camera, const SceneRenderer& renderer) {
  const double speed = std::max(fastestMotion_px_s(motion, scenario, camera, begin_s),
                                fastestMotion_px_s(motion, scenario, camera, end_s));
  const double step_s = std::min(kStepTravel_px / (1.2 * speed), kLongestStep_s);
  const int count = std::max(1, static_cast<int>(std::ceil((end_s - begin_s) / step_s)));
  std::vector<Step> steps;
  for (int k = 0; k < count; ++k) {
    const double from_s = begin_s + (end_s - begin_s) * k / count,
                 to_s = begin_s + (end_s - begin_s) * (k + 1) / count;
    steps.push_back({from_s, to_s, renderer.at(motion.worldFromCamera(camera, to_s))});
  }
  return steps;
}

}  // namespace

void simulateEvents(const Scenario& scenario, std::size_t camera, const EventSink& sink,
                    const RunContext& context, int threads) {
  const SinusoidMotion motion(scenario);
  PixelArray pixels(scenario, camera);
  const int blocks = std::max(threads, 1);
  std::vector<std::vector<Event>> found(static_cast<std::size_t>(blocks));
  const auto inBlocks = [&](const auto& work) {
    std::vector<std::jthread> workers;
    for (int block = 0; block < blocks; ++block) {
      workers.emplace_back(
          [&, block] { work(block, pixels.rows() * block / blocks, pixels.rows() * (block + 1) / blocks); });
    }
  };
  const SceneRenderer::Instant first = pixels.renderer().at(motion.worldFromCamera(camera, 0.0));
  inBlocks([&](int, int begin, int end) { pixels.reset(first, begin, end); });
  std::vector<Event> packet;
  const int packets = static_cast<int>(std::ceil(scenario.duration_s / kPacket_s));
  for (int k = 0; k < packets; ++k) {
    context.throwIfStopped();
    const double begin_s = k * kPacket_s, end_s = std::min((k + 1) * kPacket_s, scenario.duration_s);
    const std::vector<Step> steps = stepsOf(begin_s, end_s, motion, scenario, camera, pixels.renderer());
    inBlocks([&](int block, int row_begin, int row_end) {
      found[static_cast<std::size_t>(block)].clear();
      pixels.run(steps, row_begin, row_end, found[static_cast<std::size_t>(block)]);
    });
    packet.clear();
    for (const std::vector<Event>& events : found) packet.insert(packet.end(), events.begin(), events.end());
    std::sort(packet.begin(), packet.end(), [](const Event& a, const Event& b) {
      if (a.time_ns != b.time_ns) return a.time_ns < b.time_ns;
      return a.y_px != b.y_px ? a.y_px < b.y_px
                              : (a.x_px != b.x_px ? a.x_px < b.x_px : a.brighter < b.brighter);
    });
    sink(packet);
    context.progress.stageProgress(static_cast<double>(k + 1) / packets);
  }
}

}  // namespace evical
