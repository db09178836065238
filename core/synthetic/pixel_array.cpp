#include "core/synthetic/pixel_array.h"

#include "core/synthetic/random.h"

#include "core/base/time.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr int kMaxRoomSteps = 256;  // per interval

}  // namespace

void PixelArray::resetInRoom(const RigidTransform& world_from_camera, Scratch& scratch) {
  constexpr std::uint64_t kReferenceStream = 0xf0u;
  Random random(scenario_.seed, kReferenceStream + camera_);
  const RoomRenderer::Instant instant = room_->at(world_from_camera);
  for (int row = 0; row < renderer_.tileRows(); ++row)
    for (int column = 0; column < renderer_.tileColumns(); ++column) {
      const SceneRenderer::Tile tile = renderer_.tile(column, row);
      scratch.input.resize(static_cast<std::size_t>(tile.pixelCount()));
      room_->look(tile, {&instant, &instant, &instant}, scratch.room_view);
      room_->render(instant, tile, scratch.room_view, scratch.input.data());
      for (int k = 0; k < tile.pixelCount(); ++k)
        settle(scratch.input[static_cast<std::size_t>(k)], static_cast<float>(random.uniform()),
               at(tile.x_px + k % tile.width_px, tile.y_px + k / tile.width_px));
    }
}

void PixelArray::beginInRoom(const std::function<RigidTransform(double)>& world_from_camera_at) {
  const auto instantAt = [&](double part) {
    return room_->at(world_from_camera_at(begin_s_ + part * (end_s_ - begin_s_)));
  };
  const RoomRenderer::Instant first = instantAt(0.0), middle = instantAt(0.5), last = instantAt(1.0);
  constexpr int kSamples = 8;  // per side: the fastest place is near one of them
  float travel_px = 0.0f;
  RoomRenderer::TileView view;
  for (int i = 0; i <= kSamples; ++i)
    for (int j = 0; j <= kSamples; ++j) {
      const int column = (renderer_.tileColumns() - 1) * i / kSamples, row = (tileRows() - 1) * j / kSamples;
      room_->look(renderer_.tile(column, row), {&first, &middle, &last}, view);
      travel_px = std::max(travel_px, view.travel_px);
    }
  int steps = minSteps(end_s_ - begin_s_);
  while (steps < kMaxRoomSteps && static_cast<float>(steps) * step_travel_px_ < travel_px) steps *= 2;
  room_instants_.clear();
  for (int k = 0; k <= steps; ++k) room_instants_.push_back(instantAt(static_cast<double>(k) / steps));
}

void PixelArray::runRoomRow(int tile_row, Scratch& scratch, std::vector<Event>& events) {
  const int all = static_cast<int>(room_instants_.size()) - 1;
  const RoomRenderer::Instants ends = {&room_instants_.front(), &room_instants_[room_instants_.size() / 2],
                                       &room_instants_.back()};
  const double length_s = end_s_ - begin_s_;
  for (int column = 0; column < renderer_.tileColumns(); ++column) {
    const SceneRenderer::Tile tile = renderer_.tile(column, tile_row);
    room_->look(tile, ends, scratch.room_view);
    int steps = minSteps(length_s);
    while (steps < all && static_cast<float>(steps) * step_travel_px_ < scratch.room_view.travel_px)
      steps *= 2;
    scratch.input.resize(static_cast<std::size_t>(tile.pixelCount()));
    for (int k = 1; k <= steps; ++k) {
      const Step step = stepBetween(begin_s_ + length_s * (k - 1) / steps, begin_s_ + length_s * k / steps);
      room_->render(room_instants_[static_cast<std::size_t>(k * (all / steps))], tile, scratch.room_view,
                    scratch.input.data());
      const float* input = scratch.input.data();
      for (int y = tile.y_px; y < tile.y_px + tile.height_px; ++y) {
        Pixel* pixel = &at(tile.x_px, y);
        for (int x = tile.x_px; x < tile.x_px + tile.width_px; ++x)
          advance(step, *input++ + step.lamp, x, y, *pixel++, events);
      }
    }
  }
}

