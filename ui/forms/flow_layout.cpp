// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/flow_layout.h"

#include <algorithm>

namespace evical::ui {

FlowLayout::FlowLayout(QWidget* parent) : QLayout(parent) {}

FlowLayout::~FlowLayout() = default;

void FlowLayout::addItem(QLayoutItem* item) {
  items_.emplace_back(item);
}

QLayoutItem* FlowLayout::itemAt(int index) const {
  return index >= 0 && index < count() ? items_[static_cast<std::size_t>(index)].get() : nullptr;
}

QLayoutItem* FlowLayout::takeAt(int index) {
  if (itemAt(index) == nullptr) return nullptr;
  QLayoutItem* const taken = items_[static_cast<std::size_t>(index)].release();
  items_.erase(items_.begin() + index);
  return taken;
}

int FlowLayout::heightForWidth(int width) const {
  return place({0, 0, width, 0}, false);
}

// Width in one row.
QSize FlowLayout::sizeHint() const {
  const QMargins margins = contentsMargins();
  int width = 0, height = 0;
  for (const auto& item : items_) {
    if (item->isEmpty()) continue;
    width += item->sizeHint().width() + (width > 0 ? spacing() : 0);
    height = std::max(height, item->sizeHint().height());
  }
  return QSize(width, height).grownBy(margins);
}

QSize FlowLayout::minimumSize() const {
  QSize least(0, 0);
  for (const auto& item : items_)
    if (!item->isEmpty()) least = least.expandedTo(item->minimumSize());
  return least.grownBy(contentsMargins());
}

void FlowLayout::setGeometry(const QRect& area) {
  QLayout::setGeometry(area);
  place(area, true);
}

int FlowLayout::place(const QRect& area, bool move) const {
  const QRect room = area.marginsRemoved(contentsMargins());
  std::vector<QLayoutItem*> row;
  int x = room.x(), y = room.y(), row_height = 0;
  const auto end_row = [&] {
    int at = room.x();
    for (QLayoutItem* const item : row) {
      const QSize size(std::min(item->sizeHint().width(), room.width()), item->sizeHint().height());
      if (move) item->setGeometry({QPoint(at, y + (row_height - size.height()) / 2), size});
      at += size.width() + spacing();
    }
    y += row_height;
    row.clear();
    row_height = 0;
    x = room.x();
  };
  for (const auto& item : items_) {
    if (item->isEmpty()) continue;
    const QSize size = item->sizeHint();
    if (!row.empty() && x + size.width() > room.x() + room.width()) {
      end_row();
      y += spacing();
    }
    row.push_back(item.get());
    row_height = std::max(row_height, size.height());
    x += size.width() + spacing();
  }
  end_row();
  return y - area.y() + contentsMargins().bottom();
}

}  // namespace evical::ui
