// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/result_screen.h"

#include "core/base/error.h"
#include "ui/forms/repair_button.h"
#include "ui/screens/result/correlation_view.h"
#include "ui/screens/result/observability_view.h"
#include "ui/screens/result/pose_panel.h"
#include "ui/screens/result/quantity_table.h"
#include "ui/screens/result/result_parameters.h"
#include "ui/screens/verdict_labels.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QScrollArea>
#include <QSplitter>
#include <QStackedWidget>
#include <QTabWidget>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

QString verdictWords(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::Ok:
      return QObject::tr("Calibrated");
    case CalibrationStatus::Doubtful:
      return QObject::tr("Calibrated, but doubtful");
    case CalibrationStatus::Failed:
      return QObject::tr("Failed");
  }
  return {};
}

QString fitText(const NamedResult& named) {
  QStringList parts;
  for (std::size_t i = 0; i < named.result->cameras.size(); ++i) {
    const CameraFit& fit = named.result->cameras[i];
    parts << QObject::tr("%1: points fit to %2 px RMS, board used %3 of %4 times")
                 .arg(QString::fromStdString(named.cameras.at(i).name))
                 .arg(fit.reprojection_rms_px, 0, 'g', 3)
                 .arg(fit.windows_used)
                 .arg(fit.windows_total);
    if (fit.windows_rejected > 0)
      parts.back() += QObject::tr(", %1 rejected by hand").arg(fit.windows_rejected);
  }
  parts << QObject::tr("duration %1 s including detection").arg(named.result->timing.total_s, 0, 'f', 1);
  return parts.join("; ") + ".";
}

// Content of a tab: text above, a plot below.
QWidget* explained(QLabel* text, QWidget* picture, QWidget* parent) {
  auto* const page = new QWidget(parent);
  auto* const layout = new QVBoxLayout(page);
  layout->addWidget(text);
  layout->addWidget(picture, 1);
  return page;
}

}  // namespace

ResultScreen::ResultScreen(QWidget* parent)
    : QWidget(parent),
      stack_(new QStackedWidget(this)),
      none_yet_(selectableLabel("heading", this)),
      calibrate_(new QPushButton(icon("calibrate"), tr("Calibrate"), this)),
      icon_(new QLabel(this)),
      verdict_(selectableLabel("title", this)),
      reason_(selectableLabel("", this)),
      fit_(selectableLabel("hint", this)),
      outdated_(selectableLabel("problem", this)),
      comparison_(selectableLabel("hint", this)),
      observed_(selectableLabel("", this)),
      pairs_(selectableLabel("hint", this)),
      repair_(new RepairButton(this)),
      against_(new QComboBox(this)),
      parameters_(new QuantityTable(this)),
      pose_(new PosePanel(this)),
      observability_(new ObservabilityView(this)),
      correlation_(new CorrelationView(this)),
      notes_(new QListWidget(this)) {
  stack_->addWidget(makeEmpty());
  stack_->addWidget(makeContent());
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(stack_);
  against_->setAccessibleName(tr("Compare with"));
  against_->setToolTip(tr("Another run of this session, or a loaded result"));
  connect(against_, &QComboBox::activated, this, [this] {
    const QVariant chosen = against_->currentData();
    if (chosen.typeId() == QMetaType::QString) return emit keptRunRequested(chosen.toString());
    showParameters();
  });
}

QWidget* ResultScreen::makeEmpty() {
  auto* const empty = new QWidget(this);
  auto* const layout = new QVBoxLayout(empty);
  none_yet_->setAlignment(Qt::AlignCenter);
  connect(calibrate_, &QPushButton::clicked, this, &ResultScreen::calibrateRequested);
  layout->addStretch();
  layout->addWidget(none_yet_);
  layout->addWidget(calibrate_, 0, Qt::AlignHCenter);
  layout->addStretch();
  setCalibrating(false);
  return empty;
}

void ResultScreen::setCalibrating(bool calibrating) {
  none_yet_->setText(calibrating ? tr("Calibrating: the result is shown here when the run is done.")
                                 : tr("No calibration yet: press Calibrate."));
  calibrate_->setVisible(!calibrating);
}

