// SPDX-License-Identifier: GPL-3.0-or-later
// Observability of each direction, relative to the need.
#pragma once

#include <QString>
#include <QStringList>
#include <QWidget>

#include <vector>

namespace evical::ui {

class FileSaver;

class ObservabilityView : public QWidget {
  Q_OBJECT

 public:
  explicit ObservabilityView(QWidget* parent = nullptr);

  // Information in units of the need, ascending (UncertaintyReport::observability), and the name of each
  // direction; results of older programs name only the first.
  void setObservability(const std::vector<double>& information, const QStringList& directions);
  QString text() const;  // as text
  QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  bool event(QEvent* event) override;

 private:
  double rowHeight_px() const;
  double place_px(double ratio) const;  // on the logarithmic scale
  void paintBar(QPainter& painter, std::size_t bar) const;
  void paintScale(QPainter& painter) const;
  QString nameOf(std::size_t bar) const;

  bool calibrated_ = false;
  std::vector<double> needed_over_sigma_;  // empty: all quantities were given
  QStringList directions_;
  FileSaver* saver_;
};

}  // namespace evical::ui
