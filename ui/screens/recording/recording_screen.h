// SPDX-License-Identifier: GPL-3.0-or-later
// Recording and session: streams and their roles, the board, the sensors.
#pragma once

#include "core/pipeline/rig/recording_assessment.h"
#include "core/pipeline/session/session.h"
#include "core/recording/inspection.h"

#include <QWidget>

#include <memory>
#include <optional>
#include <vector>

class QComboBox;
class QFormLayout;
class QLabel;
class QProgressBar;
class QPushButton;
class QStackedWidget;
class QTabWidget;

namespace evical::ui {

class AimChooser;
class BoardsForm;
class CheckCard;
class CameraForm;
class ImuForm;
class StreamTable;
class TimeRangeForm;

class RecordingScreen : public QWidget {
  Q_OBJECT

 public:
  explicit RecordingScreen(QWidget* parent = nullptr);

  void setSession(const Session& session);
  // By camera: intrinsics of the last run if the session has none.
  void setFoundIntrinsics(const std::vector<std::optional<CameraIntrinsics>>& found);
  // By field: "cameras.left.intrinsics", "board", ...; each text is shown next to its field.
  void setProblems(const std::vector<std::pair<QString, QString>>& field_and_text);
  // If a rig calibration was requested but the session has one camera and no IMU.
  void offerCameraOnly(bool offered);
  AimChooser& aim() const { return *aim_; }  // what is calibrated

  // Text in place of "ready to calibrate" if there is no problem; empty: none, in the colour of the light.
  // With a text, Light::Good means undecided.
  void setReservation(const QString& text, Light light);
  void setCalibrating(bool calibrating);
  CheckCard* checkCard() const { return check_; }

  void clearInspections();
  // Name of a recording that replaces the session when it has been read; empty: none.
  void setReading(const QString& recording);
  void setInspecting(const QString& recording);
  void setInspectionProgress(double fraction);
  // An incomplete end is not a fault then.
  void setBeingWritten(bool being_written);
  // For the session's recording, or another one with sensors.
  void addInspection(const QString& recording, std::shared_ptr<const Inspection> inspection);
  void setInspectionFailed(const QString& why);

 signals:
  // Consecutive edits with the same `merge_key` are one step of undo.
  void sessionEdited(const evical::Session& session, const QString& what, const QString& merge_key);
  void openRecordingRequested();
  void addRecordingRequested();
  void cameraOnlyRequested();  // requests the calibration of the camera

 protected:
  void changeEvent(QEvent* event) override;

 private:
  struct Inspected {
    std::filesystem::path recording;
    std::shared_ptr<const Inspection> inspection;
  };

  QWidget* makeHeader();
  QWidget* makeForms();
  QWidget* makeEmpty();
  QWidget* makeContent();
  QWidget* makeReading();
  void showPart();
  void showVerdict();
  void showSensors();
  void showShutters();
  bool isOfEvents(const SessionCamera& camera) const;
  void chooseRole(int row, int role);
  QWidget* makeRangeAndFiles(QWidget* parent);
  std::optional<CameraIntrinsics> foundIntrinsics(std::size_t camera) const;
  std::vector<std::string> possibleSensors(std::size_t camera) const;
  std::vector<std::string> possibleBoards() const;
  void renameReference(const std::string& from, const std::string& to, Session& session) const;
  void editCamera(std::size_t index, const SessionCamera& camera, const QString& field);
  void editImu(std::size_t index, const SessionImu& imu, const QString& field);
  void listStreams();
  std::filesystem::path ownRecording(const Inspected& one) const;  // empty: the session's recording
  void showFileFaults();

  bool being_written_ = false, calibrating_ = false;
  Session session_;
  std::vector<Inspected> inspected_;  // their streams are the table's rows
  QStackedWidget* stack_;
  QLabel *title_, *path_, *verdict_, *looking_text_, *file_faults_, *reading_text_ = nullptr;
  QProgressBar *looking_, *reading_bar_ = nullptr;
  bool reading_ = false;
  StreamTable* streams_;
  TimeRangeForm* time_range_;
  BoardsForm* boards_;
  CheckCard* check_;
  QString reservation_;
  Light reservation_light_ = Light::Good;
  QTabWidget* sensors_;
  QComboBox* reference_;
  QFormLayout* reference_form_;
  AimChooser* aim_;
  QPushButton* camera_only_;
  std::size_t problems_ = 0;
  std::vector<CameraForm*> cameras_;
  std::vector<std::optional<CameraIntrinsics>> found_intrinsics_;
  std::vector<ImuForm*> imus_;
};

}  // namespace evical::ui
