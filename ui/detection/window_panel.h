// SPDX-License-Identifier: GPL-3.0-or-later
// Outcome of the window at the cursor, stage by stage, as text.
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

  // Either may be missing: the current analysis of the window, and its report from the last run.
  void show(const WindowAnalysis* analysis, const std::optional<WindowReport>& report, bool searching);
  QString text() const;  // plain text, without markup

 private:
  QString html_;
};

}  // namespace evical::ui
