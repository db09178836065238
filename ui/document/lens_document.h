// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration of a camera's lens alone: whether it is the aim, the camera, the last run, and the lenses to
// compare with. GUI thread only; without widgets. The session belongs to the other document.
#pragma once

#include "core/format/intrinsics_yaml.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "ui/document/calibration_aim.h"
#include "ui/document/calibration_document.h"

#include <QObject>
#include <QString>

#include <memory>
#include <optional>
#include <vector>

namespace evical::ui {

// A run with its inputs.
struct LensRecord {
  std::shared_ptr<const IntrinsicsRun> run;
  // Views of the board, in the session's time, with an entry for each of its cameras; no poses.
  std::shared_ptr<const CalibrationRun> seen;
  Session session;
  std::size_t camera = 0;
  QString log;
};

struct OtherLens {
  QString title;
  KnownIntrinsics lens;
};

class LensDocument : public QObject {
  Q_OBJECT

 public:
  explicit LensDocument(CalibrationDocument& document, QObject* parent = nullptr);

  // The first session keeps the choice made before it. A later one keeps it, for the calibration of one
  // camera after another, unless it has an IMU: then the aim is the rig.
  CalibrationAim aim() const { return aim_; }
  void setAim(CalibrationAim aim);
  std::size_t camera() const;  // index in the session, 0 if it has no camera of the name
  void setCamera(const QString& name);

  // The session has one camera and no IMU, but the aim is a rig.
  bool offersCameraOnly() const;
  std::vector<SessionProblem> problems() const;          // problems of the current aim
  std::vector<SessionProblem> problemsOfCamera() const;  // problems if the camera alone were the aim

  const LensRecord& last() const { return last_; }  // none before the first and in a new session
  void addRun(LensRecord record);
  bool runIsOutdated() const;  // the session has changed since the last run

  // The session's lens of that camera, and the one from a file.
  std::vector<OtherLens> others() const;
  void loadOther(const QString& file);  // throws CalibrationError and leaves everything unchanged

  // Copies the lens into the session's camera, without its sigmas, since the same recording would count
  // twice.
  void useInSession();
  bool isInSession() const;  // the session's camera has the last run's lens

 signals:
  void aimChanged();  // aim or camera
  void runChanged();
  void othersChanged();

 private:
  std::optional<std::size_t> cameraOfRun() const;  // index in the session, of the last run's sensor

  CalibrationDocument& document_;
  CalibrationAim aim_ = CalibrationAim::Rig;
  bool had_session_ = false;
  QString camera_;
  LensRecord last_;
  std::optional<OtherLens> file_;
};

}  // namespace evical::ui
