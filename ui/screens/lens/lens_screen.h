// SPDX-License-Identifier: GPL-3.0-or-later
// Result of a camera calibrated alone: numbers with sigmas, uncertainty over the image, the views, and the
// difference to another lens of this camera.
#pragma once

#include "core/format/intrinsics_yaml.h"
#include "core/pipeline/lens/lens_comparison.h"
#include "core/report/intrinsics_report.h"

#include <QWidget>
#include <QtGlobal>

#include <array>
#include <optional>
#include <utility>
#include <vector>

class QComboBox;
class QLabel;
class QListWidget;
class QMenu;
class QPushButton;
class QStackedWidget;
class QTabWidget;
class QTreeWidget;

namespace evical::ui {

class ImageMapView;
class ViewsChart;

class LensScreen : public QWidget {
  Q_OBJECT

 public:
  // Title in lists, and lens.
  using Other = std::pair<QString, KnownIntrinsics>;

  explicit LensScreen(QWidget* parent = nullptr);

  void setLens(std::optional<NamedIntrinsics> found);
  // Lenses to compare with; a new one is compared with immediately.
  void setOthers(std::vector<Other> others);
  void setOutdated(bool outdated);     // the session has changed since this lens
  void setInSession(bool in_session);  // the session's camera has this lens
  // Formats of other programs for a lens alone: name and description, listed below Evical's files.
  void setPrograms(const std::vector<std::pair<QString, QString>>& programs);

 signals:
  void calibrateRequested();
  void useRequested();           // in the session's camera
  void otherRequested();         // a file to compare with
  void saveRequested(int file);  // index of a LensFile
  void saveAllRequested();       // all of them, into a folder
  void exportRequested(const QString& program);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QWidget* makeEmpty();
  QWidget* makeContent();
  QWidget* makeHeader();
  QWidget* makeComparisons();
  QWidget* makeSides();
  QPushButton* makeSave();
  QWidget* addTab(const QString& title, QWidget* picture, QLabel* text);
  void compare();
  void showVerdict();
  void showParameters();
  void showMaps();
  void showDifference();
  const Other* other() const;

  std::optional<NamedIntrinsics> lens_;
  std::optional<LensComparison> comparison_;
  std::vector<Other> others_;
  QStackedWidget* stack_;
  QLabel *icon_, *verdict_, *reason_, *fit_, *outdated_, *in_session_, *remark_;
  QPushButton* use_ = nullptr;
  QLabel *uncertainty_text_, *coverage_text_, *difference_text_, *views_text_;
  QComboBox* against_;
  QTreeWidget* parameters_;
  QTabWidget* sides_;
  ImageMapView *uncertainty_, *coverage_, *difference_;
  ViewsChart* views_;
  QListWidget* notes_;
  QMenu* programs_;
};

// File formats in which a lens can be saved.
struct LensFile {
  const char* title;  // shown
  const char* name;   // in core (pipeline/intrinsics_files.h)
};

inline constexpr std::array kLensFiles = {
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Evical: lens with sigmas and correlations"), "intrinsics.yaml"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "ROS camera_info"), "camera_info.yaml"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Kalibr camchain"), "camchain.yaml"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Projection uncertainty over the image, table"),
             "projection_std.csv"},
    LensFile{QT_TRANSLATE_NOOP("LensFile", "Detections of the board, table"), "detections.csv"}};

}  // namespace evical::ui
