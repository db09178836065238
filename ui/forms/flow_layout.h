// SPDX-License-Identifier: GPL-3.0-or-later
// Layout in a row that continues in further rows if space is short: nothing is cut or hidden.
#pragma once

#include <QLayout>

#include <memory>
#include <vector>

namespace evical::ui {

class FlowLayout : public QLayout {
 public:
  explicit FlowLayout(QWidget* parent);
  ~FlowLayout() override;

  void addItem(QLayoutItem* item) override;
  int count() const override { return static_cast<int>(items_.size()); }
  QLayoutItem* itemAt(int index) const override;
  QLayoutItem* takeAt(int index) override;
  Qt::Orientations expandingDirections() const override { return {}; }
  bool hasHeightForWidth() const override { return true; }
  int heightForWidth(int width) const override;
  QSize sizeHint() const override;
  QSize minimumSize() const override;
  void setGeometry(const QRect& area) override;

 private:
  int place(const QRect& area, bool move) const;  // returns the required height

  std::vector<std::unique_ptr<QLayoutItem>> items_;
};

}  // namespace evical::ui
