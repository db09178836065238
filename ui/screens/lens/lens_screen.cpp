// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/lens/lens_screen.h"

#include "core/base/error.h"
#include "ui/screens/lens/image_map_view.h"
#include "ui/screens/lens/lens_parameters.h"
#include "ui/screens/lens/views_chart.h"
#include "ui/screens/verdict_labels.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QCoreApplication>
#include <QEvent>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPushButton>
#include <QSplitter>
#include <QStackedWidget>
#include <QTabWidget>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

enum LensColumn { kName, kValue, kSigma, kUnit, kDifference, kSigmas, kColumns };
constexpr LensColumn kNumbers[] = {kValue, kSigma, kDifference, kSigmas};

QString lensVerdictWords(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::Ok:
      return QObject::tr("Camera calibrated");
    case CalibrationStatus::Doubtful:
      return QObject::tr("Camera calibrated, but doubtful");
    case CalibrationStatus::Failed:
      return QObject::tr("Failed");
  }
  return {};
}

QTreeWidgetItem* itemOf(const LensRow& row) {
  auto* const item =
      new QTreeWidgetItem({row.name, row.value, row.sigma, row.unit, row.difference, row.sigmas});
  for (const int column : kNumbers) item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
  if (row.far) item->setForeground(kSigmas, theme().warning);
  return item;
}

ImageMapCells emptyCells(const IntrinsicsResult& result) {
  ImageMapCells cells;
  cells.columns = result.image.columns;
  cells.rows = result.image.rows;
  cells.resolution_px = result.intrinsics.resolution_px;
  return cells;
}

QString px(double value) {
  return QString::number(value, 'g', 2);
}

}  // namespace

LensScreen::LensScreen(QWidget* parent)
    : QWidget(parent),
      stack_(new QStackedWidget(this)),
      icon_(new QLabel(this)),
      verdict_(selectableLabel("title", this)),
      reason_(selectableLabel("", this)),
      fit_(selectableLabel("hint", this)),
      outdated_(selectableLabel("problem", this)),
      in_session_(selectableLabel("hint", this)),
      remark_(selectableLabel("hint", this)),
      uncertainty_text_(selectableLabel("", this)),
      coverage_text_(selectableLabel("", this)),
      difference_text_(selectableLabel("", this)),
      views_text_(selectableLabel("", this)),
      against_(new QComboBox(this)),
      parameters_(new QTreeWidget(this)),
      sides_(new QTabWidget(this)),
      uncertainty_(new ImageMapView(this)),
      coverage_(new ImageMapView(this)),
      difference_(new ImageMapView(this)),
      views_(new ViewsChart(this)),
      notes_(new QListWidget(this)),
      programs_(nullptr) {
  stack_->addWidget(makeEmpty());
  stack_->addWidget(makeContent());
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(stack_);
  connect(against_, &QComboBox::activated, this, &LensScreen::compare);
}

QWidget* LensScreen::makeEmpty() {
  auto* const empty = new QWidget(this);
  auto* const layout = new QVBoxLayout(empty);
  auto* const text = selectableLabel("heading", empty);
  text->setText(tr("The camera is not calibrated yet."));
  text->setAlignment(Qt::AlignCenter);
  auto* const start = new QPushButton(icon("calibrate"), tr("Calibrate the camera"), empty);
  start->setToolTip(tr("Calibrate the lens from the open recording (F5)"));
  connect(start, &QPushButton::clicked, this, &LensScreen::calibrateRequested);
  layout->addStretch();
  layout->addWidget(text);
  layout->addWidget(start, 0, Qt::AlignHCenter);
  layout->addStretch();
  return empty;
}

