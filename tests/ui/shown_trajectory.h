// SPDX-License-Identifier: GPL-3.0-or-later
// A run with a trajectory, its screen, and queries on the displayed picture.
#pragma once

#include "core/pipeline/rig/calibration_pipeline.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/ui/opengl.h"
#include "tests/ui/slowdown.h"
#include "ui/scene/trajectory_screen.h"

#include <QApplication>
#include <QPalette>
#include <QTest>

#include <cmath>
#include <memory>

namespace evical::ui::test {

inline constexpr int kWorkPatience_ms = 20000 * kSlowdown;

struct Example {
  evical::test::SimulatedRig rig;
  Session session;
  std::shared_ptr<const CalibrationRun> run;
};

inline Session sessionOf(const CalibrationInput& input) {
  Session session;
  session.board = input.board;
  for (const CameraData& camera : input.cameras) {
    session.cameras.push_back({camera.name, "", camera.lens.given->resolution_px, camera.lens.given});
  }
  for (const ImuData& imu : input.imus) {
    SessionImu& known = session.imus.emplace_back();
    known.name = imu.name;
    known.noise = imu.noise;
  }
  session.reference = input.imus.front().name;
  return session;
}

inline Example makeExample(double duration_s) {
  evical::test::RigOptions options;
  options.duration_s = duration_s;
  options.imu_rate_hz = 200.0;
  Example example;
  example.rig = evical::test::simulateRig(options);
  example.session = sessionOf(example.rig.input);
  DetectionResult detections;
  detections.start_ns = example.rig.input.start_ns;
  for (const CameraData& camera : example.rig.input.cameras) {
    detections.cameras.push_back(camera.observations);
    for (const BoardView& view : camera.observations.views) {
      detections.cameras.back().windows.push_back(
          {view.time_s, 0.01, WindowOutcome::Complete, 0, 0, 0, false});
    }
    detections.lenses.push_back(camera.lens);
    detections.resolutions_px.push_back(camera.lens.given->resolution_px);
  }
  detections.imus = example.rig.input.imus;
  example.run =
      std::make_shared<const CalibrationRun>(calibrate(example.session, std::move(detections), RunContext{}));
  return example;
}

inline std::shared_ptr<const CalibrationState> truthOf(const evical::test::SimulatedRig& rig) {
  return std::make_shared<const CalibrationState>(rig.truth);
}

inline void setPalette(bool dark) {
  QApplication::setPalette(dark ? QPalette(QColor(0x3a, 0x3f, 0x47), QColor(0x1f, 0x22, 0x27))
                                : QPalette(QColor(0xe8, 0xea, 0xed), QColor(0xf5, 0xf6, 0xf8)));
}

inline QImage picture(View3D* view) {
  return view->grab().toImage().convertToFormat(QImage::Format_RGB32);
}

inline double distance(const QColor& a, const QColor& b) {
  return std::hypot(a.red() - b.red(), a.green() - b.green(), a.blue() - b.blue());
}

// True if a colour appears within a few pixels.
inline bool hasNear(const QImage& image, const QPointF& at, const QColor& colour, int reach_px = 2) {
  for (int y = -reach_px; y <= reach_px; ++y) {
    for (int x = -reach_px; x <= reach_px; ++x) {
      const QPoint p = at.toPoint() + QPoint(x, y);
      if (image.rect().contains(p) && distance(image.pixelColor(p), colour) < 12.0) return true;
    }
  }
  return false;
}

// With the run displayed and all background work finished.
inline std::unique_ptr<TrajectoryScreen> makeScreen(const Example& example, const QSize& size = {1000, 650}) {
  auto screen = std::make_unique<TrajectoryScreen>();
  screen->resize(size);
  screen->setRun(example.run, example.session);
  screen->setTime(2.0);
  if (!QTest::qWaitFor([&] { return !screen->busy(); }, kWorkPatience_ms)) return nullptr;
  screen->grab();
  return screen;
}

}  // namespace evical::ui::test
