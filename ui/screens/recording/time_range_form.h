// SPDX-License-Identifier: GPL-3.0-or-later
// Used part of the recording: begin and end in seconds since its start; empty for the whole. For an invalid
// range, the reason is shown next to the fields and nothing changes.
#pragma once

#include <QWidget>

#include <array>
#include <optional>

class QLabel;
class QLineEdit;
class QToolButton;

namespace evical::ui {

class TimeRangeForm : public QWidget {
  Q_OBJECT

 public:
  using Range = std::optional<std::array<double, 2>>;

  explicit TimeRangeForm(QWidget* parent = nullptr);

  void setRange(const Range& range_s);
  void setDuration(std::optional<double> duration_s);  // of the recording, if known

 signals:
  void edited(const std::optional<std::array<double, 2>>& range_s);  // nothing: all of the recording

 private:
  void take();
  void say(const QString& problem);
  void showAdvice();

  Range range_s_;
  std::optional<double> duration_s_;
  QLineEdit *begin_, *end_;
  QToolButton* all_;
  QLabel* words_;
};

}  // namespace evical::ui
