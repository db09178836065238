// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/how_to_record_dialog.h"

#include "ui/screens/recording/motion_picture.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QDialogButtonBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QToolButton>
#include <QVBoxLayout>

namespace evical::ui {

Motion motionOfDesktop() {
  return desktopAnimates() ? Motion::Moving : Motion::Reduced;
}

HowToRecordDialog::HowToRecordDialog(Motion motion, QWidget* parent)
    : QDialog(parent),
      list_(new QListWidget(this)),
      picture_(new MotionPicture(this)),
      words_(new QLabel(this)),
      play_(new QToolButton(this)),
      previous_(makeStep(-1, tr("&Previous"), "left")),
      next_(makeStep(1, tr("&Next"), "right")) {
  constexpr int kList_px = 210, kWords_px = 92;
  setWindowTitle(tr("How to record"));
  setObjectName("how_to_record_dialog");
  list_->setAccessibleName(tr("Motions"));
  list_->setToolTip(tr("The motions that a recording needs"));
  list_->setFixedWidth(kList_px);
  for (const ShownMotion& each : shownMotions()) list_->addItem(each.title);
  words_->setWordWrap(true);
  words_->setMinimumHeight(kWords_px);
  words_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  play_->setObjectName("play_motion");
  play_->setCheckable(true);
  play_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  connect(play_, &QToolButton::toggled, this, &HowToRecordDialog::setPlaying);
  connect(list_, &QListWidget::currentRowChanged, this, &HowToRecordDialog::choose);
  auto* const close = new QDialogButtonBox(QDialogButtonBox::Close, this);
  connect(close, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* const column = new QVBoxLayout;
  column->addWidget(picture_, 1);
  column->addWidget(words_);
  auto* const row = new QHBoxLayout;
  auto* const motions = new QVBoxLayout;
  auto* const pace = wrappedLabel(tr("30 s in all, about 4 s for each motion"), "hint", this);
  pace->setFixedWidth(kList_px);
  motions->addWidget(pace);
  motions->addWidget(list_, 1);
  row->addLayout(motions);
  row->addLayout(column, 1);
  auto* const below = new QHBoxLayout;
  for (QToolButton* const each : {play_, previous_, next_}) below->addWidget(each);
  below->addWidget(close, 1);
  auto* const layout = new QVBoxLayout(this);
  layout->addLayout(row, 1);
  layout->addLayout(below);
  list_->setCurrentRow(0);
  play_->setChecked(motion == Motion::Moving);
  setPlaying(play_->isChecked());
}

QToolButton* HowToRecordDialog::makeStep(int by, const QString& text, const QString& icon_name) {
  auto* const made = new QToolButton(this);
  made->setObjectName(by < 0 ? "previous_motion" : "next_motion");
  made->setText(text);
  made->setIcon(icon(icon_name));
  made->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  made->setToolTip(by < 0 ? tr("Shows the previous motion") : tr("Shows the next motion"));
  connect(made, &QToolButton::clicked, this, [this, by] { list_->setCurrentRow(list_->currentRow() + by); });
  return made;
}

void HowToRecordDialog::showMotion(const QString& name) {
  const std::vector<ShownMotion>& all = shownMotions();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == name) list_->setCurrentRow(static_cast<int>(i));
}

void HowToRecordDialog::choose(int row) {
  if (row < 0) return;
  const ShownMotion& motion = shownMotions()[static_cast<std::size_t>(row)];
  picture_->setMotion(motion);
  words_->setText(motion.words);
  previous_->setEnabled(row > 0);
  next_->setEnabled(row + 1 < list_->count());
}

void HowToRecordDialog::setPlaying(bool playing) {
  picture_->setPlaying(playing);
  play_->setText(playing ? tr("Pause") : tr("Play"));
  play_->setShortcut(Qt::Key_Space);  // setText() removes it
  play_->setIcon(icon(playing ? "pause" : "play"));
  play_->setToolTip(playing ? tr("Pauses the animation (Space)") : tr("Plays the animation (Space)"));
}

}  // namespace evical::ui
