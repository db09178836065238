// The appearance of a simulated room depends on the place that is seen, not on the camera.
#include "core/synthetic/room_renderer.h"

#include "core/geometry/camera_model.h"
#include "core/synthetic/event_simulator.h"
#include "tests/core/synthetic/scenarios.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <cmath>
#include <optional>
#include <vector>

using namespace evical;

namespace {

// A small camera: 48 x 36 pixels.
Scenario roomScenario() {
  Scenario scenario;
  scenario.seed = 5;
  scenario.duration_s = 0.3;
  scenario.cameras.resize(1);
  scenario.imus.resize(1);
  CameraIntrinsics& lens = scenario.cameras.front().intrinsics;
  lens.resolution_px = {48, 36};
  lens.focal_length_px = {40.0, 40.0};
  lens.principal_point_px = {23.5, 17.5};
  lens.distortion = {};
  scenario.board = Board{};
  scenario.room.size_m = {6.0, 4.0, 6.0};
  scenario.room.boxes = 0;
  scenario.motion.distance_m = 0.1;
  scenario.motion.distance_amplitude_m = 0.0;
  scenario.motion.target_amplitude_m.setZero();
  scenario.motion.image_speed_px_s = 0.0;
  return scenario;
}

std::vector<float> pictureFrom(const RoomRenderer& renderer, const SceneRenderer& tiles,
                               const RigidTransform& world_from_camera) {
  const RoomRenderer::Instant instant = renderer.at(world_from_camera);
  std::vector<float> picture(48 * 36), part;
  RoomRenderer::TileView view;
  for (int row = 0; row < tiles.tileRows(); ++row)
    for (int column = 0; column < tiles.tileColumns(); ++column) {
      const SceneRenderer::Tile tile = tiles.tile(column, row);
      part.resize(static_cast<std::size_t>(tile.pixelCount()));
      renderer.look(tile, {&instant, &instant, &instant}, view);
      renderer.render(instant, tile, view, part.data());
      for (int k = 0; k < tile.pixelCount(); ++k)
        picture[static_cast<std::size_t>((tile.y_px + k / tile.width_px) * 48 + tile.x_px +
                                         k % tile.width_px)] = part[static_cast<std::size_t>(k)];
    }
  return picture;
}

}  // namespace

class TestRoomRenderer : public QObject {
  Q_OBJECT

 private slots:
  // Rotated by two pixels about its own y axis, the camera sees nearly the same image, shifted by two pixels.
  void turningCamera_movesThePicture() {
    const Scenario scenario = roomScenario();
    const RoomRenderer renderer(scenario, 0);
    const SceneRenderer tiles(scenario, 0);
    RigidTransform camera;
    const std::vector<float> before = pictureFrom(renderer, tiles, camera);
    camera.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(std::atan(2.0 / 40.0), Eigen::Vector3d::UnitY()));
    const std::vector<float> after = pictureFrom(renderer, tiles, camera);
    double moved = 0.0, still = 0.0;
    for (std::size_t y = 12; y < 24; ++y)
      for (std::size_t x = 16; x < 32; ++x) {
        moved += std::abs(after[y * 48 + x] - before[y * 48 + x + 2]);
        still += std::abs(after[y * 48 + x] - before[y * 48 + x]);
      }
    QVERIFY2(moved < 0.4 * still, qPrintable(QString("%1 %2").arg(moved).arg(still)));
  }

  // Boxes are in front of walls and not in the middle.
  void boxes_stayApart() {
    Scenario scenario = roomScenario();
    scenario.room.boxes = 12;
    const RoomScene scene = furnishedRoom(scenario);
    QVERIFY(scene.boxes.size() > 5);
    for (const RoomBox& box : scene.boxes)
      for (const RoomSide& side : box.sides) QVERIFY((side.middle_m - box.middle_m).dot(side.normal()) > 0.0);
    for (std::size_t a = 0; a < scene.boxes.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        QVERIFY((scene.boxes[a].middle_m - scene.boxes[b].middle_m).norm() >
                scene.boxes[a].radius_m + scene.boxes[b].radius_m);
    for (const RoomSide& wall : scene.walls)
      QVERIFY(wall.normal().dot(wall.middle_m - scene.walls[0].middle_m -
                                (scene.walls[1].middle_m - scene.walls[0].middle_m) / 2.0) < 0.0);
  }

  // A room without texture causes no events except noise, for any rotation of the camera.
  void bareRoom_isDark() {
    Scenario scenario = roomScenario();
    scenario.scene.clutter_contrast = 0.0;
    scenario.room.tone = 0.0;
    scenario.cameras.front().pixel.background_rate_hz = 0.0;
    scenario.cameras.front().pixel.hot_pixels = 0;
    std::size_t count = 0;
    simulateEvents(
        scenario, 0, [&](EventSpan events) { count += events.size(); }, {}, 1);
    QCOMPARE(count, std::size_t{0});
    scenario.scene.clutter_contrast = 0.5;
    simulateEvents(
        scenario, 0, [&](EventSpan events) { count += events.size(); }, {}, 1);
    QVERIFY2(count > 1000, qPrintable(QString::number(count)));
  }
};

EVICAL_TEST(TestRoomRenderer)
#include "tst_room_renderer.moc"
