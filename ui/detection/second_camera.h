// SPDX-License-Identifier: GPL-3.0-or-later
// View of another camera of the same kind next to the shown one, at the same time and with the same layers.
// It reads the recording separately, on first use.
#pragma once

#include "ui/detection/detection_engine.h"
#include "ui/detection/layers.h"

#include <QObject>

#include <functional>
#include <memory>
#include <optional>

namespace evical::ui {

class EventView;

class SecondCamera : public QObject {
  Q_OBJECT

 public:
  // Outlines of the board by a result, at a time of that camera's clock.
  using Reprojection = std::function<std::vector<QPolygonF>(std::size_t camera, double time_s)>;

  SecondCamera(EventView& view, Reprojection reprojection, QObject* parent = nullptr);
  ~SecondCamera() override;

  bool isOf(std::size_t camera) const { return engine_ && camera_ == camera; }
  void open(const Session& session, std::size_t camera);  // replaces the open camera
  void close();
  // Context for the next requests; no effect if no camera is open.
  void know(const Session& session, const DetectionSetup& sight,
            std::shared_ptr<const BoardObservations> seen);
  void show(const DetectionRequest& wish, const LayerSet& layers);
  void showLive(std::shared_ptr<const LiveWindow> window, const SurfaceStyle& style);

 signals:
  void frameReady();  // the view has it, with its layers

 private:
  void refresh();
  void takeOverview();

  EventView& view_;
  Reprojection reprojection_;
  std::size_t camera_ = 0;
  std::optional<DetectionRequest> wish_;  // the last one, possibly before the recording was open
  LayerSet layers_;
  std::shared_ptr<const WindowAnalysis> analysis_;
  std::unique_ptr<DetectionEngine> engine_;
};

}  // namespace evical::ui
