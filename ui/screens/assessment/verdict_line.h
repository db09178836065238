// SPDX-License-Identifier: GPL-3.0-or-later
// Verdict of a page: a mark by colour and shape, the verdict, and its reason.
#pragma once

#include <QWidget>

class QLabel;
class QVBoxLayout;

namespace evical::ui {

enum class VerdictTone { Good, Doubtful, Bad };

class VerdictLine : public QWidget {
  Q_OBJECT

 public:
  // Object names of the labels: <name>_verdict and <name>_reason.
  explicit VerdictLine(const QString& name, QWidget* parent = nullptr);

  void addLine(QWidget* line);  // below
  void setVerdict(VerdictTone tone, const QString& title, const QString& reason);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void paintMark();

  VerdictTone tone_ = VerdictTone::Doubtful;
  QLabel *mark_, *title_, *reason_;
  QVBoxLayout* lines_;
};

}  // namespace evical::ui
