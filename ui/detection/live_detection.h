// SPDX-License-Identifier: GPL-3.0-or-later
// Shows the front end at work: turns the windows it looks at into pictures' material, forty times a second
// at most, from whatever thread it runs in.
#pragma once

#include "core/data/calibration_observer.h"
#include "core/frontend/front_end_options.h"
#include "core/pipeline/pass/recording_pass.h"
#include "ui/jobs/mailbox.h"

#include <QObject>

#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {

struct WindowAnalysis;

// A window as the front end just left it.
struct LiveWindow {
  std::size_t camera = 0;
  std::optional<double> time_s;  // unknown until something was tracked
  std::int64_t middle_ns = 0;
  std::vector<Event> bursts;  // one event an edge burst
  std::shared_ptr<const WindowAnalysis> analysis;
  std::shared_ptr<const std::vector<WindowReport>> windows;  // all so far, in any order
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
  void windowReady();  // in this object's thread: take it

 private:
  class CameraObserver;
  class RunObserver;
  std::shared_ptr<Mailbox<LiveWindow>> box_;  // shared with observers in other threads
};

}  // namespace evical::ui
