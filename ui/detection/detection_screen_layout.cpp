// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/detection_engine.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/event_view.h"
#include "ui/detection/timeline.h"
#include "ui/detection/window_list.h"
#include "ui/detection/window_panel.h"
#include "ui/forms/number_field.h"
#include "ui/theme/plain_labels.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLinearGradient>
#include <QPainter>
#include <QPixmap>
#include <QToolButton>
#include <QVBoxLayout>

#include <array>

namespace evical::ui {
namespace {

// In the order of the page. The first ones are always offered, the others behind a button.
constexpr std::array kLayerOrder = {Layer::Ellipses,   Layer::Centres, Layer::Grid,
                                    Layer::Prediction, Layer::Flow,    Layer::Clusters,
                                    Layer::Pairs,      Layer::Circles, Layer::Reprojection};
static_assert(kLayerOrder.size() == kLayerCount);
constexpr std::size_t kFirstLayers = 4;

// Several colours are drawn side by side.
QIcon swatch(const std::vector<QColor>& colours, double pixel_ratio) {
  constexpr int kSize_px = 12;
  QPixmap pixmap(static_cast<int>(kSize_px * pixel_ratio), static_cast<int>(kSize_px * pixel_ratio));
  pixmap.setDevicePixelRatio(pixel_ratio);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  QLinearGradient stripes(0.0, 0.0, kSize_px, 0.0);
  const auto count = static_cast<double>(colours.size());
  constexpr double kSharp = 1e-3;
  for (std::size_t k = 0; k < colours.size(); ++k) {
    stripes.setColorAt(static_cast<double>(k) / count, colours[k]);
    stripes.setColorAt(static_cast<double>(k + 1) / count - kSharp, colours[k]);
  }
  stripes.setColorAt(1.0, colours.back());
  painter.setBrush(stripes);
  painter.drawRoundedRect(QRectF(0.5, 0.5, kSize_px - 1.0, kSize_px - 1.0), 3.0, 3.0);
  return pixmap;
}

QLabel* sectionTitle(const QString& text) {
  auto* label = new QLabel(text);
  QFont font = label->font();
  font.setBold(true);
  label->setFont(font);
  return label;
}

}  // namespace

DetectionScreen::DetectionScreen(QWidget* parent) : QWidget(parent) {
  view_ = new EventView;
  timeline_ = new Timeline;
  auto* middle = new QHBoxLayout;
  middle->setSpacing(8);
  companion_view_ = new EventView;
  companion_view_->hide();
  middle->addWidget(view_, 1);
  middle->addWidget(companion_view_, 1);
  makeWindowList();
  side_ = makeSidePanel();
  sides_ = new QBoxLayout(QBoxLayout::LeftToRight);
  sides_->setSpacing(8);
  sides_->addWidget(list_, 2);
  sides_->addWidget(side_, 1);
  middle->addLayout(sides_);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 6, 8, 4);
  layout->setSpacing(4);
  layout->addWidget(makeToolBar());
  layout->addLayout(middle, 1);
  layout->addWidget(makeTransport());
  layout->addWidget(timeline_);
  connectEngine();
  adaptTo(CameraKind::Events);
  applyColours();
  chooseCamera(0);
  setFocusProxy(view_);
  layOutSides();
  addKeys();
}

QToolButton* DetectionScreen::addButton(QHBoxLayout* row, const QString& icon_name, const QString& help) {
  auto* button = new QToolButton;
  button->setAutoRaise(true);
  button->setToolTip(help);
  button->setAccessibleName(help);
  row->addWidget(button);
  icons_.emplace_back(button, icon_name);
  return button;
}

