// SPDX-License-Identifier: GPL-3.0-or-later
// One camera of the session: name, resolution, intrinsics from a file or as numbers.
#pragma once

#include "core/pipeline/session/session.h"

#include <QWidget>

#include <array>
#include <optional>
#include <string>
#include <vector>

class QComboBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QPushButton;

namespace evical::ui {

class NumberField;

class CameraForm : public QWidget {
  Q_OBJECT

 public:
  explicit CameraForm(QWidget* parent = nullptr);

  // `others`: cameras that may share this camera's sensor. `boards`: boards that it may see, if there are
  // several.
  void setCamera(const SessionCamera& camera, const std::vector<std::string>& others = {},
                 const std::vector<std::string>& boards = {});
  void offerShutter(bool offered);  // for cameras that may have frames
  // Intrinsics of the last run; offered while the camera has none.
  void setFound(const std::optional<CameraIntrinsics>& found);
  // If the file is unusable, shows the reason next to the button and leaves the camera unchanged.
  void loadIntrinsics(const QString& file);

 signals:
  void edited(const evical::SessionCamera& camera, const QString& field);

 private:
  void chooseFile();
  void takeOver();
  void say(const QString& field);
  std::optional<CameraIntrinsics> typedIntrinsics() const;  // none: unknown
  void showSensor();
  void showBoard();
  void showShutter();
  void showTakeOver();
  void showCoefficients(const CameraIntrinsics& shown);
  QWidget* pairOf(NumberField* first, NumberField* second);
  std::vector<NumberField*> intrinsicsFields() const;

  SessionCamera camera_;
  std::vector<std::string> others_, boards_;
  bool shutter_offered_ = true;
  QFormLayout* form_;
  QLineEdit* name_;
  NumberField *width_px_, *height_px_, *clock_offset_s_;
  QComboBox *model_, *shutter_, *sensor_, *board_;
  NumberField *focal_x_px_, *focal_y_px_, *centre_x_px_, *centre_y_px_;
  std::array<NumberField*, 5> distortion_;
  QLabel* coefficient_names_;
  std::optional<CameraIntrinsics> found_;
  QPushButton* take_over_;
  QLabel* file_problem_;
};

}  // namespace evical::ui
