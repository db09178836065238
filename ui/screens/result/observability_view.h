// SPDX-License-Identifier: GPL-3.0-or-later
// How well the recording determines each direction, held against what is needed.
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

  // Information in units of what is needed, ascending (UncertaintyReport::observability), and each direction in words;
  // results of older programs name the first only.
  void setObservability(const std::vector<double>& information, const QStringList& directions);
  QString text() const;  // in words
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
  std::vector<double> needed_over_sigma_;  // empty: everything was given
  QStringList directions_;
  FileSaver* saver_;
};

}  // namespace evical::ui
