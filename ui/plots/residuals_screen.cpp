// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/residuals_screen.h"

#include "core/numerics/robust.h"
#include "core/report/residual_statistics.h"
#include "ui/forms/number_field.h"
#include "ui/jobs/latest_job.h"
#include "ui/plots/chart_saving.h"
#include "ui/plots/empty_note.h"
#include "ui/plots/plot_panel.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QStackedLayout>
#include <QTimer>
#include <QToolButton>

#include <algorithm>
#include <cmath>
#include <limits>

namespace evical::ui {
namespace {

using Kind = PlotPanel::SeriesKind;

constexpr double kScatterReach = 4.5;  // initial range of the scatter in sigmas
constexpr double kAboveAll = 1.1;      // initial threshold relative to the largest RMS: rejects nothing
constexpr double kShareOfWindowSpacing = 0.8;  // a bar's width
constexpr int kMinForArrow = 10;               // circles in a cell, for a meaningful mean
constexpr std::size_t kMaxPoints = 15'000;     // limits the time of drawing; marked ones are all drawn
constexpr int kFrame_ms = 30;

template <class Wanted>
std::shared_ptr<PlotLineData> points(const std::vector<CircleResidual>& residuals, const Wanted& wanted) {
  std::vector<double> x, y;
  for (const CircleResidual& residual : residuals) {
    if (!wanted(residual)) continue;
    x.push_back(residual.residual_px.x());
    y.push_back(residual.residual_px.y());
  }
  return makePlotLine(x, y);
}

double normalDensity(double x, double mean, double sigma) {
  const double z = (x - mean) / sigma;
  return std::exp(-0.5 * z * z) / (sigma * std::sqrt(2.0 * M_PI));
}

double windowSpacing(const std::vector<WindowResidual>& windows) {
  std::vector<double> gaps;
  for (std::size_t k = 1; k < windows.size(); ++k) gaps.push_back(windows[k].time_s - windows[k - 1].time_s);
  constexpr double kUsual_s = 0.02;
  return medianOf(std::move(gaps), kUsual_s);
}

const WindowResidual& nearestWindow(const std::vector<WindowResidual>& windows, double time_s) {
  return *std::min_element(windows.begin(), windows.end(), [time_s](const auto& a, const auto& b) {
    return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
  });
}

}  // namespace

ResidualsScreen::ResidualsScreen(QWidget* parent)
    : QWidget(parent), job_(new LatestJob(OutdatedWork::Dropped, this)), mark_soon_(new QTimer(this)) {
  mark_soon_->setSingleShot(true);
  mark_soon_->setInterval(kFrame_ms);
  connect(mark_soon_, &QTimer::timeout, this, &ResidualsScreen::markRejected);
  stack_ = stackWithNote(*this, makeContent(), noRunNote(false));
  connect(job_, &LatestJob::failed, this, [this](const QString& reason) {
    setNote(*stack_, tr("The residuals cannot be shown: %1").arg(reason));
    showPage(*stack_, StackPage::Note);
  });
}

ResidualsScreen::~ResidualsScreen() = default;

QWidget* ResidualsScreen::makeContent() {
  auto* const content = new QWidget;
  auto* const grid = new QGridLayout(content);
  grid->setContentsMargins(8, 8, 8, 8);
  grid->setSpacing(8);
  makeScatter();
  makeWindows();
  histogram_ = new PlotPanel(
      {.title = tr("Distribution"), .x_label = tr("residual / its sigma"), .y_label = tr("density")});
  histogram_->addSeries(Kind::Bars, {.name = tr("points"), .colour = PlotColour::Accent, .opacity = 0.55});
  histogram_->addSeries(Kind::Line, {.name = tr("as stated"), .colour = PlotColour::Text, .width_px = 1.6});
  histogram_->addSeries(
      Kind::Line, {.name = tr("fitted"), .colour = PlotColour::Warning, .width_px = 1.6, .dashed = true});
  image_ = new PlotPanel({.title = tr("Over the sensor"),
                          .x_label = tr("x (px)"),
                          .y_label = tr("y (px)"),
                          .downward_y = true,
                          .equal_scale = true});
  grid->addWidget(makeBar(), 0, 0, 1, 2);
  grid->addWidget(scatter_, 1, 0);
  grid->addWidget(histogram_, 1, 1);
  grid->addWidget(windows_, 2, 0);
  grid->addWidget(image_, 2, 1);
  for (const int k : {0, 1}) {
    grid->setColumnStretch(k, 1);
    grid->setRowStretch(1 + k, 1);
  }
  return content;
}

QWidget* ResidualsScreen::makeBar() {
  auto* const bar = new QWidget;
  auto* const layout = new QHBoxLayout(bar);
  layout->setContentsMargins(2, 0, 2, 0);
  camera_ = new QComboBox;
  camera_->setToolTip(tr("Camera whose residuals are shown"));
  camera_label_ = new QLabel(tr("&Camera"));
  camera_label_->setBuddy(camera_);
  threshold_ = new DecimalBox;
  threshold_->setDecimals(3);
  threshold_->setRange(0.0, 1000.0);
  threshold_->setSingleStep(0.005);
  threshold_->setSuffix(" px");
  threshold_->setToolTip(
      tr("Event windows with a larger RMS of their points are marked. The line in the chart of windows "
         "can also be dragged."));
  auto* const threshold_label = new QLabel(tr("Reject &above"));
  threshold_label->setBuddy(threshold_);
  count_ = new QLabel;
  count_->setForegroundRole(QPalette::PlaceholderText);
  recalibrate_ = new QPushButton(tr("&Reject and recalibrate"));
  recalibrate_->setToolTip(
      tr("Calibrates again without the marked event windows; detections are not repeated"));
  for (QWidget* widget :
       std::initializer_list<QWidget*>{camera_label_, camera_, threshold_label, threshold_, count_})
    layout->addWidget(widget);
  layout->addStretch(1);
  show_window_ = new QToolButton;
  show_window_->setText(tr("Show window"));
  show_window_->setToolTip(
      tr("Shows the event window at the cursor on Detection; click a point or a bar to choose one"));
  show_window_->setEnabled(false);
  layout->addWidget(show_window_);
  layout->addWidget(makeSaveButton(*this, "residuals"));
  layout->addWidget(recalibrate_);
  connect(camera_, &QComboBox::activated, this, [this] { compute(); });
  connect(threshold_, &QDoubleSpinBox::valueChanged, this, &ResidualsScreen::setThreshold);
  connect(show_window_, &QToolButton::clicked, this, [this] {
    if (const WindowResidual* const window = windowAtCursor())
      emit windowWanted(camera(), viewTime_s(window->view));
  });
  connect(recalibrate_, &QPushButton::clicked, this, [this] { emit recalibrateWithout(rejectedWindows()); });
  return bar;
}

void ResidualsScreen::makeScatter() {
  scatter_ = new PlotPanel({.title = tr("Residuals"),
                            .x_label = tr("predicted - measured, x (px)"),
                            .y_label = tr("y (px)"),
                            .downward_y = true,
                            .equal_scale = true});
  scatter_series_.dropped = scatter_->addSeries(
      Kind::Points, {.name = tr("dropped"), .colour = PlotColour::Faint, .width_px = 3.0});
  scatter_series_.used = scatter_->addSeries(
      Kind::Points, {.name = tr("used"), .colour = PlotColour::Accent, .width_px = 3.0, .opacity = 0.6});
  scatter_series_.rejected =
      scatter_->addSeries(Kind::Points, {.name = tr("marked"), .colour = PlotColour::Bad, .width_px = 3.0});
  scatter_series_.now = scatter_->addSeries(
      Kind::Points, {.name = tr("at cursor"), .colour = PlotColour::Warning, .width_px = 6.0});
  for (int k = 0; k < 3; ++k) {
    scatter_series_.ellipses[k] = scatter_->addSeries(
        Kind::Outline,
        {.name = tr("%1 sigma").arg(k + 1), .colour = PlotColour::Text, .width_px = 1.4, .in_legend = false});
  }
  scatter_help_ = scatter_->toolTip();
  connect(scatter_, &PlotPanel::clicked, this, &ResidualsScreen::selectNearest);
}

void ResidualsScreen::makeWindows() {
  windows_ = new PlotPanel({.title = tr("Event windows"),
                            .x_label = tr("time (s)"),
                            .y_label = tr("RMS of an event window (px)"),
                            .time = true});
  window_series_.kept = windows_->addSeries(Kind::Bars, {.name = tr("kept"), .colour = PlotColour::Accent});
  window_series_.rejected =
      windows_->addSeries(Kind::Bars, {.name = tr("marked"), .colour = PlotColour::Bad});
  connect(windows_, &PlotPanel::thresholdDragged, this, &ResidualsScreen::setThreshold);
  connect(windows_, &PlotPanel::clicked, this, [this](double time_s) {
    if (!statistics_ || statistics_->windows.empty()) return;
    selectView(nearestWindow(statistics_->windows, time_s).view);
  });
}

void ResidualsScreen::setRun(std::shared_ptr<const CalibrationRun> run) {
  run_ = std::move(run);
  statistics_.reset();
  camera_->clear();
  if (run_) {
    for (const BoardObservations& camera : run_->detections.cameras)
      camera_->addItem(QString::fromStdString(camera.camera));
  }
  camera_->setVisible(camera_->count() > 1);
  camera_label_->setVisible(camera_->count() > 1);
  showNote();
  showPage(*stack_, StackPage::Note);
  compute();
}

void ResidualsScreen::showNote() {
  setNote(*stack_, run_ ? tr("Sorting the residuals ...") : noRunNote(calibrating_));
}

void ResidualsScreen::setCalibrating(bool calibrating) {
  calibrating_ = calibrating;
  showNote();
}

int ResidualsScreen::camera() const {
  return std::max(0, camera_->currentIndex());
}

void ResidualsScreen::compute() {
  if (!run_ || camera_->count() == 0) return job_->discard();
  const int wanted = camera();
  const auto detection_intrinsics =
      run_->detections.lenses.at(static_cast<std::size_t>(wanted)).detection_intrinsics;
  job_->start([this, run = run_, wanted, detection_intrinsics](const std::stop_token&) {
    const auto statistics = std::make_shared<const ResidualStatistics>(
        residualStatistics(run->result.circle_residuals, wanted, detection_intrinsics));
    return [this, statistics] {
      statistics_ = statistics;
      draw();
    };
  });
}

void ResidualsScreen::draw() {
  if (statistics_->used.empty()) {
    setNote(*stack_, tr("The calibration used no points of this camera."));
    showPage(*stack_, StackPage::Note);
    return;
  }
  showPage(*stack_, StackPage::Content);
  for (PlotPanel* panel : {scatter_, histogram_, windows_, image_}) panel->clear();
  drawScatter();
  drawHistogram();
  drawImagePlane();
  drawWindows();
  markTime();
  emit ready();
}

void ResidualsScreen::drawScatter() {
  const auto all = [](const CircleResidual&) { return true; };
  const std::size_t every = statistics_->used.size() / kMaxPoints + 1;
  std::size_t next = 0;
  scatter_->setLine(scatter_series_.used,
                    points(statistics_->used, [&](const CircleResidual&) { return next++ % every == 0; }));
  scatter_->setLine(scatter_series_.dropped, points(statistics_->dropped, all));
  for (int k = 0; k < 3; ++k) {
    std::vector<double> x, y;
    for (const Eigen::Vector2d& point :
         sigmaEllipse(statistics_->mean_px, statistics_->covariance_px2, k + 1.0)) {
      x.push_back(point.x());
      y.push_back(point.y());
    }
    scatter_->setData(scatter_series_.ellipses[k], x, y);
  }
  const Eigen::Vector2d sigma = statistics_->covariance_px2.diagonal().cwiseSqrt();
  scatter_->setNote(tr("\u03c3 %1, %2 px").arg(sigma.x(), 0, 'g', 3).arg(sigma.y(), 0, 'g', 3));
  const QString thinned = every > 1 ? tr("One of %1 used points is drawn.\n").arg(every) : QString();
  scatter_->setToolTip(thinned + scatter_help_);
  const double reach = kScatterReach * std::max(sigma.maxCoeff(), 1e-6);
  scatter_->setXRange(-reach, reach);
  scatter_->setYRange(-reach, reach);
}

void ResidualsScreen::drawHistogram() {
  constexpr int kCurvePoints = 200;
  const ResidualStatistics& s = *statistics_;
  histogram_->setData(0, s.bin_middle, s.bin_density);
  histogram_->setBarWidth(0, s.bin_width);
  const double reach = s.bin_middle.back();
  std::vector<double> x, stated, fitted;
  for (int k = 0; k <= kCurvePoints; ++k) {
    x.push_back(reach * (2.0 * k / kCurvePoints - 1.0));
    stated.push_back(normalDensity(x.back(), 0.0, 1.0));
    fitted.push_back(normalDensity(x.back(), s.normalised_mean, std::max(s.normalised_std, 1e-9)));
  }
  histogram_->setData(1, x, stated);
  histogram_->setData(2, x, fitted);
  const double mean = std::abs(s.normalised_mean) < 0.005 ? 0.0 : s.normalised_mean;  // no "-0.00"
  histogram_->setNote(tr("spread %1, mean %2").arg(s.normalised_std, 0, 'f', 2).arg(mean, 0, 'f', 2));
  histogram_->fit();
}

void ResidualsScreen::drawWindows() {
  const double width = kShareOfWindowSpacing * windowSpacing(statistics_->windows);
  windows_->setBarWidth(window_series_.kept, width);
  windows_->setBarWidth(window_series_.rejected, width);
  double largest_px = 0.0;
  for (const WindowResidual& window : statistics_->windows) largest_px = std::max(largest_px, window.rms_px);
  {
    const QSignalBlocker quiet(threshold_);
    threshold_->setValue(kAboveAll * largest_px);
  }
  windows_->setThreshold(threshold_->value());
  markRejected();
  windows_->fitWithin(statistics_->windows.front().time_s - width,
                      statistics_->windows.back().time_s + width);
}

void ResidualsScreen::drawImagePlane() {
  const ResidualStatistics& s = *statistics_;
  if (s.cells.empty()) return;
  PlotCells cells{
      QRectF(0.0, 0.0, s.resolution_px.width_px, s.resolution_px.height_px), s.columns, s.rows, {}};
  double longest_px = 0.0;
  int covered = 0;
  for (const auto& cell : s.cells) {
    cells.values.push_back(cell.count > 0 ? cell.count : std::numeric_limits<double>::quiet_NaN());
    covered += cell.count > 0;
    if (cell.count >= kMinForArrow) longest_px = std::max(longest_px, cell.mean_px.norm());
  }
  const double scale =
      longest_px > 0.0 ? static_cast<double>(s.resolution_px.width_px) / s.columns / longest_px : 0.0;
  std::vector<PlotArrow> arrows;
  for (const auto& cell : s.cells) {
    if (cell.count < kMinForArrow) continue;
    const Eigen::Vector2d half = 0.5 * scale * cell.mean_px, from = cell.middle_px - half,
                          to = cell.middle_px + half;
    arrows.push_back({{from.x(), from.y()}, {to.x(), to.y()}});
  }
  image_->setCells(cells, PlotColour::Accent);
  image_->setArrows(arrows, PlotColour::Text);
  image_->setNote(tr("%1 % covered; arrows: mean residual, longest %2 px")
                      .arg(100 * covered / static_cast<int>(s.cells.size()))
                      .arg(longest_px, 0, 'g', 2));
  image_->fit();
}

double ResidualsScreen::threshold_px() const {
  return threshold_->value();
}

void ResidualsScreen::setThreshold(double rms_px) {
  {
    const QSignalBlocker quiet(threshold_);
    threshold_->setValue(rms_px);
  }
  windows_->setThreshold(threshold_->value());
  if (!mark_soon_->isActive()) mark_soon_->start();
  emit thresholdChanged(threshold_->value());
}

std::vector<int> ResidualsScreen::rejectedWindows() const {
  std::vector<int> views;
  if (!statistics_) return views;
  for (const WindowResidual& window : statistics_->windows) {
    if (window.rms_px > threshold_px()) views.push_back(window.view);
  }
  return views;
}

void ResidualsScreen::markRejected() {
  if (!statistics_) return;
  std::vector<double> kept_s, kept_px, rejected_s, rejected_px;
  for (const WindowResidual& window : statistics_->windows) {
    const bool rejected = window.rms_px > threshold_px();
    (rejected ? rejected_s : kept_s).push_back(window.time_s);
    (rejected ? rejected_px : kept_px).push_back(window.rms_px);
  }
  windows_->setData(window_series_.kept, kept_s, kept_px);
  windows_->setData(window_series_.rejected, rejected_s, rejected_px);
  const std::vector<int> views = rejectedWindows();
  scatter_->setLine(scatter_series_.rejected, points(statistics_->used, [&](const CircleResidual& residual) {
                      return std::binary_search(views.begin(), views.end(), residual.view);
                    }));
  count_->setText(tr("%1 of %2 windows").arg(views.size()).arg(statistics_->windows.size()));
  recalibrate_->setEnabled(!views.empty() && views.size() < statistics_->windows.size());
}

void ResidualsScreen::setTime(double time_s) {
  time_s_ = time_s;
  windows_->setCursorLine(time_s);
  markTime();
}

const WindowResidual* ResidualsScreen::windowAtCursor() const {
  if (!statistics_ || statistics_->windows.empty() || time_s_ < 0.0) return nullptr;
  const auto away_s = [this](const WindowResidual& window) {
    return std::abs(viewTime_s(window.view) - time_s_);
  };
  const auto& windows = statistics_->windows;
  const auto nearest = std::min_element(windows.begin(), windows.end(),
                                        [&](const auto& a, const auto& b) { return away_s(a) < away_s(b); });
  return away_s(*nearest) <= windowSpacing(windows) ? &*nearest : nullptr;
}

void ResidualsScreen::markTime() {
  const WindowResidual* const window = windowAtCursor();
  show_window_->setEnabled(window != nullptr);
  if (!statistics_ || statistics_->windows.empty() || time_s_ < 0.0) return;
  scatter_->setLine(scatter_series_.now, points(statistics_->used, [window](const CircleResidual& residual) {
                      return window != nullptr && residual.view == window->view;
                    }));
}

// A view's circles have their own times, which may be in another window.
double ResidualsScreen::viewTime_s(int view) const {
  return run_->detections.cameras.at(static_cast<std::size_t>(camera()))
      .views.at(static_cast<std::size_t>(view))
      .time_s;
}

void ResidualsScreen::selectView(int view) {
  const double time_s = viewTime_s(view);
  setTime(time_s);
  emit timeSelected(time_s);
}

void ResidualsScreen::selectNearest(double x_px, double y_px) {
  if (!statistics_ || statistics_->used.empty()) return;
  const Eigen::Vector2d at(x_px, y_px);
  const auto nearest =
      std::min_element(statistics_->used.begin(), statistics_->used.end(),
                       [&](const CircleResidual& a, const CircleResidual& b) {
                         return (a.residual_px - at).squaredNorm() < (b.residual_px - at).squaredNorm();
                       });
  selectView(nearest->view);
}

}  // namespace evical::ui
