// SPDX-License-Identifier: GPL-3.0-or-later
// List of a camera's windows with a picture of each: sorts, filters, selects, and rejects or keeps windows
// for the next calibration. Rejections are emitted as a signal, and return by setRejected().
#pragma once

#include "ui/detection/window_list_model.h"
#include "ui/detection/window_pictures.h"
#include "ui/jobs/latest_job.h"

#include <QSize>
#include <QStyledItemDelegate>
#include <QTimer>
#include <QWidget>

#include <memory>

class QComboBox;
class QHBoxLayout;
class QLabel;
class QMenu;
class QPushButton;
class QStackedLayout;
class QTreeView;

namespace evical::ui {

class WindowList : public QWidget {
  Q_OBJECT

 public:
  explicit WindowList(QWidget* parent = nullptr);

  // Null: none, and `note` is the reason. The list is filled after its preparation in a thread.
  void setRun(std::shared_ptr<const CalibrationRun> run, std::size_t camera, const QString& note);
  // Permission to reject windows, and the excluded times of this camera.
  void setRejectable(bool rejectable);
  void setRejected(std::vector<double> times_s);
  // Numbers of changes for all cameras, compared with the last run.
  void setPending(int to_reject, int to_keep);
  void setBusy(bool busy);  // a running job blocks calibrations
  void setSource(const PictureSource& source, const SurfaceStyle& style);

  const WindowListModel& model() const { return *model_; }
  const WindowPictures& pictures() const { return *pictures_; }
  int shownCount() const { return filter_->rowCount(); }
  WindowFilter filter() const { return filter_->filter(); }
  std::vector<int> selectedWindows() const;  // rows of the model, ascending

 public slots:
  void setTime(double time_s);  // selects the row without a signal
  void setFilter(evical::ui::WindowFilter filter);
  void wantPictures();  // for the visible rows, soon
  void rejectSelected() { changeSelected(true); }
  void keepSelected() { changeSelected(false); }

 signals:
  void windowChosen(double time_s);  // middle of the window
  void rejectionWanted(const std::vector<double>& times_s,
                       const QString& what);  // all rejections of this camera
  void filled();

 protected:
  void resizeEvent(QResizeEvent*) override;
  void showEvent(QShowEvent*) override;

 private:
  QWidget* makeFilterBar();
  void makeTable();
  QWidget* makeActions();
  QPushButton* addAction(QHBoxLayout* row, const QString& icon_name, const QString& text,
                         const QString& help);
  void showMenu(const QPoint& at);
  void changeSelected(bool reject);
  bool canChange(bool reject) const;
  void askForPictures();
  void followTime();
  void fitColumns();
  void refresh();

  WindowPictures* pictures_;
  WindowListModel* model_;
  WindowListFilter* filter_;
  std::vector<double> rejected_s_;
  double time_s_ = 0.0;
  bool rejectable_ = false, busy_ = false, following_ = false;
  int to_reject_ = 0, to_keep_ = 0;
  QTimer soon_;
  QStackedLayout* stack_ = nullptr;
  QTreeView* table_ = nullptr;
  QComboBox* filter_box_ = nullptr;
  QLabel *note_ = nullptr, *count_ = nullptr, *pending_ = nullptr;
  QPushButton *reject_ = nullptr, *keep_ = nullptr;
  LatestJob job_{OutdatedWork::Dropped};
};

// Paints a row of the list of windows: the picture, the state with its colour and shape of the timeline, and
// a short reason below it.

inline constexpr QSize kPictureSize_px(64, 48);

class WindowRowPainter : public QStyledItemDelegate {
  Q_OBJECT

 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override;
  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override;

 private:
  static void paintPicture(QPainter& painter, const QRect& cell, const QModelIndex& index);
  static void paintState(QPainter& painter, const QStyleOptionViewItem& option, const QModelIndex& index);
};

}  // namespace evical::ui
