// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/signals_screen.h"

#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/rotation_rates.h"
#include "core/report/residual_statistics.h"
#include "ui/jobs/latest_job.h"
#include "ui/plots/chart_saving.h"
#include "ui/plots/empty_note.h"
#include "ui/plots/plot_panel.h"
#include "ui/plots/signal_tab.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QStackedLayout>
#include <QTabBar>
#include <QTabWidget>
#include <QToolButton>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

using Kind = PlotPanel::SeriesKind;

QComboBox* addBox(QHBoxLayout& layout, QLabel*& label, const QString& name, const QString& tip) {
  auto* const box = new QComboBox;
  box->setToolTip(tip);
  label = new QLabel(name);
  label->setBuddy(box);
  layout.addWidget(label);
  layout.addWidget(box);
  return box;
}

}  // namespace

struct SignalsScreen::Drawing {
  SignalLines gyroscope, accelerometer;
  RotationRates rates;
};

SignalsScreen::SignalsScreen(QWidget* parent)
    : QWidget(parent), job_(new LatestJob(OutdatedWork::Dropped, this)) {
  auto* const content = new QWidget;
  auto* const layout = new QVBoxLayout(content);
  layout->setContentsMargins(8, 8, 8, 8);
  tabs_ = new QTabWidget;
  tabs_->setDocumentMode(true);
  tabs_->tabBar()->setDrawBase(false);
  gyroscope_ = addSignalTab(tr("&Gyroscope"), new SignalTab(tr("Angular rate"), "rad/s"));
  accelerometer_ = addSignalTab(tr("&Accelerometer"), new SignalTab(tr("Specific force"), "m/s\u00b2"));
  tabs_->addTab(makeRatesTab(), tr("&Camera against IMU"));
  tabs_->setCornerWidget(makeBar());
  layout->addWidget(tabs_);
  PlotPanel::linkX(panels_);
  gyroscope_->setObjectName("gyroscope_tab");
  gyroscope_->signal()->setObjectName("gyroscope");
  accelerometer_->signal()->setObjectName("accelerometer");
  stack_ = stackWithNote(*this, content, noRunNote(false));
  connect(job_, &LatestJob::failed, this, [this](const QString& reason) {
    setNote(*stack_, tr("The signals cannot be shown: %1").arg(reason));
    showPage(*stack_, StackPage::Note);
  });
}

SignalTab* SignalsScreen::addSignalTab(const QString& title, SignalTab* tab) {
  tabs_->addTab(tab, title);
  for (PlotPanel* const panel : tab->overTime()) addToTime(panel);
  return tab;
}

PlotPanel* SignalsScreen::addPanel(const QString& title, const QString& unit) {
  auto* const panel =
      new PlotPanel({.title = title, .x_label = tr("time (s)"), .y_label = unit, .time = true});
  addToTime(panel);
  return panel;
}

// All have the same cursor and range.
void SignalsScreen::addToTime(PlotPanel* panel) {
  connect(panel, &PlotPanel::clicked, this, [this](double time_s) {
    setTime(time_s);
    emit timeSelected(time_s);
  });
  panels_.push_back(panel);
}

QWidget* SignalsScreen::makeRatesTab() {
  before_ = addPanel(tr("Rotation rate before the time offset"), "rad/s");
  after_ = addPanel(tr("Rotation rate after the time offset"), "rad/s");
  difference_ = addPanel(tr("Camera - IMU"), "rad/s");
  for (PlotPanel* panel : {before_, after_}) {
    panel->addSeries(Kind::Line,
                     {.name = tr("camera"), .colour = PlotColour::Accent, .width_px = 4.0, .opacity = 0.45});
    panel->addSeries(Kind::Line, {.name = tr("IMU"), .colour = PlotColour::Warning, .width_px = 1.4});
  }
  difference_->addSeries(Kind::Line, {.name = tr("before"), .colour = PlotColour::Bad, .opacity = 0.7});
  difference_->addSeries(Kind::Line, {.name = tr("after"), .colour = PlotColour::Good});
  auto* const page = new QWidget;
  auto* const layout = new QVBoxLayout(page);
  layout->setContentsMargins(0, 8, 0, 0);
  for (PlotPanel* panel : {before_, after_, difference_}) layout->addWidget(panel, 1);
  return page;
}

QWidget* SignalsScreen::makeBar() {
  auto* const bar = new QWidget;
  auto* const layout = new QHBoxLayout(bar);
  layout->setContentsMargins(0, 0, 0, 2);
  camera_ =
      addBox(*layout, camera_label_, tr("Ca&mera"), tr("Camera whose clock and rotation rate are shown"));
  imu_ = addBox(*layout, imu_label_, tr("&IMU"), tr("IMU whose signals are shown"));
  QLabel* below_label = nullptr;
  below_ = addBox(*layout, below_label, tr("&Below"), tr("View of measured - predicted"));
  below_->setObjectName("below");
  below_->addItems(SignalTab::looks());
  connect(below_, &QComboBox::currentIndexChanged, this, [this](int look) {
    for (SignalTab* const tab : {gyroscope_, accelerometer_}) tab->lookAt(look);
  });
  layout->addWidget(makeSaveButton(*this, "signals"));
  for (QComboBox* box : {camera_, imu_}) connect(box, &QComboBox::activated, this, [this] { compute(); });
  return bar;
}

