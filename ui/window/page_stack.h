// SPDX-License-Identifier: GPL-3.0-or-later
// The pages of a window. Its size is independent of their contents (the parent sets the minimum): otherwise
// every change of size in the window would trigger a layout of the wrapped texts of all pages, hidden or not,
// which took half of a run's computing time.
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