FlashingBoard::FlashingBoard(const Scenario& scenario, std::size_t camera,
                             const RigidTransform& world_from_camera)
    : blink_hz_(scenario.scene.blink_hz),
      light_(scenario, camera, scenario.cameras[camera].pixel.blur_px),
      planes_(light_.at(world_from_camera)),
      last_(static_cast<std::size_t>(scenario.cameras[camera].intrinsics.resolution_px.pixelCount())) {
  for (std::size_t pixel = 0; pixel < last_.size(); ++pixel) last_[pixel] = light_.of(pixel, planes_);
}

FlashingBoard::Stretch FlashingBoard::take(std::size_t pixel) {
  const SceneLight::Light end = light_.of(pixel, planes_);
  return {std::exchange(last_[pixel], end), end};
}

bool FlashingBoard::isShown(double time_s) const {
  return std::fmod(time_s * blink_hz_, 1.0) < 0.5;
}

namespace {

constexpr int kMaxSteps = 256;  // per interval
constexpr char kMoving = -1;
constexpr double kMinFactor = 0.3;      // of a threshold, relative to its mean
constexpr double kSettlingTimes = 3.0;  // time constants after which the low-pass filter follows a ramp

}  // namespace

std::int64_t pixelStamp_ns(const Scenario& scenario, std::size_t camera, double time_s) {
  const SimulatedCamera& c = scenario.cameras[camera];
  return scenario.start_ns + 1000 * std::llround((time_s + c.pixel.latency_s - c.time_offset_s) * 1e6);
}

PixelArray::PixelArray(const Scenario& scenario, std::size_t camera)
    : scenario_(scenario),
      camera_(camera),
      model_(scenario.cameras[camera].pixel),
      renderer_(scenario, camera),
      width_px_(scenario.cameras[camera].intrinsics.resolution_px.width_px),
      rests_(scenario.scene.lamp_flicker <= 0.0 && model_.leak_rate_hz <= 0.0),
      lamp_is_weak_(4.0 * scenario.scene.lamp_flicker < std::min(model_.threshold_on, model_.threshold_off)),
      pixels_(static_cast<std::size_t>(scenario.cameras[camera].intrinsics.resolution_px.pixelCount())),
      settled_(static_cast<std::size_t>(renderer_.tileColumns() * renderer_.tileRows()), kMoving) {
  // Log intensity is assumed linear within a step, which must be short compared with the blur.
  constexpr float kLongest_px = 0.3f, kShareOfBlur = 0.5f;
  step_travel_px_ = std::min(kLongest_px, kShareOfBlur * static_cast<float>(model_.blur_px));
  min_threshold_ =
      static_cast<float>(std::max(1.0 - Random::kLargestNormal * model_.threshold_noise, kMinFactor));
  constexpr std::uint64_t kThresholdStream = 0xe0u;
  Random random(scenario.seed, kThresholdStream + camera);
  const auto factor = [&] { return std::max(1.0 + model_.threshold_mismatch * random.normal(), kMinFactor); };
  findOwnLight();
  if (scenario.room.exists()) room_ = std::make_unique<RoomRenderer>(scenario, camera);
  for (Pixel& pixel : pixels_) {
    pixel.threshold_on = static_cast<float>(model_.threshold_on * factor());
    pixel.threshold_off = static_cast<float>(model_.threshold_off * factor());
  }
}

// Log of the light relative to that halfway between ink and paper; corners have less because of vignetting.
void PixelArray::findOwnLight() {
  if (model_.low_pass_light_power == 0.0 && model_.low_pass_polarity == 0.0) return;
  const Resolution& size = scenario_.cameras[camera_].intrinsics.resolution_px;
  const Eigen::Vector2d half(0.5 * size.width_px, 0.5 * size.height_px);
  const SceneModel& scene = scenario_.scene;
  const double middle = 0.5 * std::log(scene.bright_reflectance * scene.dark_reflectance);
  for (int y = 0; y < size.height_px; ++y) {
    for (int x = 0; x < size.width_px; ++x) {
      const double corner = (Eigen::Vector2d(x, y) - half).squaredNorm() / half.squaredNorm();
      own_light_.push_back(static_cast<float>(std::log(1.0 - model_.vignetting * corner) - middle));
    }
  }
}

