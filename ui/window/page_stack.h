// SPDX-License-Identifier: GPL-3.0-or-later
// The pages of a window. How large they are does not follow from what is on them (who holds them says how small they
// may be): else whenever anything in the window changes its size, every page, seen or not, lays out each of its wrapped
// texts anew, which took half of a run's computing.
#pragma once

#include <QStackedWidget>

namespace evical::ui {

class PageStack final : public QStackedWidget {
 public:
  using QStackedWidget::QStackedWidget;
  bool hasHeightForWidth() const override { return false; }
  QSize sizeHint() const override { return minimumSize(); }
  QSize minimumSizeHint() const override { return minimumSize(); }
};

}  // namespace evical::ui
