// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/start_screen.h"

#include "core/geometry/board.h"
#include "core/report/result_yaml.h"
#include "ui/screens/recording/motion_picture.h"
#include "ui/screens/verdict_labels.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QDir>
#include <QEvent>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLocale>
#include <QPainter>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <vector>

namespace evical::ui {
namespace {

constexpr int kWidest_px = 1080, kDemo_px = 300;
constexpr int kMinPicture_px = 20, kPicture_px = 170;  // smaller if docks need the height

QPushButton* choice(const QString& text, const QString& icon_name, QWidget* parent) {
  auto* const button = new QPushButton(icon(icon_name), " " + text, parent);
  constexpr int kHeight_px = 36;
  button->setMinimumHeight(kHeight_px);
  return button;
}

// A card with picture, title, explanation and buttons.
QFrame* stepCard(QWidget* picture, const QString& title, const QString& text,
                 const QList<QPushButton*>& buttons) {
  auto* const card = new QFrame;
  card->setProperty("card", true);
  auto* const layout = new QVBoxLayout(card);
  layout->setContentsMargins(14, 14, 14, 14);
  picture->setMinimumHeight(kMinPicture_px);
  picture->setMaximumHeight(kPicture_px);
  layout->addWidget(picture);
  layout->addWidget(wrappedLabel(title, "heading", card));
  layout->addWidget(wrappedLabel(text, "hint", card));
  layout->addStretch();
  for (QPushButton* const button : buttons) layout->addWidget(button);
  return card;
}

// Name by which people know a file: that of its folder if its own is the same for all.
QString nameOf(const QFileInfo& file) {
  const QString own = file.completeBaseName();
  if (own != "session" && own != "result" && own != "recording") return file.fileName();
  const QFileInfo folder(file.absolutePath());
  const QFileInfo above(folder.absolutePath());
  return above.suffix() == "runs" ? above.completeBaseName() + " " + folder.fileName() : folder.fileName();
}

}  // namespace

StartScreen::StartScreen(QWidget* parent)
    : QWidget(parent),
      recent_(new QTreeWidget(this)),
      no_recent_(wrappedLabel(tr("Files that you open are listed here."), "hint", this)),
      demo_(choice(tr("Try the demo recording"), "demo", this)),
      demo_progress_(new QProgressBar(this)) {
  auto* const below = new QHBoxLayout;
  below->setSpacing(24);
  below->addWidget(makeRecent(), 1);
  below->addWidget(makeDemo());
  auto* const column = new QWidget(this);
  column->setMaximumWidth(kWidest_px);
  auto* const content = new QVBoxLayout(column);
  content->setContentsMargins(16, 8, 16, 8);
  content->setSpacing(12);
  content->addWidget(wrappedLabel(tr("Evical"), "title", column));
  content->addWidget(wrappedLabel(
      tr("Calibrates event cameras with IMUs: rotation, translation and time offset, each with its "
         "uncertainty, from one recording of a printed board. Also single cameras."),
      "hint", column));
  content->addWidget(makeSteps());
  content->addLayout(below, 1);
  auto* const layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addStretch();
  layout->addWidget(column, 1000);
  layout->addStretch();
  setRecentFiles({});
  setDemoRunning(false);
}

QWidget* StartScreen::makeSteps() {
  auto* const steps = new QWidget(this);
  auto* const print_board = choice(tr("Print a board..."), "board", steps);
  print_board->setObjectName("print_board_button");
  print_board->setToolTip(tr("A target of circles, squares or tags, to scale, for a printer or a screen"));
  auto* const how = choice(tr("How to record..."), "play", steps);
  how->setToolTip(tr("Animations of the motions that a calibration needs"));
  auto* const recording = choice(tr("Open a recording..."), "recording", steps);
  recording->setProperty("primary", true);
  recording->setIcon(icon("recording", QPalette::HighlightedText));
  recording->setToolTip(
      tr("A ROS bag, RAW, AEDAT, HDF5 or CSV file, or a folder with events.txt and imu.txt"));
  auto* const motion = new MotionPicture(steps);
  motion->setSceneOnly(true);
  motion->setMotion(shownMotions().back());
  motion->setPlaying(desktopAnimates());
  auto* const layout = new QHBoxLayout(steps);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(16);
  layout->addWidget(stepCard(new StartPicture(StartPicture::Shows::Sheet, steps), tr("1. Print a board"),
                             tr("Print it to scale, and glue it onto something flat."), {print_board}),
                    1);
  layout->addWidget(
      stepCard(motion, tr("2. Record 30 s"),
               tr("Move camera and IMU together in front of the board, in all directions."), {how}),
      1);
  layout->addWidget(
      stepCard(new StartPicture(StartPicture::Shows::Events, steps), tr("3. Open the recording"),
               tr("Then press Calibrate. You can also drop a file anywhere on this program."), {recording}),
      1);
  connect(recording, &QPushButton::clicked, this, &StartScreen::openRecordingRequested);
  connect(print_board, &QPushButton::clicked, this, &StartScreen::printBoardRequested);
  connect(how, &QPushButton::clicked, this, &StartScreen::howToRecordRequested);
  return steps;
}

QWidget* StartScreen::makeDemo() {
  auto* const column = new QWidget(this);
  column->setFixedWidth(kDemo_px);
  auto* const layout = new QVBoxLayout(column);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* const session = choice(tr("Open a session or a result..."), "open", column);
  session->setToolTip(tr("A session file lists recording, board and sensors"));
  demo_->setToolTip(tr("A recording of ten seconds with a known truth"));
  layout->addWidget(wrappedLabel(tr("Other ways to begin"), "heading", column));
  layout->addWidget(session);
  layout->addWidget(demo_);
  layout->addWidget(demo_progress_);
  layout->addWidget(wrappedLabel(tr("The demo is simulated once, which takes about 15 s."), "hint", column));
  layout->addStretch();
  demo_progress_->setRange(0, 1000);
  demo_progress_->setTextVisible(false);
  connect(session, &QPushButton::clicked, this, &StartScreen::openSessionRequested);
  connect(demo_, &QPushButton::clicked, this, &StartScreen::demoRequested);
  return column;
}

QWidget* StartScreen::makeRecent() {
  auto* const column = new QWidget(this);
  auto* const layout = new QVBoxLayout(column);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(wrappedLabel(tr("Recent"), "heading", column));
  layout->addWidget(no_recent_);
  layout->addWidget(recent_, 1);
  layout->addStretch();
  recent_->setObjectName("recent");
  recent_->setAccessibleName(tr("Recent files"));
  recent_->setHeaderLabels({tr("Name"), tr("Opened"), tr("Result")});
  recent_->setRootIsDecorated(false);
  recent_->header()->setStretchLastSection(false);
  recent_->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  recent_->header()->setSectionResizeMode(0, QHeaderView::Stretch);
  connect(recent_, &QTreeWidget::itemActivated, this,
          [this](const QTreeWidgetItem* item) { emit fileChosen(item->data(0, Qt::UserRole).toString()); });
  return column;
}

void StartScreen::setRecentFiles(const QList<RecentFile>& files) {
  files_ = files;
  fillRecent();
  recent_->setVisible(!files.isEmpty());
  no_recent_->setVisible(files.isEmpty());
}

void StartScreen::fillRecent() {
  recent_->clear();
  for (const RecentFile& file : files_) {
    const QFileInfo info(file.path);
    auto* const item = new QTreeWidgetItem(recent_);
    item->setIcon(0, icon(info.suffix() == "yaml" ? "open" : "recording"));
    item->setText(0, nameOf(info));
    item->setText(1, QLocale().toString(file.opened, "d MMM yyyy, HH:mm"));
    if (file.verdict) item->setIcon(2, verdictIcon(*file.verdict));
    item->setText(2, file.verdict ? tr(statusName(*file.verdict)) : tr("not calibrated"));
    item->setData(0, Qt::UserRole, file.path);
    item->setToolTip(0,
                     tr("%1\nDouble-click or press Enter to open").arg(QDir::toNativeSeparators(file.path)));
  }
}

void StartScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) fillRecent();
  QWidget::changeEvent(event);
}

