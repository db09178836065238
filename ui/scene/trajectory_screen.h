// SPDX-License-Identifier: GPL-3.0-or-later
// 3D view of the calibrated motion in front of the board. Independent of documents: data are set, also during
// a calibration; clicks on the trajectory and playback emit times. Times are seconds since the recording's
// start on the first camera's clock.
#pragma once

#include "core/data/calibration_state.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "ui/jobs/live_view.h"
#include "ui/scene/trajectory_scene.h"
#include "ui/scene/trajectory_track.h"

#include <QWidget>

#include <functional>
#include <memory>

namespace evical::ui {

class View3D;

class TrajectoryScreen : public QWidget {
  Q_OBJECT

 public:
  explicit TrajectoryScreen(QWidget* parent = nullptr);
  ~TrajectoryScreen() override;

  // Loads the graphics driver in the background, so that the first display does not stall.
  void startInBackground();

  // Removes all data.
  void clear();
  void setBoards(const Session& session);
  void setIntrinsics(const std::vector<std::optional<CameraIntrinsics>>& cameras);

  // A finished calibration: trajectory, residuals, and poses from its single views. Null: none.
  void setRun(std::shared_ptr<const CalibrationRun> run, const Session& session);

  // During a calibration: the current estimate, and before there is one the current board views, from which
  // poses are computed (only for views that are new since the last call).
  void setState(std::shared_ptr<const CalibrationState> state);
  void setDetections(SharedViews views, const CameraIntrinsics& intrinsics, std::size_t camera = 0);

  // Called in the GUI thread for the available events, whenever the cursor moves while the page is visible.
  void setEventSource(std::function<EventLookup()> source);

  double time_s() const;
  bool isPlaying() const;
  // True while background work is running.
  bool busy() const;

  View3D* view() const;
  void setTrajectoryColour(TrajectoryColour colour);
  void setLayerVisible(SceneLayer layer, bool visible);

  QSize sizeHint() const override { return {1000, 650}; }

 public slots:
  void setTime(double time_s);
  void setPlaying(bool playing);

 signals:
  void timeSelected(double time_s);

 protected:
  void changeEvent(QEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  struct Private;
  std::unique_ptr<Private> d_;
};

}  // namespace evical::ui