QWidget* ResultScreen::makeHeader() {
  auto* const header = new QWidget(this);
  auto* const words = new QVBoxLayout;
  words->setSpacing(2);
  for (QLabel* const line : {verdict_, reason_}) words->addWidget(line);
  words->addWidget(repair_, 0, Qt::AlignLeft);
  for (QLabel* const line : {fit_, outdated_}) words->addWidget(line);
  connect(repair_, &RepairButton::repairRequested, this, &ResultScreen::repairRequested);
  outdated_->setText(tr("The session has changed since this result. Calibrate again to update it."));
  auto* const save = new QPushButton(icon("export"), tr("Export..."), header);
  save->setObjectName("export");
  save->setToolTip(
      tr("Write result.yaml, the report, tables, and files for other programs to a folder (Ctrl+E)"));
  connect(save, &QPushButton::clicked, this, &ResultScreen::exportRequested);
  auto* const report = new QPushButton(icon("report"), tr("Open report"), header);
  report->setObjectName("report");
  report->setToolTip(tr("Page with plots and advice, in the browser (Ctrl+R)"));
  connect(report, &QPushButton::clicked, this, &ResultScreen::reportRequested);
  auto* const layout = new QHBoxLayout(header);
  layout->setContentsMargins(4, 0, 4, 0);
  layout->setSpacing(12);
  layout->addWidget(icon_, 0, Qt::AlignTop);
  layout->addLayout(words, 1);
  layout->addWidget(report, 0, Qt::AlignTop);
  layout->addWidget(save, 0, Qt::AlignTop);
  return header;
}

QWidget* ResultScreen::makeSides() {
  auto* const sides = new QTabWidget(this);
  sides->setDocumentMode(true);
  sides->tabBar()->setDrawBase(false);
  sides->addTab(pose_, tr("Pose"));
  auto* const bars = new QScrollArea(sides);
  bars->setWidget(observability_);
  bars->setWidgetResizable(true);
  bars->setFrameShape(QFrame::NoFrame);
  sides->addTab(explained(observed_, bars, sides), tr("Observability"));
  sides->addTab(explained(pairs_, correlation_, sides), tr("Correlation"));
  sides->addTab(notes_, tr("Notes"));
  notes_->setWordWrap(true);
  notes_->setAccessibleName(tr("Notes"));
  notes_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  return sides;
}

QWidget* ResultScreen::makeContent() {
  auto* const content = new QWidget(this);
  auto* const left = new QWidget(content);
  auto* const bar = new QHBoxLayout;
  against_->setObjectName("against");
  auto* const load = new QPushButton(icon("open"), tr("Load..."), left);
  load->setToolTip(tr("Compare with a result.yaml or truth.yaml"));
  connect(load, &QPushButton::clicked, this, &ResultScreen::referenceRequested);
  bar->addWidget(new QLabel(tr("Compare with"), left));
  bar->addWidget(against_, 1);
  bar->addWidget(load);
  parameters_->addToContextMenu(pose_->copyMenu());
  auto* const column = new QVBoxLayout(left);
  column->setContentsMargins(0, 0, 0, 0);
  column->addLayout(bar);
  column->addWidget(comparison_);
  column->addWidget(parameters_, 1);
  auto* const split = new QSplitter(Qt::Horizontal, content);
  split->addWidget(left);
  split->addWidget(makeSides());
  split->setSizes({610, 430});
  split->setChildrenCollapsible(false);
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(makeHeader());
  layout->addWidget(split, 1);
  return content;
}

void ResultScreen::setResult(std::optional<NamedResult> result) {
  result_ = std::move(result);
  stack_->setCurrentIndex(result_ ? 1 : 0);
  offerComparisons();
  if (!result_) return;
  showVerdict();
  showParameters();
  showDetails();
}

void ResultScreen::setPrevious(std::optional<NamedResult> previous) {
  previous_ = std::move(previous);
  offerComparisons();
  showParameters();
}

void ResultScreen::setRuns(std::optional<NamedResult> previous, std::optional<NamedResult> result) {
  previous_ = std::move(previous);
  setResult(std::move(result));
}

