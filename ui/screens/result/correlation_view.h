// SPDX-License-Identifier: GPL-3.0-or-later
// Correlation matrix as a heat map, for quantities that are hardly separable. Rows and columns have names,
// one for all parts of a quantity. A click pins a cell and its text, a second one releases it.
#pragma once

#include "core/report/result_yaml.h"

#include <Eigen/Core>

#include <QStringList>
#include <QWidget>

#include <optional>
#include <utility>
#include <vector>

namespace evical::ui {

class FileSaver;

class CorrelationView : public QWidget {
  Q_OBJECT

 public:
  explicit CorrelationView(QWidget* parent = nullptr);

  void setResult(const NamedResult& result);
  QStringList axisLabels() const;
  QString csv() const;
  // The largest off-diagonal ones: "left: translation x and left: time offset: 0.94".
  QStringList strongestPairs(int count) const;
  QString textAt(const QPoint& position) const;
  QString pinnedText() const;  // empty: no cell is pinned
  QPoint cellMiddle(Eigen::Index row, Eigen::Index col) const;
  QSize minimumSizeHint() const override { return {260, 260}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void changeEvent(QEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  using Cell = std::pair<Eigen::Index, Eigen::Index>;
  // Adjacent parts of one quantity: x, y and z.
  struct Group {
    QString label;
    Eigen::Index begin = 0, count = 0;
  };
  double cellSize_px() const;
  void measureLabels();
  QRectF square(const Cell& cell) const;
  void hover(const std::optional<Cell>& cell);
  QPointF origin() const;
  QFont labelFont() const;
  std::optional<Cell> cellAt(const QPointF& position) const;
  QString textOf(const std::optional<Cell>& cell) const;
  void paintCells(QPainter& painter, const QRectF& dirty) const;
  void paintLabels(QPainter& painter) const;
  void paintScale(QPainter& painter) const;
  void paintPinned(QPainter& painter) const;
  void save(bool table);

  QStringList names_, words_;  // words: "left: rotation vector x"
  std::vector<Group> groups_;
  FileSaver* saver_;
  Eigen::MatrixXd correlation_;
  double longest_label_px_ = 0.0;
  std::optional<Cell> hovered_, pinned_;
};

}  // namespace evical::ui
