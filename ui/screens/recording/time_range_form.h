// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of the recording is used: begin and end in seconds since its start, empty for as much as there
// is. What cannot be is said beside the fields and changes nothing.
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
  void setDuration(std::optional<double> duration_s);  // of the recording, where it is known

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