void SignalsScreen::setRun(std::shared_ptr<const CalibrationRun> run, const Session& session) {
  run_ = std::move(run);
  session_ = session;
  camera_->clear();
  imu_->clear();
  if (run_) {
    for (const BoardObservations& camera : run_->detections.cameras)
      camera_->addItem(QString::fromStdString(camera.camera));
    for (const ImuData& imu : run_->detections.imus) imu_->addItem(QString::fromStdString(imu.name));
    imu_->setCurrentIndex(static_cast<int>(session_.referenceImu()));
  }
  for (const auto& [box, label] : {std::pair{camera_, camera_label_}, std::pair{imu_, imu_label_}}) {
    box->setVisible(box->count() > 1);
    label->setVisible(box->count() > 1);
  }
  showNote();
  showPage(*stack_, StackPage::Note);
  compute();
}

void SignalsScreen::showNote() {
  setNote(*stack_, !run_                ? noRunNote(calibrating_)
                   : imu_->count() == 0 ? tr("There is no IMU with signals to compare.")
                                        : tr("Computing the signals ..."));
}

void SignalsScreen::setCalibrating(bool calibrating) {
  calibrating_ = calibrating;
  showNote();
}

void SignalsScreen::compute() {
  if (!run_ || camera_->count() == 0 || imu_->count() == 0) return job_->discard();
  const auto camera = static_cast<std::size_t>(camera_->currentIndex());
  const auto imu = static_cast<std::size_t>(imu_->currentIndex());
  job_->start([this, run = run_, session = session_, camera, imu](const std::stop_token& stop) {
    const RunContext context{silentProgress(), stop};
    const CalibrationState& state = run->result.state;
    const ImuData& samples = run->detections.imus[imu];
    SignalPrediction prediction = predictSignals(samples, run->detections.start_ns, state, imu, context);
    for (SensorSignal* const signal : {&prediction.rate_rad_s, &prediction.force_m_s2})
      for (double& time_s : signal->time_s)
        time_s = sensorTime_s(state.cameras[camera], referenceTime_s(state.imus[imu], time_s));
    const auto drawing = std::make_shared<Drawing>();
    drawing->gyroscope =
        makeSignalLines(prediction.rate_rad_s, samples.rate_hz(), samples.noise.gyroscope_density);
    drawing->accelerometer = makeSignalLines(prediction.force_m_s2, samples.accelerometerRate_hz(),
                                             samples.noise.accelerometer_density);
    const CameraLens& lens = run->detections.lenses.at(camera);
    if (lens.detection_intrinsics) {
      drawing->rates = rotationRates({session.cameras[camera].name, lens, run->detections.cameras[camera]},
                                     session.boardOf(camera), state.cameras[camera], samples, state.imus[imu],
                                     run->detections.start_ns, *session.options.initialisation, context);
    }
    return [this, drawing] { draw(*drawing); };
  });
}

void SignalsScreen::draw(const Drawing& drawing) {
  gyroscope_->setLines(drawing.gyroscope);
  accelerometer_->setLines(drawing.accelerometer);

  const RotationRates& rates = drawing.rates;
  const auto camera_line = makePlotLine(rates.time_s, rates.camera_rad_s);
  before_->setLine(0, camera_line);
  before_->setLine(1, makePlotLine(rates.time_s, rates.imu_before_rad_s));
  after_->setLine(0, camera_line);
  after_->setLine(1, makePlotLine(rates.time_s, rates.imu_after_rad_s));
  std::vector<double> before, after;
  for (std::size_t k = 0; k < rates.time_s.size(); ++k) {
    before.push_back(rates.camera_rad_s[k] - rates.imu_before_rad_s[k]);
    after.push_back(rates.camera_rad_s[k] - rates.imu_after_rad_s[k]);
  }
  difference_->setData(0, rates.time_s, before);
  difference_->setData(1, rates.time_s, after);
  difference_->setNote(tr("RMS %1 rad/s before, %2 rad/s after")
                           .arg(rates.rmsDifferenceBefore_rad_s(), 0, 'g', 3)
                           .arg(rates.rmsDifferenceAfter_rad_s(), 0, 'g', 3));
  showPage(*stack_, StackPage::Content);
  for (PlotPanel* panel : panels_) panel->fitWithin(drawing.gyroscope.begin_s, drawing.gyroscope.end_s);
  emit ready();
}

void SignalsScreen::setTime(double time_s) {
  for (PlotPanel* panel : panels_) panel->setCursorLine(time_s);
  const auto [low, high] = panels_.front()->xRange();
  if (time_s >= low && time_s <= high) return;
  const double half = 0.5 * (high - low);
  panels_.front()->setXRange(time_s - half, time_s + half);
}

}  // namespace evical::ui