void PixelArray::reset(const RigidTransform& world_from_camera) {
  constexpr std::uint64_t kReferenceStream = 0xf0u;
  Random random(scenario_.seed, kReferenceStream + camera_);
  if (scenario_.scene.blink_hz > 0.0)
    flashing_ = std::make_unique<FlashingBoard>(scenario_, camera_, world_from_camera);
  Scratch scratch;
  if (room_) return resetInRoom(world_from_camera, scratch);
  const SceneRenderer::Instant instant = renderer_.at(world_from_camera, 0.0);
  for (int row = 0; row < renderer_.tileRows(); ++row) {
    for (int column = 0; column < renderer_.tileColumns(); ++column) {
      const SceneRenderer::Tile tile = renderer_.tile(column, row);
      scratch.input.resize(static_cast<std::size_t>(tile.pixelCount()));
      renderer_.look(tile, {&instant, &instant, &instant}, scratch.view);
      renderer_.render(instant, tile, scratch.view, scratch.input.data());
      for (int k = 0; k < tile.pixelCount(); ++k) {
        Pixel& pixel = at(tile.x_px + k % tile.width_px, tile.y_px + k / tile.width_px);
        pixel.level = pixel.input = scratch.input[static_cast<std::size_t>(k)];
        if (flashing_)
          pixel.level = pixel.input =
              std::log(flashing_->last(static_cast<std::size_t>(&pixel - pixels_.data())).shown);
        settle(pixel.input, static_cast<float>(random.uniform()), pixel);
      }
    }
  }
  std::fill(settled_.begin(), settled_.end(), kMoving);
}

// Initialises a pixel to its light, with its reference at this fraction between its thresholds.
void PixelArray::settle(float input, float part, Pixel& pixel) const {
  pixel.level = pixel.input = input;
  pixel.reference = pixel.level + part * (pixel.threshold_on + pixel.threshold_off) - pixel.threshold_on;
}

PixelArray::Response PixelArray::responseWith(double constant_s, double length_s) const {
  if (constant_s <= 0.0) return {0.0f, 0.0f, 0.0};
  return {static_cast<float>(std::exp(-length_s / constant_s)), static_cast<float>(constant_s / length_s),
          constant_s};
}

PixelArray::Step PixelArray::stepBetween(double begin_s, double end_s) const {
  const SceneModel& scene = scenario_.scene;
  const double phase = 2.0 * std::numbers::pi * scene.lamp_flicker_hz * end_s;
  return {begin_s, end_s, responseWith(model_.low_pass_s, end_s - begin_s),
          static_cast<float>(std::log1p(scene.lamp_flicker * std::sin(phase))),
          static_cast<float>(model_.leak_rate_hz * (end_s - begin_s))};
}

// More light makes a pixel faster; darkening is slower than brightening.
PixelArray::Response PixelArray::responseOf(const Step& step, float input, int x, int y,
                                            const Pixel& pixel) const {
  if (own_light_.empty() || model_.low_pass_s <= 0.0) return step.response;
  const float light = 0.5f * (input + pixel.input) + own_light_[static_cast<std::size_t>(y * width_px_ + x)];
  const auto polarity = static_cast<float>(model_.low_pass_polarity), usual = step.response.lag;
  const float lag = usual * (input > pixel.level ? 1.0f - polarity : 1.0f + polarity) *
                    std::exp(-static_cast<float>(model_.low_pass_light_power) * light);
  return {std::exp(-1.0f / lag), lag, lag * (step.end_s - step.begin_s)};
}

// The threshold is drawn again after each event.
float PixelArray::thresholdNow(const Pixel& pixel, bool on, int x, int y) const {
  const float mean = on ? pixel.threshold_on : pixel.threshold_off;
  if (model_.threshold_noise <= 0.0) return mean;
  constexpr std::uint64_t kStream = 0x150u;
  const auto place = static_cast<std::uint64_t>(y * width_px_ + x);
  Random random(scenario_.seed, kStream + 2 * camera_ + (on ? 1 : 0), (place << 32) + pixel.event_count);
  return mean * static_cast<float>(std::max(1.0 + model_.threshold_noise * random.normal(), kMinFactor));
}

// Number of steps for which the lamp's light is nearly linear within one.
int PixelArray::minSteps(double length_s) const {
  constexpr double kStepsPerPeriod = 8.0;
  int steps = 2;
  if (scenario_.scene.lamp_flicker > 0.0)
    while (steps < kStepsPerPeriod * scenario_.scene.lamp_flicker_hz * length_s) steps *= 2;
  return steps;
}