QWidget* DetectionScreen::makeToolBar() {
  auto* bar = new QWidget;
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 0, 0);
  mode_box_ = new QComboBox;
  mode_box_->addItems({tr("Time surface"), tr("Accumulated events"), tr("Normal flow")});
  mode_box_->setToolTip(
      tr("Time surface: newest event of each pixel, fading with age.\nAccumulated events: all of "
         "the window.\nNormal flow: edges, coloured by their direction of motion"));
  fade_box_ = new DecimalBox;
  fade_box_->setRange(1.0, 200.0);
  fade_box_->setDecimals(0);
  fade_box_->setValue(15.0);
  fade_box_->setSuffix(tr(" ms"));
  fade_box_->setToolTip(tr("Time after which an event has faded to a third"));
  camera_box_ = new QComboBox;
  camera_box_->setToolTip(tr("Camera"));
  camera_box_->setAccessibleName(tr("Camera"));
  mode_box_->setAccessibleName(tr("Drawing of events"));
  fade_box_->setAccessibleName(tr("Fading time of events"));
  camera_box_->hide();
  picture_box_ = new QComboBox;
  picture_box_->setObjectName("picture_choice");
  picture_box_->setAccessibleName(tr("Pictures"));
  picture_box_->addItems({{}, tr("Side by side"), tr("Events over frame")});
  picture_box_->hide();
  row->addWidget(camera_box_);
  row->addWidget(picture_box_);
  row->addWidget(mode_box_);
  fade_label_ = new QLabel(tr("fading"));
  row->addWidget(fade_label_);
  row->addWidget(fade_box_);
  row->addStretch(1);
  addListButton(row);
  status_ = new QLabel;
  keepSize(*status_, tr("not readable to the end"));
  row->addWidget(status_);
  connect(addButton(row, "zoom-out", tr("Zoom out (-)")), &QToolButton::clicked, this,
          [this] { view_->zoomBy(0.5, QRectF(view_->rect()).center()); });
  connect(addButton(row, "zoom-in", tr("Zoom in (+), or turn the wheel over the picture")),
          &QToolButton::clicked, this, [this] { view_->zoomBy(2.0, QRectF(view_->rect()).center()); });
  connect(addButton(row, "zoom-fit", tr("Whole sensor (F)")), &QToolButton::clicked, view_, &EventView::fit);
  connect(mode_box_, &QComboBox::currentIndexChanged, this, [this](int mode) {
    const bool fades = static_cast<SurfaceMode>(mode) == SurfaceMode::Decayed;
    fade_box_->setEnabled(fades);
    fade_label_->setEnabled(fades);
    request();
  });
  connect(fade_box_, &QDoubleSpinBox::valueChanged, this, [this] { request(); });
  connect(camera_box_, &QComboBox::currentIndexChanged, this,
          [this](int camera) { chooseCamera(static_cast<std::size_t>(std::max(0, camera))); });
  return bar;
}

QWidget* DetectionScreen::makeSidePanel() {
  auto* side = new QWidget;
  auto* column = new QVBoxLayout(side);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  column->addWidget(makeLayers());
  verdict_title_ = sectionTitle({});
  column->addWidget(verdict_title_);
  panel_ = new WindowPanel;
  column->addWidget(panel_, 1);
  return side;
}

QWidget* DetectionScreen::makeLayers() {
  layers_part_ = new QWidget;
  auto* column = new QVBoxLayout(layers_part_);
  column->setContentsMargins(0, 0, 0, 6);
  column->setSpacing(2);
  column->addWidget(sectionTitle(tr("Layers")));
  layer_grid_ = new QGridLayout;
  layer_grid_->setVerticalSpacing(2);
  layer_boxes_.resize(kLayerCount);
  for (const Layer layer : kLayerOrder) {
    const auto k = static_cast<std::size_t>(layer);
    const LayerWords words = layerWords(layer);
    auto* box = new QCheckBox(words.name, layers_part_);
    box->setToolTip(words.help);
    box->setChecked(layers_.test(k));
    connect(box, &QCheckBox::toggled, this, [this, k](bool on) {
      layers_.set(k, on);
      request();
      refresh();
    });
    layer_boxes_[k] = box;
  }
  column->addLayout(layer_grid_);
  layer_boxes_[static_cast<std::size_t>(Layer::Reprojection)]->setEnabled(false);
  more_layers_ = new QToolButton;
  more_layers_->setObjectName("more_layers");
  more_layers_->setCheckable(true);
  connect(more_layers_, &QToolButton::toggled, this, &DetectionScreen::layOutLayers);
  column->addWidget(more_layers_, 0, Qt::AlignLeft);
  return layers_part_;
}

