// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/steps_panel.h"

#include "ui/window/step_row.h"

#include <QLabel>
#include <QScrollArea>
#include <QVBoxLayout>

#include <cmath>

namespace evical::ui {
namespace {

// As core names them (CalibrationObserver); others are added when they come.
const QStringList kInitialisationSteps = {"camera poses", "planar poses", "time offset",
                                          "camera-IMU rotation", "gravity and translation"};
// Only where a camera comes without intrinsics.
const QStringList kIntrinsicsStages = {"first look", "intrinsics"};
const char* const kStages[] = {"first look", "intrinsics", "detect",
                               "initialise", "optimise",   "cross_validate"};

QString capitalised(QString text) {
  if (!text.isEmpty()) text[0] = text[0].toUpper();
  return text;
}

QString windowCounts(const std::vector<BoardObservations>& cameras) {
  std::size_t views = 0, windows = 0;
  for (const BoardObservations& camera : cameras) {
    views += camera.views.size();
    windows += camera.windows.size();
  }
  return QObject::tr("board in %1 of %2 windows").arg(views).arg(windows);
}

// "left: 0.0060 s" gives "0.0060 s": room is scarce, and the tool tip says all of it.
QString withoutSensor(const QString& text) {
  const qsizetype colon = text.indexOf(": ");
  return colon < 0 ? text : text.mid(colon + 2);
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
  stage_.clear();
  stage_begin_s_ = elapsed_s_ = 0.0;
  addRow("detect", tr("Read and detect"), false);
  addRow("initialise", tr("Initialise"), false);
  for (const QString& step : kInitialisationSteps) addRow(step, capitalised(step), true);
  addRow("optimise", tr("Optimise"), false);
  addRow("cross_validate", tr("Compare halves"), false);
}

StepRow* StepsPanel::addRow(const QString& key, const QString& title, bool sub_step) {
  auto* const added = new StepRow(title, sub_step, this);
  int place = layout_->count() - 1;  // before the stretch
  // Steps that nobody announced come at the end of their stage.
  const QString next = key.startsWith("stage ") ? "cross_validate" : "optimise";
  if (sub_step && rows_.count(next) > 0) place = layout_->indexOf(rows_.at(next));
  if (kIntrinsicsStages.contains(key)) place = layout_->indexOf(rows_.at("detect"));
  layout_->insertWidget(place, added);
  rows_[key] = added;
  return added;
}

StepRow* StepsPanel::row(const QString& key) {
  const auto found = rows_.find(key);
  return found == rows_.end() ? nullptr : found->second;
}

void StepsPanel::startStage(const QString& stage) {
  if (kIntrinsicsStages.contains(stage) && row(stage) == nullptr) addRow(stage, capitalised(stage), false);
  for (const char* const known : kStages) {
    if (stage == known) break;
    if (StepRow* const before = row(known); before != nullptr && before->state() == StepState::Running)
      before->setState(StepState::Done);
  }
  stage_ = stage;
  stage_begin_s_ = elapsed_s_;
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
  now->setTime(elapsed_s_ - stage_begin_s_);
}

void StepsPanel::setDetections(const LiveDetections& detections) {
  row("detect")->setKeyNumber(windowCounts(detections));
}

void StepsPanel::addInitialisationNote(const InitialisationNote& note) {
  StepRow* step = row(note.step);
  if (step == nullptr) step = addRow(note.step, capitalised(note.step), true);
  step->setState(StepState::Done);
  step->setKeyNumber(withoutSensor(note.result), note.result);
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
    if (step == nullptr) step = addRow(key, capitalised(key), true);
    step->setState(stage == stages.rbegin()->first ? StepState::Running : StepState::Done);
    step->setKeyNumber(costText(numbers.first, numbers.second));
  }
}

void StepsPanel::finish(JobOutcome outcome) {
  for (const auto& [key, step] : rows_) {
    if (step->state() != StepState::Running) continue;
    step->setState(outcome == JobOutcome::Done        ? StepState::Done
                   : outcome == JobOutcome::Cancelled ? StepState::Cancelled
                                                      : StepState::Failed);
  }
}

// Those that this kind of rig does not need.
void StepsPanel::dropUnusedSteps() {
  for (const QString& step : kInitialisationSteps) {
    const auto found = rows_.find(step);
    if (found == rows_.end() || found->second->state() != StepState::Pending) continue;
    delete found->second;
    rows_.erase(found);
  }
}

void StepsPanel::setRun(const CalibrationRun& run) {
  dropUnusedSteps();
  const CalibrationResult& result = run.result;
  row("detect")->setKeyNumber(windowCounts(run.pass.cameras));
  row("detect")->setTime(std::max(result.timing.read_s, result.timing.detect_s));
  row("initialise")->setTime(result.timing.initialise_s);
  row("optimise")->setTime(result.timing.optimise_s);
  QStringList reprojections;
  for (const CameraFit& camera : result.cameras)
    reprojections << tr("%1 px").arg(camera.reprojection_rms_px, 0, 'g', 3);
  row("optimise")->setKeyNumber(tr("reprojection %1").arg(reprojections.join(", ")));
  row("cross_validate")->setTime(result.timing.cross_validate_s);
  if (!result.cross_validation) {
    row("cross_validate")->setKeyNumber(tr("not asked for"));
  } else if (result.cross_validation->failure.empty()) {
    row("cross_validate")
        ->setKeyNumber(tr("they differ by %1 sigmas").arg(result.cross_validation->rms_sigmas, 0, 'f', 2));
  } else {
    row("cross_validate")->setKeyNumber(QString::fromStdString(result.cross_validation->failure));
  }
}

QString StepsPanel::textOf(const QString& step) const {
  const auto found = rows_.find(step);
  return found == rows_.end() ? QString() : found->second->text();
}

}  // namespace evical::ui