void PixelArray::begin(double begin_s, double end_s,
                       const std::function<RigidTransform(double)>& world_from_camera_at) {
  begin_s_ = begin_s;
  end_s_ = end_s;
  if (flashing_) return flashing_->begin(world_from_camera_at(end_s));
  if (room_) return beginInRoom(world_from_camera_at);
  const auto instantAt = [&](double time_s) { return renderer_.at(world_from_camera_at(time_s), time_s); };
  const SceneRenderer::Instant first = instantAt(begin_s), middle = instantAt(0.5 * (begin_s + end_s)),
                               last = instantAt(end_s);
  constexpr int kSamples = 8;  // per side: the fastest place is near one of them
  float travel_px = 0.0f;
  SceneRenderer::TileView view;
  for (int i = 0; i <= kSamples; ++i) {
    for (int j = 0; j <= kSamples; ++j) {
      const int column = (renderer_.tileColumns() - 1) * i / kSamples, row = (tileRows() - 1) * j / kSamples;
      const SceneRenderer::Tile tile = renderer_.tile(column, row);
      renderer_.look(tile, {&first, &middle, &last}, view);
      travel_px =
          std::max({travel_px, view.travel_px, renderer_.visitorsTravel_px(tile, {&first, &middle, &last})});
    }
  }
  int steps = minSteps(end_s - begin_s);
  while (steps < kMaxSteps && static_cast<float>(steps) * step_travel_px_ < travel_px) steps *= 2;
  instants_.clear();
  for (int k = 0; k <= steps; ++k) instants_.push_back(instantAt(begin_s + (end_s - begin_s) * k / steps));
}

// Simulates a row in steps that are as long as a screen takes to switch.
void PixelArray::runFlashingRow(int tile_row, std::vector<Event>& events) {
  constexpr double kStep_s = 7e-4;
  const double length_s = end_s_ - begin_s_;
  const int count = std::max(2, static_cast<int>(std::ceil(length_s / kStep_s)));
  std::vector<Step> steps;
  for (int k = 1; k <= count; ++k)
    steps.push_back(stepBetween(begin_s_ + length_s * (k - 1) / count, begin_s_ + length_s * k / count));
  const int first = tile_row * SceneRenderer::kTile_px;
  const int height_px = static_cast<int>(pixels_.size()) / width_px_;
  for (int y = first; y < std::min(first + SceneRenderer::kTile_px, height_px); ++y)
    for (int x = 0; x < width_px_; ++x) {
      const FlashingBoard::Stretch stretch = flashing_->take(static_cast<std::size_t>(y * width_px_ + x));
      for (int k = 0; k < count; ++k) {
        const Step& step = steps[static_cast<std::size_t>(k)];
        const float part = static_cast<float>(k + 1) / static_cast<float>(count);
        const float light = stretch.reflectance(part, flashing_->isShown(step.end_s));
        advance(step, std::log(light) + step.lamp, x, y, at(x, y), events);
      }
    }
}

void PixelArray::runTileRow(int tile_row, Scratch& scratch, std::vector<Event>& events) {
  if (flashing_) return runFlashingRow(tile_row, events);
  if (room_) return runRoomRow(tile_row, scratch, events);
  const int all = static_cast<int>(instants_.size()) - 1;
  const SceneRenderer::Instants ends = {&instants_.front(), &instants_[instants_.size() / 2],
                                        &instants_.back()};
  for (int column = 0; column < renderer_.tileColumns(); ++column) {
    const SceneRenderer::Tile tile = renderer_.tile(column, tile_row);
    char& settled = settled_[static_cast<std::size_t>(tile_row * renderer_.tileColumns() + column)];
    renderer_.look(tile, ends, scratch.view);
    const bool constant = scratch.view.constant;
    if (constant && settled == static_cast<char>(scratch.view.content)) continue;
    int steps = minSteps(end_s_ - begin_s_);
    while (steps < all && static_cast<float>(steps) * step_travel_px_ < scratch.view.travel_px) steps *= 2;
    if (constant && lamp_is_weak_) steps = 1;
    scratch.input.resize(static_cast<std::size_t>(tile.pixelCount()));
    for (int k = 1; k <= steps; ++k) {
      const double length_s = end_s_ - begin_s_;
      const Step step = stepBetween(begin_s_ + length_s * (k - 1) / steps, begin_s_ + length_s * k / steps);
      renderer_.render(instants_[static_cast<std::size_t>(k * (all / steps))], tile, scratch.view,
                       scratch.input.data());
      const float* input = scratch.input.data();
      for (int y = tile.y_px; y < tile.y_px + tile.height_px; ++y) {
        Pixel* pixel = &at(tile.x_px, y);
        for (int x = tile.x_px; x < tile.x_px + tile.width_px; ++x)
          advance(step, *input++ + step.lamp, x, y, *pixel++, events);
      }
    }
    constexpr float kSettled = 1e-4f;
    settled = constant && rests_ ? static_cast<char>(scratch.view.content) : kMoving;
    for (int k = 0; settled != kMoving && k < tile.pixelCount(); ++k) {
      const Pixel& pixel = at(tile.x_px + k % tile.width_px, tile.y_px + k / tile.width_px);
      if (std::abs(pixel.level - pixel.input) > kSettled) settled = kMoving;
    }
  }
}

