// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded events or frames and the front end's stages: the picture at the cursor with one layer per stage, a
// timeline of the whole recording, and the reason for the outcome of a window or a frame.
#pragma once

#include "core/pipeline/detection/view_rejection.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "ui/detection/event_view.h"
#include "ui/detection/layers.h"
#include "ui/detection/live_detection.h"
#include "ui/detection/surface_frame.h"

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>

#include <memory>
#include <optional>
#include <span>
#include <vector>

class QBoxLayout;
class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QGridLayout;
class QHBoxLayout;
class QLabel;
class QPushButton;
class QToolButton;

namespace evical::ui {

// False for a run of one camera's lens alone, and if the folder lost its poses.
inline bool hasPoses(const CalibrationRun& run) {
  return !run.result.state.cameras.empty() &&
         !run.result.state.world_from_imu_rotation.control_points.empty();
}

class DetectionEngine;
struct KeptEvents;
struct DetectionRequest;
enum class PictureChoice;
struct RecordingOverview;
struct DetectionSetup;
class EventView;
class SecondCamera;
class Timeline;
class WindowList;
class WindowPanel;

class DetectionScreen : public QWidget {
  Q_OBJECT

 public:
  explicit DetectionScreen(QWidget* parent = nullptr);
  ~DetectionScreen() override;

  // Reads the recording again if it or its streams changed. The shown window is analysed again immediately,
  // with the session's options.
  void setSession(const Session& session);
  // Detections of a run, with its board and lenses, and their reprojections; `session` is the run's. Shown if
  // the open recording is the run's. Null: none.
  void setRun(std::shared_ptr<const CalibrationRun> run, const Session& session);

  // Times that the next calibration from the run's detections excludes, by camera; none if it is impossible.
  void setRejections(const std::optional<RejectedTimes>& rejections);
  void setBusy(bool busy);  // a running job blocks calibrations

  // Observer for a running job: the screen shows its windows during the detection.
  std::shared_ptr<CalibrationObserver> liveObserver();
  void setLive(bool live);
  bool isLive() const { return live_; }
  void showLiveFrame(std::shared_ptr<const LiveWindow> window);

  std::size_t camera() const { return camera_; }
  bool framesInView() const { return kind_ == CameraKind::Frames; }  // kind of the shown camera
  double time_s() const { return time_s_; }
  // Moves to a window near the middle that shows the board; not if the user has chosen a time or follows a
  // run.
  void goWhereSeen(std::span<const BoardObservations> cameras);
  bool isPlaying() const { return timer_.isActive(); }
  EventView& view() { return *view_; }
  void readAgain();                                        // the recording has changed
  std::optional<KeptEvents> keptEvents() const;            // of the part of the recording that has been read
  EventView& companionView() { return *companion_view_; }  // next to view(), if both are shown
  Timeline& timeline() { return *timeline_; }
  WindowPanel& panel() { return *panel_; }
  WindowList& windowList() { return *list_; }
  const std::shared_ptr<const WindowAnalysis>& analysis() const { return analysis_; }

 public slots:
  void setCamera(std::size_t camera);  // index in the session
  void setTime(double time_s);
  void setMode(evical::ui::SurfaceMode mode);
  void setPicture(evical::ui::PictureChoice picture);
  QString whyNoOverlay() const;  // empty: events can be drawn over the frame
  void setLayerVisible(evical::ui::Layer layer, bool visible);
  void setPlaying(bool playing);
  void step(int direction);  // to the next window or frame (+1) or the one before (-1)
  void stepToMissed(int direction);
  void setWindowsListed(bool listed);  // list of windows; replaces the layers if space is short

 signals:
  void timeSelected(double time_s);  // by the user, or by playing
  void rejectionsWanted(const evical::RejectedTimes& rejections, const QString& what);
  void recordingWanted(const QString& missing);  // path of a recording that the user wants to find

 protected:
  void changeEvent(QEvent*) override;
  void resizeEvent(QResizeEvent*) override;