// Visible layers are offered in any case, so that they can be hidden.
void DetectionScreen::layOutLayers() {
  const bool frames = framesInView(), more = more_layers_->isChecked();
  int place = 0;
  for (std::size_t i = 0; i < kLayerOrder.size(); ++i) {
    const Layer layer = kLayerOrder[i];
    QCheckBox* const box = layer_boxes_[static_cast<std::size_t>(layer)];
    const bool offered = frames ? isOfFrames(layer) : i < kFirstLayers || more || shown(layer);
    layer_grid_->removeWidget(box);
    box->setVisible(offered);
    if (!offered) continue;
    layer_grid_->addWidget(box, place / 2, place % 2);
    ++place;
  }
  more_layers_->setVisible(!frames);
  more_layers_->setText(more ? tr("Fewer layers") : tr("More layers"));
}

QWidget* DetectionScreen::makeTransport() {
  auto* bar = new QWidget;
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(4);
  connect(addButton(row, "to-start", tr("To the start (Home)")), &QToolButton::clicked, this,
          [this] { select(timeline_->begin_s()); });
  connect(addButton(row, "step-back", tr("Previous event window or frame (Left)")), &QToolButton::clicked,
          this, [this] { step(-1); });
  play_button_ = addButton(row, "play", tr("Play (Space)"));
  connect(play_button_, &QToolButton::clicked, this, [this] { setPlaying(!isPlaying()); });
  connect(addButton(row, "step-forward", tr("Next event window or frame (Right)")), &QToolButton::clicked,
          this, [this] { step(+1); });
  connect(addButton(row, "to-end", tr("To the end (End)")), &QToolButton::clicked, this,
          [this] { select(timeline_->end_s()); });
  speed_box_ = new QComboBox;
  constexpr std::array kSpeeds = {0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0};
  for (const double speed : kSpeeds)
    speed_box_->addItem(
        speed < 1.0 ? tr("1/%1 speed").arg(1.0 / speed, 0, 'f', 0) : tr("%1 x speed").arg(speed), speed);
  speed_box_->setCurrentIndex(3);
  speed_box_->setAccessibleName(tr("Playback speed"));
  speed_box_->setToolTip(tr("Playback speed, relative to the recording"));
  row->addWidget(speed_box_);
  time_box_ = new DecimalBox;
  time_box_->setDecimals(4);
  time_box_->setRange(0.0, 0.0);
  time_box_->setSingleStep(0.001);
  time_box_->setSuffix(tr(" s"));
  time_box_->setKeyboardTracking(false);
  time_box_->setToolTip(tr("Cursor, in seconds since the recording's start"));
  time_box_->setAccessibleName(tr("Cursor in seconds"));
  connect(time_box_, &QDoubleSpinBox::valueChanged, this, [this](double time_s) { select(time_s); });
  row->addWidget(time_box_);
  row->addSpacing(8);
  addMissedButtons(row);
  row->addStretch(1);
  follow_button_ = addButton(row, "follow", tr("Show the event windows during the detection"));
  follow_button_->setText(tr("Follow the run"));
  follow_button_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  follow_button_->setCheckable(true);
  follow_button_->hide();
  connect(follow_button_, &QToolButton::clicked, this, [this](bool on) {
    following_ = on;
    request();
  });
  return bar;
}

void DetectionScreen::adaptTo(CameraKind kind) {
  if (layer_grid_->count() > 0 && kind == kind_) return;
  kind_ = kind;
  const bool frames = framesInView();
  mode_box_->setVisible(!frames);
  verdict_title_->setText(frames ? tr("This frame") : tr("This event window"));
  view_->setAccessibleName(frames ? tr("Frame") : tr("Events"));
  layOutLayers();
}

void DetectionScreen::applyColours() {
  if (!engine_) return;
  for (const auto& [button, name] : icons_) button->setIcon(icon(name));
  if (isPlaying()) play_button_->setIcon(icon("pause"));
  for (std::size_t k = 0; k < layer_boxes_.size(); ++k)
    layer_boxes_[k]->setIcon(swatch(layerColours(static_cast<Layer>(k)), devicePixelRatioF()));
  showPictures();
  request();
  refresh();
}

}  // namespace evical::ui
