// SPDX-License-Identifier: GPL-3.0-or-later
// Printed sheet with the layout of core, on the screen and on a printer.
#pragma once

#include "core/printing/board_sheet.h"

#include <QWidget>

#include <optional>

class QPainter;

namespace evical::ui {

// In millimetres of the sheet, in the painter's current transform.
void paintSheet(QPainter& painter, const BoardSheet& sheet);

class SheetPreview : public QWidget {
  Q_OBJECT

 public:
  explicit SheetPreview(QWidget* parent = nullptr);

  void setSheet(std::optional<BoardSheet> sheet);  // none: empty preview
  QSize sizeHint() const override { return {420, 420}; }
  QSize minimumSizeHint() const override { return {220, 160}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::optional<BoardSheet> sheet_;
};

}  // namespace evical::ui
