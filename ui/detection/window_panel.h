// SPDX-License-Identifier: GPL-3.0-or-later
// "This window: why": what became of the window at the cursor, stage by stage, in words.
#pragma once

#include "core/data/board_observations.h"

#include <QTextBrowser>

#include <optional>

namespace evical::ui {

struct WindowAnalysis;

class WindowPanel : public QTextBrowser {
  Q_OBJECT

 public:
  explicit WindowPanel(QWidget* parent = nullptr);

  // Either may be missing: what the front end makes of the window now, and what it made of
  // it in the last pass.
  void show(const WindowAnalysis* analysis, const std::optional<WindowReport>& report, bool searching);
  QString text() const;  // as it is read, without markup

 private:
  QString html_;
};

}  // namespace evical::ui
