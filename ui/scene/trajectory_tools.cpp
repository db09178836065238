// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/trajectory_tools.h"

#include "ui/forms/flow_layout.h"
#include "ui/theme/theme.h"

#include <QAction>
#include <QComboBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QStandardItemModel>
#include <QToolButton>

namespace evical::ui {

TrajectoryTools::TrajectoryTools(QWidget* parent) : QWidget(parent) {
  auto* const row = new FlowLayout(this);
  row->setContentsMargins(6, 4, 6, 4);
  row->setSpacing(4);
  addColours();
  addLayers();
  addViews();
  addFollowing();
  addSaving();
  applyIcons();
}

QToolButton* TrajectoryTools::addButton(const QString& text, const QString& icon_name, const QString& help) {
  auto* const button = new QToolButton(this);
  button->setText(text);
  button->setToolTip(help);
  button->setAccessibleName(text);
  button->setAutoRaise(true);
  button->setToolButtonStyle(icon_name.isEmpty() ? Qt::ToolButtonTextOnly : Qt::ToolButtonTextBesideIcon);
  if (!icon_name.isEmpty()) icons_.emplace_back(button, icon_name);
  layout()->addWidget(button);
  return button;
}

void TrajectoryTools::applyIcons() {
  for (const auto& [button, name] : icons_) button->setIcon(icon(name));
}

void TrajectoryTools::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) applyIcons();
  QWidget::changeEvent(event);
}

void TrajectoryTools::addColours() {
  auto* const pair = new QWidget(this);  // keeps label and box together
  auto* const row = new QHBoxLayout(pair);
  row->setContentsMargins(2, 0, 2, 0);
  auto* const label = new QLabel(tr("&Colour by"), pair);
  colours_ = new QComboBox(pair);
  label->setBuddy(colours_);
  colours_->setAccessibleName(tr("Colour by"));
  colours_->addItems({tr("Speed"), tr("Residual")});
  colours_->setToolTip(
      tr("Quantity of the trajectory's colour: the IMU's speed, or the residual of the board's points in\n"
         "the nearest view (available after a calibration)"));
  connect(colours_, &QComboBox::activated, this,
          [this](int index) { emit colourChosen(static_cast<TrajectoryColour>(index)); });
  row->addWidget(label);
  row->addWidget(colours_);
  layout()->addWidget(pair);
  offerResiduals(false);
}

void TrajectoryTools::addLayers() {
  const std::array<std::pair<QString, QString>, kSceneLayerCount> texts = {{
      {tr("Board"), tr("The board with its pattern")},
      {tr("Trajectory"), tr("Trajectory of the IMU in the world, from the spline")},
      {tr("Cameras"), tr("The cameras at regular intervals")},
      {tr("Camera now"), tr("The cameras at the cursor's time")},
      {tr("IMU axes"), tr("The IMUs' axes at the cursor's time")},
      {tr("Poses of single views"),
       tr("Computed from single board views: they should scatter around the trajectory")},
      {tr("Gravity"), tr("Estimated direction of gravity")},
      {tr("Ground"), tr("A level grid below everything")},
      {tr("Board axes"), tr("x, y and z of the board's frame, which is the world frame")},
      {tr("Events now"),
       tr("The camera's events at the cursor's time, on the image plane of its viewing pyramid")},
  }};
  QToolButton* const button = addButton(tr("Layers"), "layers", tr("Visible layers"));
  button->setPopupMode(QToolButton::InstantPopup);
  auto* const menu = new QMenu(button);
  menu->setToolTipsVisible(true);
  for (std::size_t k = 0; k < texts.size(); ++k) {
    layers_[k] = menu->addAction(texts[k].first);
    layers_[k]->setToolTip(texts[k].second);
    layers_[k]->setCheckable(true);
    layers_[k]->setChecked(true);
    connect(layers_[k], &QAction::triggered, this,
            [this, k](bool checked) { emit layerToggled(static_cast<SceneLayer>(k), checked); });
  }
  button->setMenu(menu);
}

