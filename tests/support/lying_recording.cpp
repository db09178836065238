#include "tests/support/lying_recording.h"

#include "core/recording/recording_writer.h"
#include "core/report/report_options.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/imu_simulator.h"
#include "tests/support/scenario_session.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::test {
namespace {

constexpr std::size_t kLieBytes = 6, kMaxLies = 4;

// A small sensor near a small board, so that a calibration takes a second.
Scenario smallScenario() {
  Scenario scenario;
  scenario.duration_s = 4.0;
  scenario.start_ns = 1'000'000'000'000;
  scenario.board.rows = 5;
  scenario.board.cols = 3;
  scenario.scene.clutter_contrast = 0.0;
  scenario.motion.distance_m = 0.45;
  scenario.motion.image_speed_px_s = 60.0;
  scenario.cameras.resize(1);
  scenario.cameras.front().intrinsics.resolution_px = {160, 120};
  scenario.cameras.front().intrinsics.focal_length_px = {150.0, 150.0};
  scenario.cameras.front().intrinsics.principal_point_px = {79.5, 59.5};
  scenario.cameras.front().imu_from_camera.translation_m = {0.02, -0.03, 0.01};
  scenario.imus.resize(1);
  scenario.imus.front().rate_hz = 400.0;
  return scenario;
}

// The items between the fractions of the second and the third byte.
template <class Item>
std::span<Item> part(std::vector<Item>& items, std::span<const std::uint8_t> lie) {
  const auto [from, to] = std::minmax(lie[1], lie[2]);
  const std::size_t first = items.size() * from / 256, last = items.size() * (to + std::size_t{1}) / 256;
  return std::span<Item>(items).subspan(first, last - first);
}

template <class Item>
void shift(std::span<Item> items, double by_s) {
  for (Item& item : items) item.time_ns += static_cast<std::int64_t>(1e9 * by_s);
}
template <class Item>
void stretch(std::span<Item> items, double times) {
  if (items.empty()) return;
  const std::int64_t first_ns = items.front().time_ns;
  for (Item& item : items)
    item.time_ns = first_ns + static_cast<std::int64_t>(times * static_cast<double>(item.time_ns - first_ns));
}
template <class Item>
void remove(std::vector<Item>& items, std::span<Item> gone) {
  const auto first = items.begin() + (gone.data() - items.data());
  items.erase(first, first + static_cast<std::ptrdiff_t>(gone.size()));
}

template <class Item>
void bringIntoOrder(std::vector<Item>& items) {
  constexpr std::int64_t kEarliest_ns = 0, kLatest_ns = 4'000'000'000'000'000'000;  // limit of a bag
  for (Item& item : items) item.time_ns = std::clamp(item.time_ns, kEarliest_ns, kLatest_ns);
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.time_ns < b.time_ns; });
}

}  // namespace

LyingRecording::LyingRecording(std::filesystem::path folder)
    : folder_(std::move(folder)), scenario_(smallScenario()) {
  simulateEvents(scenario_, 0, [&](EventSpan events) {
    good_.events.insert(good_.events.end(), events.begin(), events.end());
  });
  good_.samples = simulateImu(scenario_, 0);
}

void LyingRecording::tellOne(std::span<const std::uint8_t> lie, Content& content) const {
  constexpr int kKinds = 12, kDecades = 14, kSmallest = -6;
  const double size = std::pow(10.0, lie[3] % kDecades + kSmallest) * (lie[4] % 2 != 0 ? -1.0 : 1.0);
  const int axis = lie[5] % 3;
  const Resolution& sensor = scenario_.cameras.front().intrinsics.resolution_px;
  const std::span<Event> events = part(content.events, lie);
  const std::span<ImuSample> samples = part(content.samples, lie);
  switch (lie[0] % kKinds) {
    case 0:
      return shift(events, size);
    case 1:
      return shift(samples, size);
    case 2:
      return stretch(events, size);
    case 3:
      return stretch(samples, size);
    case 4:
      return remove(content.events, events);
    case 5:
      return remove(content.samples, samples);
    case 6:
      for (Event& event : events) event.brighter = !event.brighter;
      return;
    case 7:
      for (Event& event : events) {
        event.x_px = static_cast<std::uint16_t>(lie[4] * sensor.width_px / 256);
        event.y_px = static_cast<std::uint16_t>(lie[5] * sensor.height_px / 256);
      }
      return;
    case 8:
      for (Event& event : events) event.x_px = static_cast<std::uint16_t>(sensor.width_px - 1 - event.x_px);
      return;
    case 9:
      for (ImuSample& sample : samples) sample.angular_rate_rad_s[axis] *= size;
      return;
    case 10:
      for (ImuSample& sample : samples) sample.specific_force_m_s2[axis] += size;
      return;
    default:
      for (ImuSample& sample : samples)
        sample = {sample.time_ns, samples.front().angular_rate_rad_s, samples.front().specific_force_m_s2};
  }
}

void LyingRecording::write(Content content) const {
  bringIntoOrder(content.events);
  bringIntoOrder(content.samples);
  const Session session = sessionFor(scenario_);
  const auto writer = createBag(
      folder_ / "lies.bag",
      {{session.cameras.front().stream, StreamType::Events, "", session.cameras.front().resolution_px},
       {session.imus.front().stream, StreamType::Imu, "", {}}},
      false);
  // A message per some thousand events, for any times.
  constexpr std::size_t kMessage = 4000, kSamples = 40;
  for (std::size_t i = 0; i < content.events.size(); i += kMessage)
    writer->write(0, EventSpan(content.events).subspan(i, std::min(kMessage, content.events.size() - i)));
  for (std::size_t i = 0; i < content.samples.size(); i += kSamples)
    writer->write(1, std::span<const ImuSample>(content.samples)
                         .subspan(i, std::min(kSamples, content.samples.size() - i)));
  writer->finish();
}

Session LyingRecording::tell(std::span<const std::uint8_t> lies) const {
  Content content = good_;
  for (std::size_t k = 0; k < kMaxLies && (k + 1) * kLieBytes <= lies.size(); ++k)
    tellOne(lies.subspan(k * kLieBytes, kLieBytes), content);
  write(std::move(content));
  Session session = sessionFor(scenario_);
  session.recording = folder_ / "lies.bag";
  session.options.report.edit().split_half_check = false;
  return session;
}

}  // namespace evical::test
