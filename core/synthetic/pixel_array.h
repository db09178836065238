// The pixels of an event camera: thresholds, photoreceptor and refractory time, driven by the rendered scene.
#pragma once

#include "core/synthetic/room_renderer.h"
#include "core/synthetic/scene_light.h"
#include "core/synthetic/scene_renderer.h"

#include "core/data/event.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace evical {

// The light of a board on a flashing screen at event pixels, in consecutive intervals of time.
class FlashingBoard {
 public:
  // Initialised to the light at the beginning.
  FlashingBoard(const Scenario& scenario, std::size_t camera, const RigidTransform& world_from_camera);

  // Begins the next interval, of a few milliseconds; afterwards each of its pixels once, from any thread.
  void begin(const RigidTransform& world_from_camera_at_end) {
    planes_ = light_.at(world_from_camera_at_end);
  }

  // Reflectances at an interval's begin and end, assumed linear in between.
  struct Stretch {
    SceneLight::Light begin, end;
    // Light at this fraction of the interval.
    float reflectance(float part, bool shown) const {
      return shown ? begin.shown + part * (end.shown - begin.shown)
                   : begin.hidden + part * (end.hidden - begin.hidden);
    }
  };
  Stretch take(std::size_t pixel);

  // True if the pattern is on the screen; otherwise it is white.
  bool isShown(double time_s) const;
  // Light at the last interval's end.
  const SceneLight::Light& last(std::size_t pixel) const { return last_[pixel]; }

 private:
  double blink_hz_;
  SceneLight light_;
  SceneLight::Planes planes_;
  std::vector<SceneLight::Light> last_;  // at the end of the previous interval
};

// Stamp of an event that a pixel's comparator detects at `time_s` on the reference's clock: delayed by the
// latency, on the camera's clock, an integer microsecond. Jitter is added later.
std::int64_t pixelStamp_ns(const Scenario& scenario, std::size_t camera, double time_s);

class PixelArray {
 public:
  PixelArray(const Scenario& scenario, std::size_t camera);

  int tileRows() const { return renderer_.tileRows(); }

  // Settles all pixels on their present light, with random references within the thresholds, as if
  // they had been running before. This is the recording's start.
  void reset(const RigidTransform& world_from_camera);

  // Begins an interval of a few milliseconds; afterwards each of its rows of tiles once, in any
  // order and from several threads.
  void begin(double begin_s, double end_s, const std::function<RigidTransform(double)>& world_from_camera_at);

  struct Scratch {
    SceneRenderer::TileView view;
    std::vector<float> input;
    RoomRenderer::TileView room_view = {};
  };
  void runTileRow(int tile_row, Scratch& scratch, std::vector<Event>& events);

 private:
  struct Pixel {
    float level = 0.0f;      // low-passed log intensity
    float input = 0.0f;      // log intensity at the end of the last step
    float reference = 0.0f;  // level at the last event
    float threshold_on = 0.0f, threshold_off = 0.0f;
    std::uint32_t event_count = 0;
    double last_event_s = -1.0;
  };
  // Response of the low-pass filter over a step.
  struct Response {
    float decay, lag;  // exp(-dt / tau), tau / dt
    double constant_s;
  };
  struct Step {
    double begin_s, end_s;
    Response response;  // of a pixel at the light halfway
    float lamp, leak;   // log of the lamp's light at the step's end, leaked part of a threshold
  };

  void advance(const Step& step, float input, int x, int y, Pixel& pixel, std::vector<Event>& events) const;
  void runFlashingRow(int tile_row, std::vector<Event>& events);
  void beginInRoom(const std::function<RigidTransform(double)>& world_from_camera_at);
  void runRoomRow(int tile_row, Scratch& scratch, std::vector<Event>& events);
  void resetInRoom(const RigidTransform& world_from_camera, Scratch& scratch);
  void settle(float input, float part, Pixel& pixel) const;
  void emitCrossings(const Step& step, double before, double after, int x, int y, Pixel& pixel,
                     std::vector<Event>& events) const;
  void findOwnLight();
  int minSteps(double length_s) const;
  Step stepBetween(double begin_s, double end_s) const;
  Response responseWith(double constant_s, double length_s) const;
  Response responseOf(const Step& step, float input, int x, int y, const Pixel& pixel) const;
  float thresholdNow(const Pixel& pixel, bool on, int x, int y) const;
  Pixel& at(int x, int y) { return pixels_[static_cast<std::size_t>(y * width_px_ + x)]; }

  const Scenario& scenario_;
  std::size_t camera_;
  const EventPixelModel& model_;
  SceneRenderer renderer_;
  std::unique_ptr<FlashingBoard> flashing_;  // replaces the renderer if the board blinks
  std::unique_ptr<RoomRenderer> room_;       // replaces the renderer if there is a room
  int width_px_;
  float step_travel_px_;
  float min_threshold_;  // relative to the mean, that thresholdNow can return
  // True if pixels may be skipped when nothing moves; true if the lamp alone causes events.
  bool rests_, lamp_is_weak_;
  std::vector<float> own_light_;  // log, added to a pixel's light; empty if all pixels have the same response
  std::vector<Pixel> pixels_;
  std::vector<char> settled_;  // per tile: the content on which all pixels have settled

  double begin_s_ = 0.0, end_s_ = 0.0;
  std::vector<SceneRenderer::Instant> instants_;  // a power of two plus one, evenly spaced from begin to end
  std::vector<RoomRenderer::Instant> room_instants_;  // likewise
};

}  // namespace evical
