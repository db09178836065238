// SPDX-License-Identifier: GPL-3.0-or-later
// Table model of a camera's windows, filtered and sorted.
#pragma once

#include "ui/detection/timeline.h"

#include "core/pipeline/rig/calibration_pipeline.h"

#include <QAbstractTableModel>
#include <QSortFilterProxyModel>

#include <limits>
#include <optional>
#include <vector>

// Data of each window in the list: outcome, fit to the calibration, speed of the board. Pure functions, for
// worker threads.

namespace evical::ui {

struct WindowRow {
  WindowReport report;
  WindowOutcome found = WindowOutcome::TooFewEvents;             // before a rejection by hand
  bool has_view = false;                                         // it can be rejected, or kept again
  double rms_px = std::numeric_limits<double>::quiet_NaN();      // of the circles used by the run
  double speed_px_s = std::numeric_limits<double>::quiet_NaN();  // median of the circles' speeds
};

// In time order, one per window.
std::vector<WindowRow> windowRows(const CalibrationRun& run, std::size_t camera);

// Nearest to the middle of all, among the windows with a complete board, or else any part of it.
std::optional<double> middleOfSeen_s(const std::vector<WindowReport>& windows);

class WindowPictures;

class WindowListModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { Picture, Time, State, Circles, Rms, Speed, ColumnCount };
  static constexpr int kSortRole = Qt::UserRole;
  static constexpr int kSecondLineRole = Qt::UserRole + 1;  // reason, below the state

  explicit WindowListModel(const WindowPictures& pictures, QObject* parent = nullptr);

  void setWindows(std::vector<WindowRow> rows, CameraKind kind);  // in time order
  void setRejected(std::vector<double> times_s);                  // middles of excluded windows, ascending
  void pictureWasMade(int row);

  const std::vector<WindowRow>& windows() const { return rows_; }
  const WindowRow& window(int row) const { return rows_.at(static_cast<std::size_t>(row)); }
  bool isRejected(int row) const;
  bool isPending(int row) const;  // differs from the last run
  WindowClass classOf(int row) const;
  QString secondLine(int row) const;
  double worstFrom_px() const { return worst_from_px_; }  // smallest RMS of the worst tenth
  std::optional<int> rowAt(double time_s) const;          // nearest of the windows that contain the time

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  QString textOf(int row, int column) const;
  QVariant sortKeyOf(int row, int column) const;
  QString helpOf(int row) const;

  const WindowPictures& pictures_;
  std::vector<WindowRow> rows_;
  std::vector<double> rejected_s_;
  CameraKind kind_ = CameraKind::Events;
  double worst_from_px_ = 0.0;
};

enum class WindowFilter { All, Missed, Partial, Rejected, Worst };

class WindowListFilter : public QSortFilterProxyModel {
  Q_OBJECT

 public:
  explicit WindowListFilter(WindowListModel& model, QObject* parent = nullptr);

  void setFilter(WindowFilter filter);
  WindowFilter filter() const { return filter_; }

 protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

 private:
  const WindowListModel& model_;
  WindowFilter filter_ = WindowFilter::All;
};

QString windowClassName(WindowClass window_class);
// Outcomes have the names for event windows.
QString windowOutcomeWords(WindowOutcome outcome, bool of_frame);

}  // namespace evical::ui