QPushButton* LensScreen::makeSave() {
  auto* const save = new QPushButton(icon("export"), tr("Save as..."), this);
  save->setObjectName("save_lens");
  save->setAccessibleName(tr("Save the lens as"));
  save->setToolTip(tr("Save the lens as one file, as all files, or for another program (Ctrl+E: all)"));
  auto* const menu = new QMenu(save);
  for (std::size_t k = 0; k < kLensFiles.size(); ++k) {
    const QString title = QCoreApplication::translate("LensFile", kLensFiles[k].title);
    menu->addAction(title + "...", this, [this, k] { emit saveRequested(static_cast<int>(k)); });
  }
  menu->addSeparator();
  menu->addAction(icon("folder"), tr("All of these, to a folder..."), this, &LensScreen::saveAllRequested);
  programs_ = menu->addMenu(tr("For another program"));
  save->setMenu(menu);
  return save;
}

QWidget* LensScreen::makeHeader() {
  auto* const header = new QWidget(this);
  auto* const words = new QVBoxLayout;
  words->setSpacing(2);
  for (QLabel* const line : {verdict_, reason_, fit_, outdated_, in_session_}) words->addWidget(line);
  outdated_->setText(tr("The session has changed since this result. Calibrate again to update it."));
  outdated_->hide();
  in_session_->setObjectName("lens_in_session");
  in_session_->setText(tr("The session has this lens now: the next calibrations of the rig use it."));
  use_ = new QPushButton(icon("camera"), tr("Use in the session"), header);
  use_->setObjectName("use_lens");
  use_->setToolTip(tr("Set this lens as the session's camera intrinsics, for calibrations of the rig"));
  connect(use_, &QPushButton::clicked, this, &LensScreen::useRequested);
  setInSession(false);
  auto* const layout = new QHBoxLayout(header);
  layout->setContentsMargins(4, 0, 4, 0);
  layout->addWidget(icon_, 0, Qt::AlignTop);
  layout->addLayout(words, 1);
  layout->addWidget(makeSave(), 0, Qt::AlignTop);
  layout->addWidget(use_, 0, Qt::AlignTop);
  return header;
}

QWidget* LensScreen::makeComparisons() {
  auto* const bar = new QWidget(this);
  auto* const layout = new QHBoxLayout(bar);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* const what = new QLabel(tr("Compare with"), bar);
  what->setBuddy(against_);
  against_->setObjectName("lens_against");
  against_->setAccessibleName(tr("Lens to compare with"));
  against_->setToolTip(tr("The session's previous lens, or one from a file"));
  against_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  auto* const file = new QPushButton(icon("open"), tr("Load..."), bar);
  file->setObjectName("lens_other");
  file->setAccessibleName(tr("Compare with the lens of a file"));
  file->setToolTip(
      tr("Lens or result of Evical, camchain of Kalibr, camera_info of ROS, or intrinsics of eKalibr"));
  connect(file, &QPushButton::clicked, this, &LensScreen::otherRequested);
  layout->addWidget(what);
  layout->addWidget(against_, 1);
  layout->addWidget(file);
  return bar;
}

QWidget* LensScreen::addTab(const QString& title, QWidget* picture, QLabel* text) {
  auto* const page = new QWidget(sides_);
  auto* const layout = new QVBoxLayout(page);
  layout->setContentsMargins(4, 8, 4, 0);
  layout->addWidget(text);
  layout->addWidget(picture, 1);
  picture->setAccessibleName(title);
  sides_->addTab(page, title);
  return page;
}

QWidget* LensScreen::makeSides() {
  constexpr int kNotes_px = 96;
  addTab(tr("Uncertainty"), uncertainty_, uncertainty_text_);
  addTab(tr("Coverage"), coverage_, coverage_text_);
  addTab(tr("Views"), views_, views_text_);
  addTab(tr("Difference"), difference_, difference_text_);
  sides_->setUsesScrollButtons(true);
  auto* const right = new QWidget(this);
  auto* const layout = new QVBoxLayout(right);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(sides_, 1);
  auto* const heading = selectableLabel("heading", right);
  heading->setText(tr("Notes and advice"));
  layout->addWidget(heading);
  notes_->setAccessibleName(heading->text());
  notes_->setWordWrap(true);
  notes_->setMaximumHeight(kNotes_px);
  notes_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  layout->addWidget(notes_);
  return right;
}

