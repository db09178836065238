// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/check_card.h"

#include "ui/forms/form_words.h"
#include "ui/screens/verdict_labels.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPainter>
#include <QPolygonF>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <vector>

namespace evical::ui {
namespace {

// A rig with one camera and one IMU needs no names.
bool hasSeveralSensors(const RecordingAssessment& assessment) {
  const auto count = [&](AssessedThing thing) {
    return std::count_if(assessment.all.begin(), assessment.all.end(),
                         [&](const Assessed& one) { return one.thing == thing; });
  };
  return count(AssessedThing::Board) > 1 || count(AssessedThing::Turns) > 1;
}

// Good criteria, of those that the person who records can influence.
QString goodParts(const RecordingAssessment& assessment) {
  QStringList good;
  for (const Assessed& one : assessment.all)
    if (one.light == Light::Good && isOfRecording(one.thing) && !good.contains(titleOf(one.thing)))
      good << titleOf(one.thing);
  return good.isEmpty() ? QString() : QObject::tr("Good: %1.").arg(good.join(", ").toLower());
}

constexpr int kCardWords_px = 46,
              kCardDetails_px = 170;  // a line with a button and one of advice; eight checks

void keepPlace(QWidget& widget) {
  QSizePolicy policy = widget.sizePolicy();
  policy.setRetainSizeWhenHidden(true);
  widget.setSizePolicy(policy);
}

// Has a fixed height, and scrolls: longer texts must not move the page.
QScrollArea* fixedArea(QWidget* content, int height_px, QWidget* parent) {
  auto* const area = new QScrollArea(parent);
  area->setWidget(content);
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setFixedHeight(height_px);
  area->viewport()->setAutoFillBackground(false);
  content->setAutoFillBackground(false);
  return area;
}

}  // namespace

CheckCard::CheckCard(QWidget* parent)
    : QFrame(parent),
      mark_(new LightMark(this)),
      summary_(wrappedLabel({}, "heading", this)),
      advice_(wrappedLabel({}, "hint", this)),
      good_(wrappedLabel({}, "hint", this)),
      board_(wrappedLabel({}, "hint", this)),
      missing_(wrappedLabel({}, "problem", this)),
      progress_(new QProgressBar(this)),
      more_(new QToolButton(this)),
      lights_(new QWidget),
      grid_(new QGridLayout(lights_)) {
  setProperty("card", "true");
  setObjectName("check_card");
  summary_->setObjectName("check_summary");
  advice_->setObjectName("check_advice");
  board_line_ = makeBoardLine();
  follow_line_ = makeFollowLine();
  more_->setCheckable(true);
  more_->setObjectName("check_details");
  connect(more_, &QToolButton::toggled, this, &CheckCard::showDetails);
  auto* const how = new QToolButton(this);
  how->setText(tr("How to record..."));
  how->setObjectName("how_to_record");
  how->setToolTip(tr("Animations of the motions that a calibration needs"));
  connect(how, &QToolButton::clicked, this, &CheckCard::howToRecordRequested);
  progress_->setRange(0, 1000);
  progress_->setTextVisible(false);
  progress_->setFixedWidth(160);
  progress_->setAccessibleName(tr("Progress of the check"));
  auto* const line = new QHBoxLayout;
  line->addWidget(mark_);
  line->addWidget(summary_, 1);
  for (QWidget* const widget :
       {static_cast<QWidget*>(progress_), static_cast<QWidget*>(how), static_cast<QWidget*>(more_)})
    line->addWidget(widget);
  grid_->setHorizontalSpacing(12);
  grid_->setVerticalSpacing(5);
  grid_->setColumnStretch(3, 1);
  details_ = fixedArea(lights_, kCardDetails_px, this);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(14, 6, 10, 8);
  layout->setSpacing(4);
  layout->addLayout(line);
  layout->addWidget(makeWords());
  layout->addWidget(details_);
  grid_->setContentsMargins(0, 4, 0, 2);
  // The card has the same height in all states: a check that starts or ends must not move the page under the
  // mouse.
  for (QWidget* const kept : std::initializer_list<QWidget*>{mark_, progress_, more_}) keepPlace(*kept);
  setUnconfirmedBoard({});
  setMissing({});
  showDetails(false);
  clear();
}

QWidget* CheckCard::makeWords() {
  auto* const words = new QWidget;
  auto* const column = new QVBoxLayout(words);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  for (QWidget* const line : {static_cast<QWidget*>(missing_), follow_line_, board_line_,
                              static_cast<QWidget*>(advice_), static_cast<QWidget*>(good_)})
    column->addWidget(line);
  column->addStretch(1);
  return fixedArea(words, kCardWords_px, this);
}

QWidget* CheckCard::makeBoardLine() {
  auto* const line = new QWidget(this);
  auto* const confirm = new QPushButton(icon("check"), tr("Confirm board"), line);
  confirm->setObjectName("confirm_board");
  confirm->setToolTip(tr("Confirms that these numbers match the printed board"));
  connect(confirm, &QPushButton::clicked, this, &CheckCard::boardConfirmed);
  auto* const layout = new QHBoxLayout(line);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(board_, 1);
  layout->addWidget(confirm);
  return line;
}

QWidget* CheckCard::makeFollowLine() {
  auto* const line = new QWidget(this);
  follow_ = new QCheckBox(tr("&Follow while it is being written"), line);
  follow_->setObjectName("follow_recording");
  follow_->setToolTip(
      tr("Another program is writing this recording. It is checked repeatedly, and missing motions are\n"
         "listed here, until no data arrive for five seconds"));
  connect(follow_, &QCheckBox::toggled, this, &CheckCard::followingWanted);
  auto* const layout = new QHBoxLayout(line);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(wrappedLabel(tr("The recording is growing."), "hint", line));
  layout->addWidget(follow_);
  layout->addStretch(1);
  line->hide();
  return line;
}

void CheckCard::offerFollowing(bool offered) {
  follow_line_->setVisible(offered);
  showGood();
}

// Fills the line that nothing more important needs.
void CheckCard::showGood() {
  const bool free = missing_->isHidden() && follow_line_->isHidden() && board_line_->isHidden();
  good_->setVisible(assessed_ && free && !good_->text().isEmpty());
}

void CheckCard::setFollowing(bool following) {
  following_ = following;
  const QSignalBlocker quiet(follow_);
  follow_->setChecked(following);
}

void CheckCard::showState(const QString& summary, std::optional<Light> light) {
  idle_ = false;
  assessed_ = false;
  summary_->setText(summary);
  mark_->setVisible(light.has_value());
  if (light) mark_->setLight(*light);
  setAccessibleName(summary);
  progress_->hide();
  advice_->hide();
  showGood();
  showDetails(more_->isChecked());
}

void CheckCard::clear(const QString& summary, const QString& advice) {
  showState(summary.isEmpty() ? tr("Before you calibrate") : summary, std::nullopt);
  idle_ = true;
  advice_->setText(advice);
  advice_->setToolTip({});
  advice_->setVisible(!advice.isEmpty());
  // Then no check is due that would fill the details.
  if (!advice.isEmpty()) more_->setChecked(false);
}

void CheckCard::setMissing(const QString& text) {
  missing_->setText(text);
  missing_->setVisible(!text.isEmpty());
  showGood();
}

void CheckCard::setChecking(double fraction) {
  const bool keep = following_ && assessed_;
  if (!progress_->isVisibleTo(this) && !keep) showState(tr("Checking the recording..."), {});
  progress_->show();
  progress_->setValue(static_cast<int>(1000.0 * fraction));
}

void CheckCard::setWaiting() {
  showState(tr("The recording is checked after the current job"), {});
}

void CheckCard::setFailed(const QString& why) {
  if (following_) {
    showState(tr("Not enough data to check yet"), {});
    advice_->setText(tr("The check is repeated when more data arrive."));
    advice_->setToolTip(why);
    return advice_->show();
  }
  showState(tr("This recording cannot be calibrated"), Light::Poor);
  advice_->setText(sentence(why));
  advice_->show();
}

void CheckCard::setAssessment(const RecordingAssessment& assessment) {
  showState(following_ ? summaryWhileWritten(assessment) : summaryOf(assessment), assessment.light);
  assessed_ = true;
  showAdvice(assessment);
  good_->setText(goodParts(assessment));
  showGood();
  showLights(assessment);
  showDetails(more_->isChecked());
}

void CheckCard::showAdvice(const RecordingAssessment& assessment) {
  advice_->setToolTip({});
  if (following_) {
    const QString missing = stillMissing(assessment);
    advice_->setText(missing);
    return advice_->setVisible(!missing.isEmpty());
  }
  const std::vector<const Assessed*> sorted = worstFirst(assessment);
  const auto first =
      std::find_if(sorted.begin(), sorted.end(), [](const Assessed* one) { return !one->advice.empty(); });
  if (first == sorted.end()) return;
  const QString advice = sentence(QString::fromStdString((*first)->advice));
  advice_->setText((*first)->thing == AssessedThing::Obstacle
                       ? sentence(QString::fromStdString((*first)->measured)) + ' ' + advice
                       : advice);
  advice_->show();
}

void CheckCard::showLights(const RecordingAssessment& assessment) {
  while (QLayoutItem* const item = grid_->takeAt(0)) {
    delete item->widget();
    delete item;
  }
  const bool named = hasSeveralSensors(assessment);
  int row = 0;
  for (const Assessed& one : assessment.all) {
    auto* const mark = new LightMark(lights_);
    mark->setLight(one.light);
    const QString sensor = QString::fromStdString(one.sensor);
    const QString title = titleOf(one.thing);
    auto* const name =
        wrappedLabel(named && !sensor.isEmpty() ? tr("%1, %2").arg(title, sensor) : title, "", lights_);
    auto* const measured = wrappedLabel(inFormWords(QString::fromStdString(one.measured)), "", lights_);
    if (!one.required.empty())
      measured->setText(tr("%1, required %2").arg(measured->text(), QString::fromStdString(one.required)));
    auto* const advice = wrappedLabel(sentence(QString::fromStdString(one.advice)), "hint", lights_);
    name->setWordWrap(false);
    measured->setWordWrap(one.thing == AssessedThing::Obstacle);
    measured->setAccessibleName(tr("%1: %2, %3").arg(title, measured->text(), lightWord(one.light)));
    grid_->addWidget(mark, row, 0, Qt::AlignTop);
    grid_->addWidget(name, row, 1, Qt::AlignTop);
    grid_->addWidget(measured, row, 2, Qt::AlignTop);
    grid_->addWidget(advice, row, 3, Qt::AlignTop);
    ++row;
  }
}

// Between two checks the details keep their place, and the button that folds it.
void CheckCard::showDetails(bool shown) {
  more_->setVisible(assessed_ || shown);
  more_->setText(shown ? tr("Less") : tr("More"));
  more_->setIcon(icon(shown ? "up" : "down"));
  more_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  more_->setToolTip(shown ? tr("Hides the individual checks") : tr("Shows all checks with their lights"));
  details_->setVisible(shown);
  lights_->setVisible(assessed_);
}

void CheckCard::setUnconfirmedBoard(const QString& board) {
  board_->setText(tr("Board: %1, not confirmed. Compare these numbers with the print.").arg(board));
  board_line_->setVisible(!board.isEmpty());
  showGood();
}

QString CheckCard::text() const {
  QStringList lines;
  for (const QLabel* const each : findChildren<QLabel*>())
    if (each->isVisibleTo(this) && !each->text().isEmpty()) lines << each->text();
  return lines.join('\n');
}

QString lightWord(Light light) {
  return light == Light::Good   ? QObject::tr("good")
         : light == Light::Fair ? QObject::tr("fair")
                                : QObject::tr("poor");
}

LightMark::LightMark(QWidget* parent) : QWidget(parent) {
  setFixedSize(sizeHint());
  setLight(light_);
}

void LightMark::setLight(Light light) {
  light_ = light;
  setAccessibleName(lightWord(light));
  setToolTip(lightWord(light));
  update();
}

void LightMark::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  const QRectF box = QRectF(rect()).adjusted(1.0, 1.0, -1.0, -1.0);
  switch (light_) {
    case Light::Good:
      painter.setBrush(theme().good);
      painter.drawEllipse(box);
      return;
    case Light::Fair:
      painter.setBrush(theme().warning);
      painter.drawPolygon(QPolygonF{{box.center().x(), box.top()}, box.bottomRight(), box.bottomLeft()});
      return;
    case Light::Poor:
      painter.setBrush(theme().bad);
      painter.drawRect(box.adjusted(1.0, 1.0, -1.0, -1.0));
      return;
  }
}

}  // namespace evical::ui
