// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/start_screen.h"

#include "ui/screens/recording/aim_chooser.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QDir>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

constexpr int kColumn_px = 400, kHeading_px = 30, kRecent_px = 296;

QPushButton* choice(const QString& text, const QString& icon_name, QWidget* parent) {
  constexpr int kHeight_px = 44, kIcon_px = 22;
  auto* const button = new QPushButton(icon(icon_name), "  " + text, parent);
  button->setIconSize(QSize(kIcon_px, kIcon_px));
  button->setMinimumHeight(kHeight_px);
  button->setStyleSheet("text-align: left");
  return button;
}

}  // namespace

StartScreen::StartScreen(QWidget* parent)
    : QWidget(parent),
      recent_(new QListWidget(this)),
      no_recent_(wrappedLabel(tr("No recent files. Files that you open are listed here."), "hint", this)),
      demo_(choice(tr("Try the demo recording"), "demo", this)),
      demo_progress_(new QProgressBar(this)),
      aim_(new AimChooser(this)) {
  auto* const columns = new QHBoxLayout;
  columns->setSpacing(48);
  columns->addStretch();
  columns->addWidget(makeChoices());
  columns->addWidget(makeRecent(), 0, Qt::AlignTop);
  columns->addStretch();
  auto* const layout = new QVBoxLayout(this);
  layout->addStretch(1);
  layout->addLayout(columns);
  layout->addStretch(2);
  setRecentFiles({});
  setDemoRunning(false);
}

QWidget* StartScreen::makeChoices() {
  auto* const column = new QWidget(this);
  column->setFixedWidth(kColumn_px);
  auto* const layout = new QVBoxLayout(column);
  layout->setSpacing(10);
  layout->addWidget(wrappedLabel(tr("Evical"), "title", column));
  layout->addWidget(
      wrappedLabel(tr("Calibrates event cameras with IMUs: rotation, translation and time offset, each "
                      "with its uncertainty, from one recording of a printed circle grid. Also calibrates "
                      "single cameras."),
                   "hint", column));
  layout->addSpacing(6);
  layout->addWidget(aim_, 0, Qt::AlignLeft);
  layout->addSpacing(6);
  auto* const recording = choice(tr("Open a recording..."), "recording", column);
  recording->setToolTip(tr("A ROS bag, or a folder with events.txt and imu.txt"));
  auto* const session = choice(tr("Open a session..."), "open", column);
  session->setToolTip(tr("A session file that lists recording, board and sensors"));
  demo_->setToolTip(tr("Simulates a recording of ten seconds with a known truth, and opens it"));
  auto* const print_board = choice(tr("Print a board..."), "board", column);
  print_board->setObjectName("print_board_button");
  print_board->setToolTip(tr("A target of circles, squares or tags, to scale, for a printer or a screen"));
  auto* const how = choice(tr("How to record..."), "play", column);
  how->setToolTip(tr("Animations of the motions that a calibration needs"));
  auto* const before = new QHBoxLayout;
  before->addWidget(print_board);
  before->addWidget(how);
  layout->addLayout(before);
  for (QPushButton* const button : {recording, session, demo_}) layout->addWidget(button);
  demo_progress_->setRange(0, 1000);
  demo_progress_->setTextVisible(false);
  layout->addWidget(demo_progress_);
  layout->addSpacing(8);
  layout->addWidget(wrappedLabel(tr("Or drop a file anywhere in this window."), "hint", column));
  layout->addStretch();
  connect(recording, &QPushButton::clicked, this, &StartScreen::openRecordingRequested);
  connect(session, &QPushButton::clicked, this, &StartScreen::openSessionRequested);
  connect(demo_, &QPushButton::clicked, this, &StartScreen::demoRequested);
  connect(print_board, &QPushButton::clicked, this, &StartScreen::printBoardRequested);
  connect(how, &QPushButton::clicked, this, &StartScreen::howToRecordRequested);
  return column;
}

QWidget* StartScreen::makeRecent() {
  auto* const column = new QWidget(this);
  column->setFixedWidth(kColumn_px);
  auto* const layout = new QVBoxLayout(column);
  auto* const heading = wrappedLabel(tr("Recent"), "heading", column);
  heading->setMinimumHeight(kHeading_px);
  layout->addWidget(heading);
  layout->addWidget(no_recent_);
  layout->addWidget(recent_, 1);
  recent_->setMinimumHeight(kRecent_px);
  recent_->setAccessibleName(tr("Recent files"));
  recent_->setTextElideMode(Qt::ElideMiddle);
  recent_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  recent_->setToolTip(tr("Double-click or press Enter to open"));
  connect(recent_, &QListWidget::itemActivated, this,
          [this](QListWidgetItem* item) { emit fileChosen(item->data(Qt::UserRole).toString()); });
  return column;
}

void StartScreen::setRecentFiles(const QStringList& files) {
  recent_->clear();
  for (const QString& file : files) {
    const QFileInfo info(file);
    const QString shown = QDir::toNativeSeparators(file).replace(QDir::homePath(), "~");
    auto* const item =
        new QListWidgetItem(icon(info.suffix() == "yaml" ? "open" : "recording"), shown, recent_);
    item->setData(Qt::UserRole, file);
    item->setToolTip(file);
  }
  recent_->setVisible(!files.isEmpty());
  no_recent_->setVisible(files.isEmpty());
}

void StartScreen::setDemoRunning(bool running) {
  demo_->setEnabled(!running);
  demo_->setText("  " + (running ? tr("Simulating the demo recording...") : tr("Try the demo recording")));
  demo_progress_->setValue(0);
  QSizePolicy policy = demo_progress_->sizePolicy();
  policy.setRetainSizeWhenHidden(true);
  demo_progress_->setSizePolicy(policy);
  demo_progress_->setVisible(running);
}

void StartScreen::setDemoProgress(double fraction) {
  demo_progress_->setValue(static_cast<int>(1000.0 * fraction));
}

}  // namespace evical::ui
