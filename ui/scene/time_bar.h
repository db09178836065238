// SPDX-License-Identifier: GPL-3.0-or-later
// Controls below the 3D view: play, pause, scrub and step through the recording's time.
#pragma once

#include <QElapsedTimer>
#include <QTimer>
#include <QWidget>

#include <vector>

class QComboBox;
class QLabel;
class QSlider;
class QToolButton;

namespace evical::ui {

class TimeBar : public QWidget {
  Q_OBJECT

 public:
  explicit TimeBar(QWidget* parent = nullptr);

  // Steps go from one of these times to the next, or by a few hundredths of a second without any. Ascending.
  void setTimes(double begin_s, double end_s, std::vector<double> stops_s);
  void setNoTimes();  // nothing to play
  double begin_s() const { return begin_s_; }
  double end_s() const { return end_s_; }
  double time_s() const { return time_s_; }
  bool isPlaying() const { return timer_.isActive(); }

 public slots:
  void setTime(double time_s);  // without a signal
  void setPlaying(bool playing);
  void togglePlaying() { setPlaying(!isPlaying()); }
  void step(int direction);
  void toStart();
  void toEnd();

 signals:
  void timeSelected(double time_s);  // also during playback
  void playingChanged(bool playing);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  QToolButton* addButton(const char* name, const QString& icon_name, const QString& help);
  void addSpeeds();
  void select(double time_s);
  void advance();
  bool hasTimes() const { return end_s_ > begin_s_; }
  void applyIcons();

  std::vector<std::pair<QToolButton*, QString>> icons_;
  QToolButton* play_ = nullptr;
  QSlider* slider_;
  QComboBox* speed_;
  QLabel* label_;
  QTimer timer_;
  QElapsedTimer since_frame_;
  double begin_s_ = 0.0, end_s_ = 0.0, time_s_ = 0.0;
  std::vector<double> stops_s_;
};

}  // namespace evical::ui