void ResultScreen::setReference(std::optional<NamedResult> reference, const QString& title) {
  const bool asked_for = against_->currentData().typeId() == QMetaType::QString;
  const bool is_new = reference && (!reference_ || title != reference_title_ || asked_for);
  reference_ = std::move(reference);
  reference_title_ = title;
  offerComparisons();
  if (is_new) against_->setCurrentIndex(against_->findData(static_cast<int>(Against::Reference)));
  showParameters();
}

void ResultScreen::setKeptRuns(const std::vector<std::pair<QString, QString>>& runs) {
  if (runs == kept_runs_) return;
  kept_runs_ = runs;
  offerComparisons();
}

void ResultScreen::setOutdated(bool outdated) {
  outdated_->setVisible(outdated);
}

QMenu* ResultScreen::copyMenu() const {
  return pose_->copyMenu();
}

void ResultScreen::offerComparisons() {
  const QVariant chosen = against_->currentData();
  against_->clear();
  against_->addItem(tr("nothing"), static_cast<int>(Against::Nothing));
  if (previous_) against_->addItem(tr("the previous run"), static_cast<int>(Against::Previous));
  if (reference_) against_->addItem(reference_title_, static_cast<int>(Against::Reference));
  for (const auto& [title, folder] : kept_runs_)
    if (!reference_ || title != reference_title_) against_->addItem(title, folder);
  against_->setCurrentIndex(std::max(0, against_->findData(chosen)));
}

const NamedResult* ResultScreen::compared() const {
  switch (static_cast<Against>(against_->currentData().toInt())) {
    case Against::Previous:
      return previous_ ? &*previous_ : nullptr;
    case Against::Reference:
      return reference_ ? &*reference_ : nullptr;
    default:
      return nullptr;
  }
}

void ResultScreen::showVerdict() {
  const CalibrationResult& result = *result_->result;
  const bool ok = result.status == CalibrationStatus::Ok;
  icon_->setPixmap(verdictIcon(result.status).pixmap(QSize(34, 34), devicePixelRatioF()));
  verdict_->setText(verdictWords(result.status));
  reason_->setText(
      ok ? tr("The recording determines every quantity with the needed accuracy. Next: export the "
              "result, or check it with another recording.")
         : sentence(QString::fromStdString(result.reason)));
  repair_->setRepair(result.repair);
  fit_->setText(fitText(*result_));
}

void ResultScreen::showParameters() {
  if (!result_) return;
  std::vector<ParameterGroup> groups = parameterGroups(*result_);
  const NamedResult* const other = compared();
  QString remark;
  bool is_compared = other != nullptr;
  if (other != nullptr) {
    try {
      const QStringList notes = compare(groups, *result_, *other);
      if (!notes.isEmpty()) remark = sentence(notes.join("; "));
    } catch (const CalibrationError& error) {
      is_compared = false;
      remark = tr("The results cannot be compared. %1").arg(sentence(QString::fromStdString(error.what())));
    }
  }
  comparison_->setText(remark);
  comparison_->setVisible(!remark.isEmpty());
  parameters_->setGroups(std::move(groups), is_compared);
}

void ResultScreen::showDetails() {
  constexpr int kPairs = 3;
  const UncertaintyReport& report = result_->result->uncertainty;
  pose_->setResult(*result_);
  QStringList directions;
  for (const std::string& words : report.directions) directions << QString::fromStdString(words);
  if (directions.isEmpty()) directions << QString::fromStdString(report.weakest);
  observability_->setObservability(report.observability, directions);
  observed_->setText(observability_->text());
  correlation_->setResult(*result_);
  const QStringList pairs = correlation_->strongestPairs(kPairs);
  pairs_->setText(pairs.isEmpty() ? QString() : tr("Least separable quantities: %1.").arg(pairs.join("; ")));
  notes_->clear();
  for (const std::string& note : result_->result->notes)
    notes_->addItem(sentence(QString::fromStdString(note)));
}

void ResultScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange && result_) {
    showVerdict();
    showParameters();
  }
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
