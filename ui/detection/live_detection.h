// SPDX-License-Identifier: GPL-3.0-or-later
// Shows the running front end: sends its windows for display, at most forty times a second, from any thread.
#pragma once

#include "core/data/calibration_observer.h"
#include "core/frontend/detection_options.h"
#include "core/pipeline/detection/recording_pass.h"
#include "ui/jobs/live_view.h"

#include <QObject>

#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {

struct WindowAnalysis;

// A window that the front end has just processed.
struct LiveWindow {
  std::size_t camera = 0;
  std::optional<double> time_s;  // unknown before the first tracked window
  std::int64_t middle_ns = 0;
  std::vector<Event> bursts;  // one event per edge burst
  std::shared_ptr<const WindowAnalysis> analysis;
  std::shared_ptr<const std::vector<WindowReport>> windows;  // all until now, in any order
};

class LiveDetection : public QObject {
  Q_OBJECT

 public:
  explicit LiveDetection(QObject* parent = nullptr);
  ~LiveDetection() override;

  // For the context of one run; may outlive this object.
  std::shared_ptr<CalibrationObserver> observer(const FrontEndOptions& options);

  std::shared_ptr<const LiveWindow> take();

 signals:
  void windowReady();  // emitted in this object's thread; then fetch the window

 private:
  class CameraObserver;
  class RunObserver;
  std::shared_ptr<Mailbox<LiveWindow>> box_;  // shared with observers in other threads
};

}  // namespace evical::ui
