// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/empty_hint.h"

#include "ui/screens/wrapped_label.h"

#include <QVBoxLayout>

namespace evical::ui {

QWidget* emptyHint(const QString& text, QWidget* parent) {
  constexpr int kText_px = 560;
  auto* const empty = new QWidget(parent);
  QLabel* const words = selectableLabel("hint", text, empty);
  words->setMaximumWidth(kText_px);
  auto* const row = new QHBoxLayout;
  row->addStretch();
  row->addWidget(words, 1);
  row->addStretch();
  auto* const layout = new QVBoxLayout(empty);
  layout->addStretch(1);
  layout->addLayout(row);
  layout->addStretch(2);
  return empty;
}

}  // namespace evical::ui
