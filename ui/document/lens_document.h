// SPDX-License-Identifier: GPL-3.0-or-later
// A camera's lens alone: whether that is what is calibrated, of which camera, what the last run found, and what it is
// compared with. GUI thread only; knows no widgets. The session is the other document's.
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

// A run, and what it was made from.
struct LensRecord {
  std::shared_ptr<const IntrinsicsRun> run;
  // Where the board was seen, in the session's own time and with an entry for each of its cameras; no poses.
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

  // Stays when another session comes: who calibrates one camera after the other says so once.
  CalibrationAim aim() const { return aim_; }
  void setAim(CalibrationAim aim);
  std::size_t camera() const;  // of the session's, 0 while it has none of the name
  void setCamera(const QString& name);

  // A session of one camera and no IMU, whose aim is a rig all the same.
  bool offersCameraOnly() const;
  std::vector<SessionProblem> problems() const;          // that stand in the way of the aim
  std::vector<SessionProblem> problemsOfCamera() const;  // were the camera alone the aim

  const LensRecord& last() const { return last_; }  // none: before the first, and when another session comes
  void addRun(LensRecord record);
  bool runIsOutdated() const;  // the session is not as it was when it was made

  // The session's lens of that camera, and the one of a file.
  std::vector<OtherLens> others() const;
  void loadOther(const QString& file);  // throws CalibrationError, and leaves everything as it was

  // Puts the lens into the session's camera: without its sigmas, since the same recording would count twice.
  void useInSession();

 signals:
  void aimChanged();  // or the camera
  void runChanged();
  void othersChanged();

 private:
  CalibrationDocument& document_;
  CalibrationAim aim_ = CalibrationAim::Rig;
  QString camera_;
  LensRecord last_;
  std::optional<OtherLens> file_;
};

}  // namespace evical::ui