QWidget* LensScreen::makeContent() {
  auto* const content = new QWidget(this);
  parameters_->setObjectName("lens_numbers");
  parameters_->setAccessibleName(tr("The lens in numbers"));
  parameters_->setColumnCount(kColumns);
  parameters_->setHeaderLabels(
      {tr("Quantity"), tr("Value"), QString(QChar(0xb1)), tr("Unit"), tr("Difference"), tr("Sigmas")});
  for (const int column : kNumbers)
    parameters_->headerItem()->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
  parameters_->headerItem()->setToolTip(kSigma, tr("Standard deviation"));
  parameters_->header()->setStretchLastSection(false);
  parameters_->setRootIsDecorated(false);
  parameters_->setIndentation(10);
  parameters_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  auto* const left = new QWidget(content);
  auto* const column = new QVBoxLayout(left);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(makeComparisons());
  column->addWidget(remark_);
  column->addWidget(parameters_, 1);
  auto* const split = new QSplitter(Qt::Horizontal, content);
  split->setChildrenCollapsible(false);
  split->addWidget(left);
  split->addWidget(makeSides());
  split->setSizes({600, 420});
  split->setStretchFactor(0, 1);
  split->setStretchFactor(1, 2);
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(makeHeader());
  layout->addWidget(split, 1);
  return content;
}

void LensScreen::setPrograms(const std::vector<std::pair<QString, QString>>& programs) {
  programs_->clear();
  for (const auto& [name, description] : programs)
    programs_->addAction(description + "...", this,
                         [this, program = name] { emit exportRequested(program); });
}

void LensScreen::setLens(std::optional<NamedIntrinsics> found) {
  lens_ = std::move(found);
  stack_->setCurrentIndex(lens_ ? 1 : 0);
  if (!lens_) return;
  showVerdict();
  showMaps();
  compare();
}

void LensScreen::setOthers(std::vector<Other> others) {
  const QString chosen = against_->currentText();
  QString newcomer;
  for (const Other& other : others) {
    const bool known = std::any_of(others_.begin(), others_.end(), [&](const Other& before) {
      return before.first == other.first && before.second.camera == other.second.camera;
    });
    if (!known) newcomer = other.first;
  }
  others_ = std::move(others);
  against_->clear();
  against_->addItem(tr("nothing"));
  for (const Other& other : others_) against_->addItem(other.first);
  against_->setCurrentIndex(std::max(0, against_->findText(newcomer.isEmpty() ? chosen : newcomer)));
  compare();
}

void LensScreen::setOutdated(bool outdated) {
  outdated_->setVisible(outdated);
}

void LensScreen::setInSession(bool in_session) {
  in_session_->setVisible(in_session);
  use_->setEnabled(!in_session);
  use_->setText(in_session ? tr("In the session") : tr("Use in the session"));
}

const LensScreen::Other* LensScreen::other() const {
  const int index = against_->currentIndex() - 1;
  return index < 0 || static_cast<std::size_t>(index) >= others_.size()
             ? nullptr
             : &others_[static_cast<std::size_t>(index)];
}

void LensScreen::compare() {
  if (!lens_) return;
  comparison_.reset();
  QString remark;
  if (const Other* const with = other()) {
    try {
      comparison_ = compareLenses(lens_->result, with->second);
      if (!comparison_->numbers)
        remark =
            tr("The models differ, so single numbers are not comparable. Compare the projections "
               "under Difference.");
    } catch (const CalibrationError& error) {
      remark = tr("The lenses cannot be compared. %1").arg(sentence(QString::fromStdString(error.what())));
    }
  }
  remark_->setText(remark);
  remark_->setVisible(!remark.isEmpty());
  showParameters();
  showDifference();
}

