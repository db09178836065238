// SPDX-License-Identifier: GPL-3.0-or-later
// How well the recording determines each direction, held against what is needed.
#pragma once

#include <QString>
#include <QWidget>

#include <vector>

namespace evical::ui {

class ObservabilityView : public QWidget {
  Q_OBJECT

 public:
  explicit ObservabilityView(QWidget* parent = nullptr);

  // Information in units of what is needed, ascending
  // (UncertaintyReport::observability); the weakest in words.
  void setObservability(const std::vector<double>& information, const QString& weakest);
  QString text() const;  // in words
  QSize minimumSizeHint() const override { return {260, 160}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  bool calibrated_ = false;
  std::vector<double> needed_over_sigma_;  // empty: everything was given
  QString weakest_;
};

}  // namespace evical::ui