void TrajectoryTools::addViews() {
  const std::array<std::pair<QString, QString>, 4> texts = {
      {{tr("Home"), tr("Everything, from the side above (0)")},
       {tr("Front"), tr("Facing the board (1)")},
       {tr("Side"), tr("From the board's side (2)")},
       {tr("Top"), tr("From above (3)")}}};
  for (std::size_t k = 0; k < texts.size(); ++k) {
    QToolButton* const button = addButton(texts[k].first, k == 0 ? "home" : QString(), texts[k].second);
    connect(button, &QToolButton::clicked, this, [this, k] {
      leaveCamera();
      emit viewChosen(static_cast<StandardView>(k));
    });
  }
}

void TrajectoryTools::addFollowing() {
  follow_ = new QAction(tr("Follow camera"), this);
  follow_->setObjectName("follow");
  follow_->setToolTip(tr("Keep the camera in the middle (F)"));
  through_ = new QAction(tr("Through camera"), this);
  through_->setObjectName("through_camera");
  through_->setToolTip(tr("View from the camera; drag to leave (C)"));
  follow_->setShortcut(QKeySequence("F"));
  through_->setShortcut(QKeySequence("C"));
  for (QAction* action : {follow_, through_}) {
    action->setShortcutContext(Qt::WidgetWithChildrenShortcut);
    parentWidget()->addAction(action);  // works with any focus on the screen
    action->setCheckable(true);
    QToolButton* const button =
        addButton(action->text(), action == follow_ ? "follow" : "camera", action->toolTip());
    button->setObjectName(action->objectName() + "_button");
    button->setCheckable(true);
    connect(button, &QToolButton::clicked, action, &QAction::trigger);
    connect(action, &QAction::toggled, button, &QToolButton::setChecked);
    connect(action, &QAction::triggered, this, [this, action](bool checked) {
      if (checked) (action == follow_ ? through_ : follow_)->setChecked(false);
      emit followingChanged();
    });
  }
}

void TrajectoryTools::addSaving() {
  constexpr double kOnce = 1.0, kTwice = 2.0;
  QToolButton* const button =
      addButton(tr("Save"), "save", tr("Save the view as a picture, or the trajectory as a table"));
  button->setObjectName("save_view");
  button->setPopupMode(QToolButton::InstantPopup);
  button->setFocusPolicy(Qt::StrongFocus);
  button->setAccessibleName(tr("Save the view"));
  save_ = new QMenu(button);
  save_->addAction(tr("Save &picture (PNG)..."), this, [this] { emit pictureWanted(kOnce); });
  save_->addAction(tr("Save picture at &twice the size (PNG)..."), this,
                   [this] { emit pictureWanted(kTwice); });
  table_ = save_->addAction(tr("Save &trajectory (CSV)..."), this, [this] { emit tableWanted(); });
  button->setMenu(save_);
  offerTable(false);
}

void TrajectoryTools::offerTable(bool available) {
  table_->setEnabled(available);
}

bool TrajectoryTools::following() const {
  return follow_->isChecked();
}

bool TrajectoryTools::throughCamera() const {
  return through_->isChecked();
}

void TrajectoryTools::leaveCamera() {
  through_->setChecked(false);
}

void TrajectoryTools::showColour(TrajectoryColour colour) {
  colours_->setCurrentIndex(static_cast<int>(colour));
}

void TrajectoryTools::showLayer(SceneLayer layer, bool visible) {
  layers_[static_cast<std::size_t>(layer)]->setChecked(visible);
}

void TrajectoryTools::offerResiduals(bool available) {
  auto* const model = qobject_cast<QStandardItemModel*>(colours_->model());
  model->item(static_cast<int>(TrajectoryColour::Residual))->setEnabled(available);
}

}  // namespace evical::ui
