// SPDX-License-Identifier: GPL-3.0-or-later
// A short recording with the front end's results for its windows, for tests of the detection screen.
#pragma once

#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "tests/support/simulated_recording.h"
#include "tests/ui/slowdown.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/event_view.h"
#include "ui/detection/timeline.h"
#include "ui/detection/window_analysis.h"

#include <QImage>
#include <QTemporaryDir>
#include <QTest>

#include <cmath>
#include <memory>

namespace evical::ui::test {

// The first seconds of a scenario, and the front end's results for them.
struct Recorded {
  QTemporaryDir folder;  // for files of tests
  Session session;
  DetectionResult detections;

  explicit Recorded(const std::string& name = "davis346", double duration_s = 2.0) {
    session = readSession(evical::test::simulatedRecording(name, duration_s));
    detections = readAndDetect(session, {});
  }
  // A window in the middle, with all of its circles.
  WindowReport goodWindow() const {
    for (const WindowReport& window : detections.cameras.front().windows) {
      if (window.time_s > 0.8 && window.outcome == WindowOutcome::Complete) return window;
    }
    return detections.cameras.front().windows.at(detections.cameras.front().windows.size() / 2);
  }
  std::shared_ptr<const BoardObservations> observations() const {
    return std::make_shared<BoardObservations>(detections.cameras.front());
  }
  // Detections of these windows, without estimates from them.
  std::shared_ptr<CalibrationRun> run() const {
    auto run = std::make_shared<CalibrationRun>();
    run->detections = detections;
    return run;
  }
};

// The screen after the recording has been read and the window at the cursor analysed.
inline void settle(DetectionScreen& screen) {
  QTRY_VERIFY_WITH_TIMEOUT(screen.timeline().end_s() > 1.9, 20000 * kSlowdown);
  QTRY_VERIFY_WITH_TIMEOUT(screen.analysis() && !screen.analysis()->searches.empty() &&
                               std::abs(screen.analysis()->time_s - screen.time_s()) < 1e-9 &&
                               screen.view().frame() &&
                               std::abs(screen.view().frame()->time_s - screen.time_s()) < 1e-9,
                           20000 * kSlowdown);
}

// A screen of usual size at the recording's good window.
inline void showGoodWindow(DetectionScreen& screen, const Recorded& recorded) {
  screen.resize(1000, 650);
  screen.show();
  screen.setSession(recorded.session);
  screen.setTime(recorded.goodWindow().time_s);
  settle(screen);
}

inline int pixelsOf(const QImage& image, const QColor& colour) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += image.pixelColor(x, y) == colour;
  }
  return count;
}

}  // namespace evical::ui::test
