// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/steps_panel.h"

#include "core/initialisation/initialise.h"
#include "ui/theme/theme.h"

#include <QEvent>
#include <QGridLayout>
#include <QLabel>
#include <QProgressBar>
#include <QScrollArea>
#include <QVBoxLayout>

#include <cmath>

namespace evical::ui {
namespace {

// Minimum time between changes of text: they trigger a layout of the panel, and faster ones are unreadable.
constexpr double kReadable_s = 0.25;

// Stages that only some runs have get their row when they start.
bool isInEveryRun(const StageRow& row) {
  return shareOf(row, RunStart::KnownIntrinsics) > 0.0;
}

QString capitalised(QString text) {
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text;
}

QString windowCounts(std::size_t views, std::size_t windows) {
  return QObject::tr("board found %1 of %2 times").arg(views).arg(windows);
}

// "pass 2" gives "Pass 2: detect, fit the lens".
QString passTitle(const QString& stage) {
  return QObject::tr("%1: detect, fit").arg(capitalised(stage));
}

QString costText(double cost, int iterations) {
  return QObject::tr("cost %1, %2 steps").arg(cost, 0, 'g', 5).arg(iterations);
}

}  // namespace

StepsPanel::StepsPanel(QWidget* parent) : QWidget(parent) {
  auto* const outer = new QVBoxLayout(this);
  outer->setContentsMargins(10, 8, 4, 4);
  auto* const heading = new QLabel(tr("Steps"), this);
  heading->setProperty("role", "heading");
  outer->addWidget(heading);
  auto* const scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* const content = new QWidget(scroll);
  layout_ = new QVBoxLayout(content);
  layout_->setContentsMargins(0, 0, 6, 0);
  layout_->setSpacing(5);
  layout_->addStretch();
  scroll->setWidget(content);
  outer->addWidget(scroll);
  reset();
}

void StepsPanel::reset() {
  for (const auto& [key, old] : rows_) delete old;
  rows_.clear();
  sub_steps_shown_ = false;
  stage_.clear();
  stage_begin_s_ = elapsed_s_ = 0.0;
  counted_s_ = timed_s_ = -1.0;
  addStages();
}

void StepsPanel::setAim(CalibrationAim aim) {
  if (aim == aim_) return;
  aim_ = aim;
  reset();
}

void StepsPanel::addStages() {
  if (aim_ == CalibrationAim::Camera) {
    addRow(nameOf(CalibrationStage::FirstLook), tr(rowOf(CalibrationStage::FirstLook).title));
    addRow(IntrinsicsJob::passName(1), passTitle(IntrinsicsJob::passName(1)));
    return;
  }
  for (const StageRow& stage : kCalibrationStages) {
    if (!isInEveryRun(stage)) continue;
    addRow(stage.name, tr(stage.title));
    if (stage.stage != CalibrationStage::Initialise) continue;
    // Rows for others are added when they start.
    for (const char* const step : kUsualSteps) addRow(step, capitalised(step), stage.stage);
  }
}

StepRow* StepsPanel::addRow(const QString& key, const QString& title,
                            std::optional<CalibrationStage> step_of) {
  auto* const added = new StepRow(title, step_of.has_value(), this);
  StepRow* const next = rowAfter(key, step_of);
  layout_->insertWidget(next ? layout_->indexOf(next) : layout_->count() - 1, added);  // before the stretch
  rows_[key] = added;
  added->setVisible(!added->isSubStep() || sub_steps_shown_);
  return added;
}

void StepsPanel::showSubSteps(bool shown) {
  sub_steps_shown_ = shown;
  for (const auto& [key, row] : rows_) row->setVisible(!row->isSubStep() || shown);
}

// Unknown steps are added at the end of their stage.
StepRow* StepsPanel::rowAfter(const QString& key, std::optional<CalibrationStage> step_of) {
  bool passed = false;
  for (const StageRow& stage : kCalibrationStages) {
    if (StepRow* const candidate = passed ? row(stage.name) : nullptr) return candidate;
    if (step_of ? stage.stage == *step_of : key == stage.name) passed = true;
  }
  return nullptr;
}

StepRow* StepsPanel::row(CalibrationStage stage) {
  return row(QString(nameOf(stage)));
}

StepRow* StepsPanel::row(const QString& key) {
  const auto found = rows_.find(key);
  return found == rows_.end() ? nullptr : found->second;
}

// Each pass gets its row at its start, since the number of passes is unknown. Frames need no first look.
void StepsPanel::startPass(const QString& stage) {
  for (const auto& [key, step] : rows_)
    if (step->state() == StepState::Running) step->setState(StepState::Done);
  StepRow* const first_look = row(CalibrationStage::FirstLook);
  if (stage == IntrinsicsJob::passName(1) && first_look && first_look->state() == StepState::Pending) {
    delete first_look;
    rows_.erase(nameOf(CalibrationStage::FirstLook));
  }
  if (row(stage) == nullptr) addRow(stage, passTitle(stage));
}

void StepsPanel::startStage(const QString& stage) {
  if (aim_ == CalibrationAim::Camera) startPass(stage);
  for (const StageRow& known : kCalibrationStages) {
    if (aim_ == CalibrationAim::Camera) break;
    if (stage == known.name) {
      if (row(stage) == nullptr) addRow(stage, tr(known.title));
      break;
    }
    // Also one that did not run: the detections of the check are reused.
    if (StepRow* const before = row(known.name)) before->setState(StepState::Done);
  }
  stage_ = stage;
  stage_begin_s_ = elapsed_s_;
  showSubSteps(true);
  if (StepRow* const now = row(stage)) {
    now->setState(StepState::Running);
    now->setFraction(0.0);
  }
}

void StepsPanel::setProgress(const JobProgress& progress) {
  elapsed_s_ = progress.elapsed_s;
  if (progress.stage != stage_) return;
  StepRow* const now = row(stage_);
  if (now == nullptr) return;
  now->setFraction(progress.stage_fraction);
  if (elapsed_s_ >= timed_s_ && elapsed_s_ < timed_s_ + kReadable_s && progress.stage_fraction < 1.0) return;
  timed_s_ = elapsed_s_;
  now->setTime(elapsed_s_ - stage_begin_s_);
}

void StepsPanel::setDetections(const LiveDetections& detections) {
  if (elapsed_s_ >= counted_s_ && elapsed_s_ < counted_s_ + kReadable_s) return;
  counted_s_ = elapsed_s_;
  StepRow* const step = aim_ == CalibrationAim::Camera ? row(stage_) : row(CalibrationStage::Detect);
  std::size_t views = 0, windows = 0;
  for (const LiveCamera& camera : detections) {
    views += camera.views.size();
    windows += camera.windows;
  }
  if (step != nullptr) step->setKeyNumber(windowCounts(views, windows));
}

void StepsPanel::addInitialisationNote(const InitialisationNote& note) {
  StepRow* step = row(note.step);
  if (step == nullptr) step = addRow(note.step, capitalised(note.step), CalibrationStage::Initialise);
  step->setState(StepState::Done);
  // Space is limited: only the tool tip names the sensor.
  step->setKeyNumber(note.result, note.subject.isEmpty() ? note.result : note.subject + ": " + note.result);
  step->setTime(note.duration_s);
}

void StepsPanel::setIterations(const LiveIterations& iterations) {
  std::map<int, std::pair<double, int>> stages;  // cost, iterations
  for (const IterationRecord& record : iterations.records) {
    auto& [cost, count] = stages[record.stage];
    cost = record.cost;
    ++count;
  }
  for (const auto& [stage, numbers] : stages) {
    const QString key = QString("stage %1").arg(stage);
    StepRow* step = row(key);
    if (step == nullptr) step = addRow(key, capitalised(key), CalibrationStage::Optimise);
    step->setState(stage == stages.rbegin()->first ? StepState::Running : StepState::Done);
    step->setKeyNumber(costText(numbers.first, numbers.second));
  }
}

void StepsPanel::setPass(const LensPass& pass) {
  StepRow* const step = row(IntrinsicsJob::passName(pass.number));
  if (step == nullptr) return;
  step->setState(StepState::Done);
  step->setKeyNumber(pass.moved_px > 0.0
                         ? tr("%1 views, moved %2 px").arg(pass.views).arg(pass.moved_px, 0, 'g', 2)
                         : tr("%1 views").arg(pass.views),
                     tr("%1 views, reprojection error %2 px RMS, change of the lens %3 px")
                         .arg(pass.views)
                         .arg(pass.reprojection_rms_px, 0, 'g', 2)
                         .arg(pass.moved_px, 0, 'g', 2));
}

void StepsPanel::finish(JobOutcome outcome) {
  for (const auto& [key, step] : rows_) {
    if (step->state() != StepState::Running) continue;
    step->setState(outcome == JobOutcome::Done        ? StepState::Done
                   : outcome == JobOutcome::Cancelled ? StepState::Cancelled
                                                      : StepState::Failed);
  }
  if (outcome == JobOutcome::Done) showSubSteps(false);
}

// Removes steps that this kind of rig does not need.
void StepsPanel::dropUnusedSteps() {
  for (const char* const step : kUsualSteps) {
    const auto found = rows_.find(step);
    if (found == rows_.end() || found->second->state() != StepState::Pending) continue;
    delete found->second;
    rows_.erase(found);
  }
}

void StepsPanel::setRun(const CalibrationRun& run) {
  dropUnusedSteps();
  const CalibrationResult& result = run.result;
  for (const StageRow& stage : kCalibrationStages) {
    if (stage.duration_s == nullptr) continue;
    row(stage.stage)->setTime(result.timing.*stage.duration_s);
    // Also for runs that were opened from a folder.
    if (stage.stage != CalibrationStage::CompareHalves || result.split_half_check)
      row(stage.stage)->setState(StepState::Done);
  }
  StepRow* const detect = row(CalibrationStage::Detect);
  std::size_t views = 0, windows = 0;
  for (const BoardObservations& camera : run.detections.cameras) {
    views += camera.views.size();
    windows += camera.windows.size();
  }
  detect->setKeyNumber(windowCounts(views, windows));
  detect->setTime(std::max(result.timing.read_s, result.timing.detect_s));
  QStringList reprojections;
  for (const CameraFit& camera : result.cameras)
    reprojections << tr("%1 px").arg(camera.reprojection_rms_px, 0, 'g', 3);
  row(CalibrationStage::Optimise)->setKeyNumber(tr("reprojection %1").arg(reprojections.join(", ")));
  StepRow* const halves = row(CalibrationStage::CompareHalves);
  if (!result.split_half_check) {
    halves->setKeyNumber(tr("not requested"));
  } else if (result.split_half_check->failure.empty()) {
    halves->setKeyNumber(tr("difference of %1 sigmas").arg(result.split_half_check->rms_sigmas, 0, 'f', 2));
  } else {
    halves->setKeyNumber(QString::fromStdString(result.split_half_check->failure));
  }
}

QString StepsPanel::textOf(const QString& step) const {
  const auto found = rows_.find(step);
  return found == rows_.end() ? QString() : found->second->text();
}

namespace {

QString stateWord(StepState state) {
  switch (state) {
    case StepState::Pending:
      return QObject::tr("waiting");
    case StepState::Running:
      return QObject::tr("running");
    case StepState::Done:
      return QObject::tr("done");
    case StepState::Failed:
      return QObject::tr("failed");
    case StepState::Cancelled:
      return QObject::tr("cancelled");
  }
  return {};
}

QIcon stateIcon(StepState state) {
  const Theme& t = theme();
  switch (state) {
    case StepState::Pending:
      return icon("pending", t.faint_text);
    case StepState::Running:
      return icon("running", t.accent);
    case StepState::Done:
      return icon("done", t.good);
    case StepState::Failed:
      return icon("error", t.bad);
    case StepState::Cancelled:
      return icon("ignore", t.warning);
  }
  return {};
}

QLabel* smallLabel(QWidget* parent) {
  auto* const label = new QLabel(parent);
  label->setProperty("role", "hint");
  QFont font = label->font();
  font.setPointSizeF(0.9 * font.pointSizeF());
  label->setFont(font);
  return label;
}

}  // namespace

StepRow::StepRow(const QString& title, bool sub_step, QWidget* parent)
    : QWidget(parent),
      sub_step_(sub_step),
      icon_(new QLabel(this)),
      title_(sub_step ? smallLabel(this) : new QLabel(this)),
      time_(smallLabel(this)),
      key_(smallLabel(this)),
      bar_(new QProgressBar(this)) {
  constexpr int kIndent_px = 22, kBar_px = 4;
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(sub_step ? kIndent_px : 0, 0, 0, 0);
  grid->setHorizontalSpacing(6);
  grid->setVerticalSpacing(1);
  grid->setColumnStretch(1, 1);
  grid->addWidget(icon_, 0, 0);
  grid->addWidget(title_, 0, 1);
  grid->addWidget(time_, 0, 2);
  grid->addWidget(key_, 1, 1, 1, 2);
  grid->addWidget(bar_, 2, 1, 1, 2);
  title_->setText(title);
  bar_->setRange(0, 1000);
  bar_->setTextVisible(false);
  bar_->setFixedHeight(kBar_px);
  key_->setWordWrap(true);
  key_->hide();
  showState();
}

void StepRow::setState(StepState state) {
  state_ = state;
  showState();
}

void StepRow::showState() {
  const int size = sub_step_ ? 13 : 17;
  icon_->setPixmap(stateIcon(state_).pixmap(QSize(size, size), devicePixelRatioF()));
  bar_->setVisible(state_ == StepState::Running && !sub_step_);
  setAccessibleName(text());
  setToolTip(text());
}

void StepRow::setFraction(double fraction) {
  bar_->setValue(static_cast<int>(1000.0 * fraction));
}

void StepRow::setTime(double time_s) {
  time_->setText(time_s < 0.0 ? QString() : tr("%1 s").arg(time_s, 0, 'f', time_s < 10.0 ? 2 : 1));
}

void StepRow::setKeyNumber(const QString& text, const QString& in_full) {
  const QString full = in_full.isEmpty() ? text : in_full;
  if (text == key_->text() && full == key_in_full_) return;
  key_in_full_ = full;
  key_->setVisible(!text.isEmpty());
  key_->setText(text);
  showState();
}

QString StepRow::text() const {
  QString text = title_->text() + ": " + stateWord(state_);
  if (!time_->text().isEmpty()) text += ", " + time_->text();
  if (!key_in_full_.isEmpty()) text += ", " + key_in_full_;
  return text;
}

void StepRow::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) showState();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