// The low-pass filter's exact answer to an input that changes linearly over
// the step; crossings are interpolated.
void PixelArray::advance(const Step& step, float input, int x, int y, Pixel& pixel,
                         std::vector<Event>& events) const {
  const Response response = responseOf(step, input, x, y, pixel);
  const float behind = (input - pixel.input) * response.lag;
  const float before = pixel.level, transient = before - pixel.input + behind, earlier_input = pixel.input;
  const float after = input - behind + transient * response.decay;
  pixel.input = input;
  pixel.level = after;
  pixel.reference -= step.leak * pixel.threshold_on;
  // Most steps do not reach the least threshold that can be drawn, and need no draw.
  const bool in_reset = model_.reset_s > 0.0 && pixel.last_event_s >= 0.0;
  if (!in_reset && after < pixel.reference + min_threshold_ * pixel.threshold_on &&
      after > pixel.reference - min_threshold_ * pixel.threshold_off)
    return;
  if (!in_reset && after < pixel.reference + thresholdNow(pixel, true, x, y) &&
      after > pixel.reference - thresholdNow(pixel, false, x, y))
    return;
  // Steps are long compared with the filter's time constant: its response is curved within a step, and linear
  // interpolation would stamp events too late where slopes increase and too early where they decrease.
  const double bend_s = kSettlingTimes * response.constant_s, length_s = step.end_s - step.begin_s;
  if (bend_s <= 0.0 || 2.0 * bend_s > length_s) {
    emitCrossings(step, before, after, x, y, pixel, events);
    return;
  }
  const double part = bend_s / length_s;
  const double middle =
      earlier_input + part * (input - earlier_input) - behind + transient * std::exp(-kSettlingTimes);
  Step first = step, second = step;
  first.end_s = second.begin_s = step.begin_s + bend_s;
  emitCrossings(first, before, middle, x, y, pixel, events);
  emitCrossings(second, middle, after, x, y, pixel, events);
}

void PixelArray::emitCrossings(const Step& step, double before, double after, int x, int y, Pixel& pixel,
                               std::vector<Event>& events) const {
  const double slope = (after - before) / (step.end_s - step.begin_s);
  double level = before, time_s = step.begin_s;
  for (;;) {
    const double reset_end_s = pixel.last_event_s + model_.reset_s;
    if (model_.reset_s > 0.0 && pixel.last_event_s >= 0.0) {
      if (reset_end_s > step.end_s) return;
      time_s = std::max(time_s, reset_end_s);
      level = before + slope * (time_s - step.begin_s);
      pixel.reference = static_cast<float>(level);
      pixel.last_event_s = -1.0;
    }
    const bool on = after > pixel.reference;
    const float threshold = thresholdNow(pixel, on, x, y);
    const double crossing = on ? pixel.reference + threshold : pixel.reference - threshold;
    if (on ? after < crossing : after > crossing) return;
    double crossing_s = on == (level >= crossing) ? time_s : step.begin_s + (crossing - before) / slope;
    crossing_s = std::clamp(crossing_s, time_s, step.end_s);
    const double free_s = pixel.last_event_s + model_.refractory_s;
    if (crossing_s < free_s) {
      // In reset until the refractory period ends: the level then is the new reference.
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
    ++pixel.event_count;
    level = crossing;
    time_s = crossing_s;
    events.push_back({pixelStamp_ns(scenario_, camera_, crossing_s), static_cast<std::uint16_t>(x),
                      static_cast<std::uint16_t>(y), on});
  }
}

}  // namespace evical
