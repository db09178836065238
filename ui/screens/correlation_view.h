// SPDX-License-Identifier: GPL-3.0-or-later
// Which quantities can only be told apart badly: the correlation matrix as a heat map.
#pragma once

#include <Eigen/Core>

#include <QStringList>
#include <QWidget>

#include <optional>
#include <utility>

namespace evical::ui {

class CorrelationView : public QWidget {
  Q_OBJECT

 public:
  explicit CorrelationView(QWidget* parent = nullptr);

  void setCorrelation(const QStringList& names, const Eigen::MatrixXd& correlation);
  // "a and b: 0.94" of the largest, without those of one with itself.
  QStringList strongestPairs(int count) const;
  QString textAt(const QPoint& position) const;
  QSize minimumSizeHint() const override { return {260, 260}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;

 private:
  using Cell = std::pair<Eigen::Index, Eigen::Index>;
  double cellSize_px() const;
  int labelWidth_px() const;
  QPointF origin() const;
  std::optional<Cell> cellAt(const QPointF& position) const;
  void paintScale(QPainter& painter) const;

  QStringList names_;
  Eigen::MatrixXd correlation_;
  std::optional<Cell> hovered_;
};

}  // namespace evical::ui