void LensScreen::showVerdict() {
  const IntrinsicsResult& result = lens_->result;
  const bool ok = result.status == CalibrationStatus::Ok;
  icon_->setPixmap(verdictIcon(result.status).pixmap(QSize(34, 34), devicePixelRatioF()));
  verdict_->setText(lensVerdictWords(result.status));
  reason_->setText(ok ? tr("The views determine the lens with the needed accuracy.")
                      : sentence(QString::fromStdString(result.reason)));
  fit_->setText(
      tr("%1: projection uncertainty %2 px RMS; reprojection error %3 px RMS in %4 views; duration %5 s.")
          .arg(QString::fromStdString(lens_->camera), px(result.image.rms_px), px(result.reprojection_rms_px))
          .arg(result.views_used)
          .arg(result.elapsed_s, 0, 'f', 1));
  notes_->clear();
  for (const std::string& advice : result.advice) notes_->addItem(sentence(QString::fromStdString(advice)));
  if (result.advice.empty()) notes_->addItem(tr("No advice: the views cover the image and the tilts."));
}

void LensScreen::showParameters() {
  const std::vector<LensGroup> groups = lensGroups(*lens_, comparison_);
  QList<QTreeWidgetItem*> headings;
  for (const LensGroup& group : groups) {
    auto* const heading = new QTreeWidgetItem({group.title});
    QFont bold = parameters_->font();
    bold.setWeight(QFont::DemiBold);
    heading->setFont(kName, bold);
    for (const LensRow& row : group.rows) heading->addChild(itemOf(row));
    headings << heading;
  }
  parameters_->clear();
  parameters_->addTopLevelItems(headings);
  for (QTreeWidgetItem* const heading : headings) heading->setFirstColumnSpanned(true);
  parameters_->expandAll();
  const bool numbers = comparison_ && comparison_->numbers;
  parameters_->setColumnHidden(kDifference, !numbers);
  parameters_->setColumnHidden(kSigmas, !numbers);
  for (int column = 0; column < kColumns; ++column) parameters_->resizeColumnToContents(column);
}

void LensScreen::showMaps() {
  const IntrinsicsResult& result = lens_->result;
  ImageMapCells uncertainty = emptyCells(result), coverage = emptyCells(result);
  int empty = 0;
  for (const ImageCell& cell : result.image.cells) {
    uncertainty.values.push_back(std::isfinite(cell.sigma_px) ? std::optional(cell.sigma_px) : std::nullopt);
    coverage.values.emplace_back(cell.circles);
    empty += cell.circles == 0 ? 1 : 0;
  }
  uncertainty.unit = "px";
  coverage.more_is_better = true;
  uncertainty_->setCells(std::move(uncertainty));
  coverage_->setCells(std::move(coverage));
  uncertainty_text_->setText(tr("Standard deviation of a ray's pixel: %1 px RMS, at most %2 px.")
                                 .arg(px(result.image.rms_px), px(result.image.max_px)));
  const double cells = std::max(1.0, static_cast<double>(result.image.cells.size()));
  coverage_text_->setText(tr("Used points of the board, by place: %1 % of the image has some. "
                             "Elsewhere only the model constrains "
                             "the lens.")
                              .arg(100.0 * (1.0 - empty / cells), 0, 'f', 0));
  views_->setViews(lens_->story.views);
  views_text_->setText(tr("Views used: %1. Tilted views determine the focal length: the tilts and "
                          "distances should vary.")
                           .arg(lens_->story.views.size()));
}

void LensScreen::showDifference() {
  const int tab = sides_->count() - 1;
  sides_->setTabEnabled(tab, comparison_.has_value());
  sides_->setTabToolTip(tab, comparison_ ? QString() : tr("Choose a lens to compare with"));
  if (!comparison_) {
    difference_->setCells({});
    return difference_text_->clear();
  }
  ImageMapCells cells = emptyCells(lens_->result);
  for (const LensComparison::Place& place : comparison_->places) cells.values.push_back(place.difference_px);
  cells.unit = "px";
  difference_->setCells(std::move(cells));
  difference_text_->setText(tr("Distance between both projections after the best rotation of the camera: %1 "
                               "px RMS, at most %2 px; %3 "
                               "sigmas RMS.")
                                .arg(px(comparison_->rms_px), px(comparison_->max_px))
                                .arg(comparison_->rms_sigmas, 0, 'f', 1));
}

void LensScreen::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange && lens_) {
    showVerdict();
    showParameters();
  }
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
