// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/convergence_screen.h"

#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "ui/plots/chart_saving.h"
#include "ui/plots/empty_note.h"
#include "ui/plots/plot_panel.h"
#include "ui/theme/plain_labels.h"

#include <QComboBox>
#include <QCoreApplication>
#include <QGridLayout>
#include <QLabel>
#include <QStackedLayout>
#include <QStringList>
#include <QTimer>
#include <QToolButton>

#include <algorithm>
#include <array>
#include <limits>

namespace evical::ui {
namespace {

constexpr double kMillimetresPerMetre = 1e3, kMillisecondsPerSecond = 1e3;
constexpr PlotColour kAxisColours[] = {PlotColour::X, PlotColour::Y, PlotColour::Z};
const QString kAxisNames[] = {"x", "y", "z"};
constexpr double kDot_px = 5.0;
const char* const kUnits[] = {"deg", "mm", "ms"};

std::size_t lastStageBegin(const std::vector<IterationRecord>& iterations) {
  std::size_t begin = iterations.size() - 1;
  while (begin > 0 && iterations[begin - 1].stage == iterations.back().stage) --begin;
  return begin;
}

}  // namespace

ConvergenceScreen::ConvergenceScreen(QWidget* parent) : QWidget(parent), redraw_(new QTimer(this)) {
  redraw_->setSingleShot(true);
  redraw_->setInterval(0);
  connect(redraw_, &QTimer::timeout, this, &ConvergenceScreen::draw);
  stack_ = stackWithNote(*this, makeContent(), noRunNote(false));
}

QWidget* ConvergenceScreen::makeBar() {
  auto* const bar = new QWidget;
  auto* const layout = new QHBoxLayout(bar);
  layout->setContentsMargins(2, 0, 2, 0);
  camera_ = new QComboBox;
  camera_->setToolTip(tr("Camera whose rotation, translation and time offset are shown"));
  relative_ = new QComboBox;
  relative_->addItems({tr("the final value"), tr("the first value")});
  relative_->setToolTip(
      tr("Value that is subtracted from the parameters. During a run, the final value is the latest one."));
  shown_ = new QComboBox;
  shown_->addItems({tr("all iterations"), tr("the last stage")});
  shown_->setToolTip(tr("In the last stage, the parameters should stay within their sigmas"));
  summary_ = new QLabel;
  summary_->setForegroundRole(QPalette::PlaceholderText);
  camera_label_ = new QLabel(tr("&Camera"));
  auto* const relative_label = new QLabel(tr("Parameters relative &to"));
  auto* const shown_label = new QLabel(tr("&Show"));
  camera_label_->setBuddy(camera_);
  relative_label->setBuddy(relative_);
  shown_label->setBuddy(shown_);
  for (QWidget* widget : std::initializer_list<QWidget*>{camera_label_, camera_, relative_label, relative_,
                                                         shown_label, shown_})
    layout->addWidget(widget);
  layout->addStretch(1);
  layout->addWidget(summary_);
  layout->addWidget(makeSaveButton(*this, "convergence"));
  for (QComboBox* box : {camera_, relative_, shown_})
    connect(box, &QComboBox::activated, this, [this] { drawSoon(); });
  return bar;
}

QWidget* ConvergenceScreen::makeContent() {
  auto* const content = new QWidget;
  auto* const grid = new QGridLayout(content);
  grid->setContentsMargins(8, 8, 8, 8);
  grid->setSpacing(8);
  grid->addWidget(makeBar(), 0, 0, 1, 3);
  stages_ = new QLabel;
  stages_->setObjectName("stages");
  stages_->setWordWrap(true);
  useRichToolTip(*stages_);
  grid->addWidget(stages_, 1, 0, 1, 3);
  const QString iteration = tr("iteration");
  const PlotAxes axes[kPanels] = {
      {.title = tr("Cost"), .x_label = iteration, .logarithmic_y = true, .whole_x = true},
      {.title = tr("Gradient"), .x_label = iteration, .logarithmic_y = true, .whole_x = true},
      {.title = tr("Step"), .x_label = iteration, .logarithmic_y = true, .whole_x = true},
      {.title = tr("Rotation"), .x_label = iteration, .y_label = tr("difference (deg)"), .whole_x = true},
      {.title = tr("Translation"), .x_label = iteration, .y_label = tr("difference (mm)"), .whole_x = true},
      {.title = tr("Time offset"), .x_label = iteration, .y_label = tr("difference (ms)"), .whole_x = true}};
  for (int k = 0; k < kPanels; ++k) {
    panels_.push_back(new PlotPanel(axes[k]));
    panels_.back()->setToolTip(k < Rotation ? stagesHelp() : neededHelp());
    grid->addWidget(panels_.back(), 2 + k / 3, k % 3);
    grid->setColumnStretch(k % 3, 1);
    grid->setRowStretch(2 + k / 3, 1);
  }
  addParameterSeries(Cost, {tr("cost")});
  addParameterSeries(Gradient, {tr("gradient")});
  addParameterSeries(Step, {tr("step")});
  addParameterSeries(Rotation, {"x", "y", "z"});
  addParameterSeries(Translation, {"x", "y", "z"});
  addParameterSeries(TimeOffset, {tr("time offset")});
  PlotPanel::linkX(panels_);
  return content;
}

void ConvergenceScreen::addParameterSeries(Panel panel, const QStringList& names) {
  using Kind = PlotPanel::SeriesKind;
  ParameterPanel& series = series_[panel];
  const auto colour = [&](qsizetype k) { return names.size() == 1 ? PlotColour::Accent : kAxisColours[k]; };
  for (qsizetype k = 0; k < names.size(); ++k)
    series.bands.push_back(panels_[panel]->addSeries(Kind::Band, {.colour = colour(k), .opacity = 0.18}));
  for (qsizetype k = 0; k < names.size(); ++k) {
    series.lines.push_back(panels_[panel]->addSeries(
        Kind::Line, {.name = names[k], .colour = colour(k), .width_px = 1.6, .in_legend = names.size() > 1}));
    series.points.push_back(
        panels_[panel]->addSeries(Kind::Points, {.colour = colour(k), .width_px = kDot_px}));
  }
}

void ConvergenceScreen::setRun(std::shared_ptr<const CalibrationRun> run) {
  run_ = std::move(run);
  iterations_ = run_ ? run_->result.iterations : std::vector<IterationRecord>{};
  drawSoon();
}

void ConvergenceScreen::setNeeded(const std::optional<NeededAccuracy>& needed) {
  needed_ = needed;
  drawSoon();
}

void ConvergenceScreen::appendIteration(const IterationRecord& record) {
  if (run_) clear();  // first iteration of a new run
  iterations_.push_back(record);
  drawSoon();
}

void ConvergenceScreen::clear() {
  run_.reset();
  iterations_.clear();
  drawSoon();
}

void ConvergenceScreen::drawSoon() {
  redraw_->start();
}

void ConvergenceScreen::draw() {
  showPage(*stack_, iterations_.empty() ? StackPage::Note : StackPage::Content);
  for (PlotPanel* panel : panels_) panel->clear();
  if (iterations_.empty()) return;
  listCameras();
  std::vector<PlotMark> marks;
  for (std::size_t k = 0; k < iterations_.size(); ++k) {
    if (k > 0 && iterations_[k].stage == iterations_[k - 1].stage) continue;
    marks.push_back({static_cast<double>(k) - 0.5, QString::number(iterations_[k].stage)});
  }
  for (PlotPanel* panel : panels_) panel->setMarks(marks);
  showStages();
  drawProgress();
  drawParameters();
  drawNeeds();
  fitAll();
  summary_->setText(run_
                        ? tr("%1 iterations in %2 stages, %3 s")
                              .arg(iterations_.size())
                              .arg(marks.size())
                              .arg(run_->result.timing.optimise_s, 0, 'f', 1)
                        : tr("iteration %1, stage %2").arg(iterations_.size()).arg(iterations_.back().stage));
}

void ConvergenceScreen::showStages() {
  QStringList names;
  QString help;
  for (const StageWords& stage : stageWords(iterations_)) {
    names << stage.name;
    help += QStringLiteral("<p>%1</p>").arg(stage.help.toHtmlEscaped());  // wraps, unlike plain text
  }
  stages_->setText(names.join(QStringLiteral("     ")));
  stages_->setToolTip(help + QStringLiteral("<p>%1</p>").arg(stagesHelp()));
}

void ConvergenceScreen::listCameras() {
  const auto count = static_cast<int>(iterations_.front().cameras.size());
  if (camera_->count() != count || run_) {
    const int current = std::clamp(camera_->currentIndex(), 0, std::max(0, count - 1));
    camera_->clear();
    for (int k = 0; k < count; ++k) {
      const auto index = static_cast<std::size_t>(k);
      camera_->addItem(run_ && index < run_->detections.cameras.size()
                           ? QString::fromStdString(run_->detections.cameras[index].camera)
                           : tr("camera %1").arg(k + 1));
    }
    camera_->setCurrentIndex(current);
  }
  camera_->setVisible(count > 1);
  camera_label_->setVisible(count > 1);
}

// The weights, and with them cost and gradient, differ between stages: no line across the border.
void ConvergenceScreen::drawProgress() {
  double IterationRecord::*const members[] = {&IterationRecord::cost, &IterationRecord::gradient,
                                              &IterationRecord::step};
  for (int panel = Cost; panel <= Step; ++panel) {
    std::vector<double> x, y;
    for (std::size_t k = 0; k < iterations_.size(); ++k) {
      if (k > 0 && iterations_[k].stage != iterations_[k - 1].stage) {
        x.push_back(static_cast<double>(k) - 0.5);
        y.push_back(std::numeric_limits<double>::quiet_NaN());
      }
      const double value = iterations_[k].*members[panel];
      if (!(value > 0.0)) continue;  // no logarithm
      x.push_back(static_cast<double>(k));
      y.push_back(value);
    }
    PlotPanel& chart = *panels_[static_cast<std::size_t>(panel)];
    chart.setData(series_[panel].lines[0], x, y);
    chart.setData(series_[panel].points[0], x, y);
  }
  panels_[Cost]->setNote(QString::number(iterations_.back().cost, 'g', 4));
  panels_[Gradient]->setNote(QString::number(iterations_.back().gradient, 'g', 2));
  panels_[Step]->setNote(QString::number(iterations_.back().step, 'g', 2));
}

std::vector<double> ConvergenceScreen::differences(Panel panel, int axis, std::size_t camera) const {
  const bool to_first = relative_->currentIndex() == static_cast<int>(Relative::ToFirst);
  const CameraState& base = (to_first ? iterations_.front() : iterations_.back()).cameras[camera];
  std::vector<double> values;
  for (const IterationRecord& record : iterations_) {
    const CameraState& state = record.cameras[camera];
    if (panel == Rotation) {
      const Eigen::Quaterniond turn =
          state.reference_from_camera.rotation * base.reference_from_camera.rotation.conjugate();
      values.push_back(kDegPerRad * quaternionLog(turn)[axis]);
    } else if (panel == Translation) {
      values.push_back(kMillimetresPerMetre * (state.reference_from_camera.translation_m -
                                               base.reference_from_camera.translation_m)[axis]);
    } else {
      values.push_back(kMillisecondsPerSecond * (state.time_offset_s - base.time_offset_s));
    }
  }
  return values;
}

double ConvergenceScreen::sigma(Panel panel, int axis, std::size_t camera) const {
  const CameraUncertainty& uncertainty = run_->result.uncertainty.cameras[camera];
  if (panel == Rotation) return kDegPerRad * uncertainty.rotation_std_rad[axis];
  if (panel == Translation) return kMillimetresPerMetre * uncertainty.translation_std_m[axis];
  return kMillisecondsPerSecond * uncertainty.time_offset_std_s;
}

void ConvergenceScreen::drawParameters() {
  const auto camera = static_cast<std::size_t>(std::max(0, camera_->currentIndex()));
  if (camera >= iterations_.front().cameras.size()) return;
  std::vector<double> x(iterations_.size());
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = static_cast<double>(k);
  for (const Panel panel : {Rotation, Translation, TimeOffset}) {
    for (std::size_t axis = 0; axis < series_[panel].lines.size(); ++axis) {
      const std::vector<double> y = differences(panel, static_cast<int>(axis), camera);
      panels_[panel]->setData(series_[panel].lines[axis], x, y);
      panels_[panel]->setData(series_[panel].points[axis], x, y);
    }
  }
  if (run_ && camera < run_->result.uncertainty.cameras.size()) drawBands(camera);
}

void ConvergenceScreen::drawBands(std::size_t camera) {
  const auto begin = static_cast<double>(lastStageBegin(iterations_)) - 0.5;
  const auto end = static_cast<double>(iterations_.size() - 1) + 0.5;
  for (const Panel panel : {Rotation, Translation, TimeOffset}) {
    QStringList sigmas;
    for (std::size_t axis = 0; axis < series_[panel].bands.size(); ++axis) {
      const double final_value = differences(panel, static_cast<int>(axis), camera).back();
      const double std = sigma(panel, static_cast<int>(axis), camera);
      panels_[panel]->setBand(series_[panel].bands[axis], {begin, end},
                              {final_value - std, final_value - std}, {final_value + std, final_value + std});
      sigmas << QString::number(std, 'g', 2);
    }
    panels_[panel]->setNote(QStringLiteral("\u00b1 %1 %2").arg(sigmas.join(", "), kUnits[panel - Rotation]));
  }
}

// Around the final value; relative to the first one, each axis would have its own lines.
void ConvergenceScreen::drawNeeds() {
  if (!needed_ || relative_->currentIndex() != static_cast<int>(Relative::ToFinal)) return;
  const double needs[] = {needed_->rotation_deg, needed_->translation_mm, needed_->time_offset_ms};
  for (const Panel panel : {Rotation, Translation, TimeOffset}) {
    const double need = needs[panel - Rotation];
    panels_[panel]->setLevels({-need, need});
  }
}

void ConvergenceScreen::fitAll() {
  const bool last_stage = shown_->currentIndex() == static_cast<int>(Shown::LastStage);
  const auto begin = last_stage ? static_cast<double>(lastStageBegin(iterations_)) : 0.0;
  const auto end = static_cast<double>(iterations_.size() - 1);
  for (PlotPanel* panel : panels_) panel->fitWithin(begin - 0.5, end + 0.5);
}

namespace {

QString tr(const char* text) {
  return QCoreApplication::translate("stages", text);
}

// Groups the quantities by sensor: "camera: rotation vector, translation".
QString grouped(const std::vector<std::string>& released) {
  const std::array<QString, 3> owners = {"camera", "IMU", "board"};
  std::array<QStringList, 3> of_owner;
  QStringList rest;
  for (const std::string& each : released) {
    const QString words = QString::fromStdString(each);
    bool owned = false;
    for (std::size_t k = 0; k < owners.size() && !owned; ++k) {
      owned = words.startsWith(owners[k] + ' ');
      if (owned) of_owner[k] << words.mid(owners[k].size() + 1);
    }
    if (!owned) rest << words;
  }
  QStringList groups;
  for (std::size_t k = 0; k < owners.size(); ++k)
    if (!of_owner[k].isEmpty()) groups << owners[k] + ' ' + of_owner[k].join(", ");
  if (!rest.isEmpty()) groups << rest.join(", ");
  return groups.join("; ");
}

}  // namespace

std::vector<StageWords> stageWords(const std::vector<IterationRecord>& iterations) {
  std::vector<StageWords> stages;
  int stage = 0;
  for (const IterationRecord& record : iterations) {
    if (record.stage == stage) continue;
    const bool first = stage == 0;
    stage = record.stage;
    const QString freed = grouped(record.released);
    const auto count = static_cast<int>(record.released.size());
    const QString quantities = count == 1 ? tr("1 quantity") : tr("%1 quantities").arg(count);
    if (first)
      stages.push_back({tr("Stage %1: trajectory, %2").arg(stage).arg(quantities),
                        tr("Stage %1: trajectory; %2").arg(stage).arg(freed)});
    else if (count > 0)
      stages.push_back(
          {tr("Stage %1: + %2").arg(stage).arg(quantities), tr("Stage %1: + %2").arg(stage).arg(freed)});
    else
      stages.push_back(
          {tr("Stage %1: new weights").arg(stage),
           tr("Stage %1: the same, weighted by the estimated noise, until convergence").arg(stage)});
  }
  return stages;
}

QString stagesHelp() {
  return tr(
      "The optimiser frees parameters stage by stage. Before each stage it weights the sensors again by the\n"
      "estimated noise and drops outliers: this changes the meaning of the cost, which jumps.\n"
      "Within a stage the cost must decrease.");
}

QString neededHelp() {
  return tr(
      "Shaded: the final value plus and minus one sigma. Dash-dotted: the accuracy that the verdict needs\n"
      "(Parameters, needed accuracy); the lines may be outside the shown range.");
}

}  // namespace evical::ui