void StartScreen::setDemoRunning(bool running) {
  demo_->setEnabled(!running);
  demo_->setText(" " + (running ? tr("Simulating the demo recording...") : tr("Try the demo recording")));
  demo_progress_->setValue(0);
  QSizePolicy policy = demo_progress_->sizePolicy();
  policy.setRetainSizeWhenHidden(true);
  demo_progress_->setSizePolicy(policy);
  demo_progress_->setVisible(running);
}

void StartScreen::setDemoProgress(double fraction) {
  demo_progress_->setValue(static_cast<int>(1000.0 * fraction));
}

namespace {

// Centres of the board's circles, with the board's middle at the origin.
std::vector<QPointF> circles(const Board& board) {
  std::vector<QPointF> centres;
  for (const Eigen::Vector2d& centre_m : boardPoints_m(board)) {
    const Eigen::Vector2d from_middle_m = centre_m - 0.5 * board.extent_m();
    centres.emplace_back(from_middle_m.x(), from_middle_m.y());
  }
  return centres;
}

void paintSheet(QPainter& painter, const Board& board, double px_per_m) {
  const Eigen::Vector2d half_m = 0.5 * board.extent_m().array() + 1.6 * board.radius_m;
  painter.setPen(QPen(theme().grid_line, 1.5));
  painter.setBrush(Qt::white);
  painter.drawRect(QRectF(-half_m.x() * px_per_m, -half_m.y() * px_per_m, 2.0 * half_m.x() * px_per_m,
                          2.0 * half_m.y() * px_per_m));
  painter.setPen(Qt::NoPen);
  painter.setBrush(Qt::black);
  for (const QPointF& centre : circles(board))
    painter.drawEllipse(px_per_m * centre, px_per_m * board.radius_m, px_per_m * board.radius_m);
}

// A circle that moves gives events of one polarity ahead and of the other one behind.
void paintEvents(QPainter& painter, const Board& board, double px_per_m) {
  constexpr int kQuarter = 90 * 16;  // Qt's unit of angles is 1/16 degree
  for (const QPointF& centre : circles(board)) {
    QRectF circle(0.0, 0.0, 2.0 * px_per_m * board.radius_m, 2.0 * px_per_m * board.radius_m);
    circle.moveCenter(px_per_m * centre);
    for (const bool ahead : {true, false}) {
      painter.setPen(QPen(ahead ? theme().darker : theme().brighter, 3.0, Qt::DotLine));
      painter.drawArc(circle, (ahead ? -1 : 1) * kQuarter + kQuarter / 8, 2 * kQuarter - kQuarter / 4);
    }
  }
}

}  // namespace

void StartPicture::paintEvent(QPaintEvent*) {
  Board board;
  board.rows = 7;
  board.spacing_m = 0.03;
  board.radius_m = 0.011;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const Eigen::Vector2d size_m = board.extent_m().array() + 4.0 * board.radius_m;
  painter.translate(rect().center());
  if (shows_ == Shows::Events) painter.rotate(-18.0);
  const double filled = shows_ == Shows::Sheet ? 0.9 : 0.75;  // the rotated board is higher
  const double px_per_m = filled * std::min(width() / size_m.x(), height() / size_m.y());
  shows_ == Shows::Sheet ? paintSheet(painter, board, px_per_m) : paintEvents(painter, board, px_per_m);
}

}  // namespace evical::ui
