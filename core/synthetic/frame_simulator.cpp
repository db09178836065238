#include "core/synthetic/frame_simulator.h"

#include "core/base/time.h"
#include "core/synthetic/random.h"
#include "core/synthetic/scenario_boards.h"
#include "core/synthetic/scene_light.h"
#include "core/synthetic/sinusoid_motion.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

namespace evical {
namespace {

constexpr int kExposures = 3;     // instants per exposure
constexpr double kWhite = 235.0;  // value of white paper, of 255

class FrameRenderer {
 public:
  FrameRenderer(const Scenario& scenario, std::size_t index)
      : scenario_(scenario),
        index_(index),
        camera_(scenario.cameras[index]),
        motion_(scenario),
        light_(sceneOf(scenario, index), index, camera_.frames->blur_px) {}

  // Renders the pixels of a row of the frame whose middle is exposed at this time on the reference's clock.
  void render(int row, double time_s, Random& noise, std::uint8_t* pixels) const {
    const FrameModel& model = *camera_.frames;
    const Resolution& size = camera_.intrinsics.resolution_px;
    const double row_s = time_s + 1e-6 * model.line_delay_us * (row - 0.5 * (size.height_px - 1));
    std::array<SceneLight::Planes, kExposures> planes;
    for (std::size_t k = 0; k < kExposures; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / kExposures - 0.5;
      planes[k] = light_.at(motion_.boardFromCamera(index_, row_s + share * model.exposure_s));
    }
    for (int x = 0; x < size.width_px; ++x) {
      const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width_px) +
                     static_cast<std::size_t>(x);
      float light = 0.0f;
      for (std::size_t k = 0; k < kExposures; ++k) light += light_.of(i, planes[k]).shown / kExposures;
      const double value = kWhite / scenario_.scene.bright_reflectance * light + model.noise * noise.normal();
      pixels[x] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  }

 private:
  const Scenario& scenario_;
  std::size_t index_;
  const SimulatedCamera& camera_;
  SinusoidMotion motion_;
  SceneLight light_;
};

}  // namespace

void simulateFrames(const Scenario& scenario, std::size_t index,
                    const std::function<void(const Frame&)>& sink, const RunContext& context, int threads) {
  constexpr std::uint64_t kNoiseStream = 0xf0u;
  const FrameRenderer renderer(scenario, index);
  const SimulatedCamera& camera = scenario.cameras[index];
  const Resolution& size = camera.intrinsics.resolution_px;
  const auto width = static_cast<std::size_t>(size.width_px);
  Frame frame;
  frame.size_px = size;
  frame.row_bytes = width;
  frame.exposure_s = camera.frames->exposure_s;
  frame.bytes.resize(width * static_cast<std::size_t>(size.height_px));
  const double interval_s = 1.0 / camera.frames->rate_hz;
  for (std::uint64_t k = 0; (static_cast<double>(k) + 0.5) * interval_s < scenario.duration_s; ++k) {
    context.throwIfStopped();
    const double time_s = (static_cast<double>(k) + 0.5) * interval_s;
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int row = next++; row < size.height_px; row = next++) {
        Random noise(scenario.seed, kNoiseStream + index,
                     k * static_cast<std::uint64_t>(size.height_px) + static_cast<std::uint64_t>(row));
        renderer.render(row, time_s, noise, frame.bytes.data() + static_cast<std::size_t>(row) * width);
      }
    };
    {
      std::vector<std::jthread> others;
      for (int worker = 1; worker < threads; ++worker) others.emplace_back(work);
      work();
    }
    frame.time_ns = scenario.start_ns + nanosecondsFrom(time_s - camera.time_offset_s);
    sink(frame);
  }
}

}  // namespace evical