 private:
  QWidget* makeToolBar();
  QWidget* makeSidePanel();
  QWidget* makeLayers();
  void layOutLayers();
  QWidget* makeTransport();
  QToolButton* addButton(QHBoxLayout* row, const QString& icon_name, const QString& help);
  void makeWindowList();
  void addListButton(QHBoxLayout* row);
  void addMissedButtons(QHBoxLayout* row);
  void layOutSides();
  void listWindows();
  void showRejections();
  void showPictures();
  void applyColours();
  void connectEngine();
  void addKeys();

  void chooseCamera(std::size_t camera);
  const CalibrationRun* runInView() const;  // null: none of this recording
  DetectionSetup detectionSetupOf(std::size_t camera) const;
  void showRun();
  void select(double time_s);
  void moveTo(double time_s);
  void advance();
  void request();  // asks the engine for the cursor, mode and layers
  void takeOverview();
  QString missingRecording() const;  // path of the camera's recording if it is missing
  void showMarksAlone();             // for a run whose recording is missing
  void keepCursorInside(const RecordingOverview& overview);
  void takeFrame();
  void takeAnalysis();
  void takeCompanion();
  void refresh();  // caption, panel, overlay
  bool analysisIsHere() const;
  void refreshPanel();
  static QString captionOf(const SurfaceFrame& frame);
  static ColourLegend legendOf(const SurfaceFrame& frame, SurfaceMode mode);
  void adaptTo(CameraKind kind);  // hides controls that do not apply to this kind
  void connectPictures();
  PictureChoice picture() const;
  void offerPictures();  // the choices for this camera
  void refreshCompanion();
  void keepSecondOpen();
  void showSecond(const DetectionRequest& wish);
  std::shared_ptr<const BoardObservations> seenBy(std::size_t camera) const;
  std::vector<QPolygonF> reprojectionInto(std::size_t camera, double time_s) const;
  bool following() const { return live_ && following_ && !framesInView(); }
  double endOfPlay_s() const;
  SurfaceStyle style() const;
  bool shown(Layer layer) const { return layers_.test(static_cast<std::size_t>(layer)); }

  std::optional<Session> session_;
  std::size_t camera_ = 0;
  CameraKind kind_ = CameraKind::Events;  // kind of camera_
  FrontEndOptions options_;
  std::shared_ptr<const CalibrationRun> run_;
  Session run_session_;
  std::shared_ptr<const WindowAnalysis> analysis_;
  LayerSet layers_ = defaultLayers();
  double time_s_ = 0.1;
  bool time_is_chosen_ = false;  // by the user, for the open session
  bool live_ = false, following_ = false;

  QTimer timer_, panel_timer_;
  QElapsedTimer since_frame_;
  std::optional<std::size_t> companion_;  // the camera of the other kind
  std::optional<std::size_t> second_;     // without a companion: another camera of the same kind
  EventView *view_ = nullptr, *companion_view_ = nullptr;
  Timeline* timeline_ = nullptr;
  WindowPanel* panel_ = nullptr;
  WindowList* list_ = nullptr;
  QBoxLayout* sides_ = nullptr;
  QWidget *side_ = nullptr, *layers_part_ = nullptr;
  std::optional<RejectedTimes> rejections_;
  std::optional<bool> list_wanted_;  // none: depends on the space
  QComboBox *mode_box_ = nullptr, *speed_box_ = nullptr, *camera_box_ = nullptr, *picture_box_ = nullptr;
  QDoubleSpinBox *fade_box_ = nullptr, *time_box_ = nullptr;
  QToolButton *play_button_ = nullptr, *follow_button_ = nullptr, *list_button_ = nullptr;
  QToolButton* more_layers_ = nullptr;
  QPushButton* look_for_ = nullptr;
  QLabel *status_ = nullptr, *fade_label_ = nullptr, *verdict_title_ = nullptr;
  QGridLayout* layer_grid_ = nullptr;
  std::vector<QCheckBox*> layer_boxes_;
  std::vector<std::pair<QToolButton*, QString>> icons_;
  LiveDetection* live_detection_ = nullptr;
  std::unique_ptr<DetectionEngine> engine_;
  SecondCamera* second_camera_ = nullptr;
};

}  // namespace evical::ui
