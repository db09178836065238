// SPDX-License-Identifier: GPL-3.0-or-later
// The calibrated motion in front of the board, in 3D. Knows no document: data come by setters, also while a
// calibration runs; clicks on the trajectory and what is played go out as times. Times are seconds since the recording's start
// on the first camera's clock.
#pragma once

#include "core/data/calibration_state.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "ui/jobs/live_view.h"
#include "ui/scene/frustum_events.h"
#include "ui/scene/trajectory_scene.h"

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

  // Loads the graphics driver now and elsewhere, so that showing the screen for the first time stalls nobody.
  void startInBackground();

  // Forgets all that was set.
  void clear();
  void setBoards(const Session& session);
  void setIntrinsics(const std::vector<std::optional<CameraIntrinsics>>& cameras);

  // A finished calibration: trajectory, residuals, and poses from its single views. Null: none.
  void setRun(std::shared_ptr<const CalibrationRun> run, const Session& session);

  // While a calibration runs: the estimate so far, and before there is one the board views so far, from which
  // poses are computed (again given with more views: only the new ones).
  void setState(std::shared_ptr<const CalibrationState> state);
  void setDetections(SharedViews views, const CameraIntrinsics& intrinsics, std::size_t camera = 0);

  // Asked in the GUI thread for what can be looked up now, whenever the cursor moves while the page is in view.
  void setEventSource(std::function<EventLookup()> source);

  double time_s() const;
  bool isPlaying() const;
  // Work in the background is under way.
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
