// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/trajectory_tools.h"

#include "ui/theme/theme.h"

#include <QAction>
#include <QComboBox>
#include <QLabel>
#include <QMenu>
#include <QStandardItemModel>
#include <QToolButton>

namespace evical::ui {

TrajectoryTools::TrajectoryTools(QWidget* parent) : QToolBar(parent) {
  setMovable(false);
  setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  addColours();
  addSeparator();
  addLayers();
  addSeparator();
  addViews();
  addSeparator();
  addFollowing();
  addSeparator();
  addSaving();
}

void TrajectoryTools::addColours() {
  addWidget(new QLabel(" " + tr("Colour by") + " ", this));
  colours_ = new QComboBox(this);
  colours_->addItems({tr("Speed"), tr("Residual")});
  colours_->setToolTip(
      tr("What the trajectory's colour says: the IMU's speed, or how far the board's circles lie from\n"
         "where the calibration expects them (of the nearest view; known after a calibration)"));
  connect(colours_, &QComboBox::activated, this,
          [this](int index) { emit colourChosen(static_cast<TrajectoryColour>(index)); });
  addWidget(colours_);
  offerResiduals(false);
}

void TrajectoryTools::addLayers() {
  const std::array<std::pair<QString, QString>, kSceneLayerCount> texts = {{
      {tr("Board"), tr("The board with its circles")},
      {tr("Trajectory"), tr("The IMU's way through the world, from the spline")},
      {tr("Cameras"), tr("The cameras at regular intervals")},
      {tr("Camera now"), tr("The cameras at the cursor's time")},
      {tr("IMU axes"), tr("The IMUs' axes at the cursor's time")},
      {tr("Poses of single views"),
       tr("Computed from each board view by itself: they scatter about a trajectory that is right")},
      {tr("Gravity"), tr("Its direction as estimated")},
      {tr("Ground"), tr("A level grid below everything")},
      {tr("Board axes"), tr("x, y and z of the board's frame, which is the world")},
  }};
  auto* const button = new QToolButton(this);
  button->setText(tr("Layers"));
  button->setIcon(icon("layers"));
  button->setToolButtonStyle(toolButtonStyle());
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
  button->setToolTip(tr("What is drawn"));
  addWidget(button);
}

void TrajectoryTools::addViews() {
  const std::array<std::pair<QString, QString>, 4> texts = {
      {{tr("Home"), tr("Everything, from the side above (Home)")},
       {tr("Front"), tr("Facing the board (1)")},
       {tr("Side"), tr("From the board's side (2)")},
       {tr("Top"), tr("From above (3)")}}};
  for (std::size_t k = 0; k < texts.size(); ++k) {
    QAction* const action = addAction(texts[k].first);
    action->setToolTip(texts[k].second);
    connect(action, &QAction::triggered, this, [this, k] {
      leaveCamera();
      emit viewChosen(static_cast<StandardView>(k));
    });
  }
  actions().at(actions().size() - 4)->setIcon(icon("home"));
}

void TrajectoryTools::addFollowing() {
  follow_ = addAction(icon("follow"), tr("Follow camera"));
  follow_->setObjectName("follow");
  follow_->setToolTip(tr("Keep the camera in the middle as time goes on (F)"));
  through_ = addAction(icon("camera"), tr("Through camera"));
  through_->setObjectName("through_camera");
  through_->setToolTip(tr("See the board as the camera does; drag to leave (C)"));
  follow_->setShortcut(QKeySequence("F"));
  through_->setShortcut(QKeySequence("C"));
  for (QAction* action : {follow_, through_}) {
    action->setShortcutContext(Qt::WidgetWithChildrenShortcut);
    parentWidget()->addAction(action);  // works wherever the focus is on the screen
    action->setCheckable(true);
    connect(action, &QAction::triggered, this, [this, action](bool checked) {
      if (checked) (action == follow_ ? through_ : follow_)->setChecked(false);
      emit followingChanged();
    });
  }
}

void TrajectoryTools::addSaving() {
  constexpr double kOnce = 1.0, kTwice = 2.0;
  auto* const button = new QToolButton(this);
  button->setObjectName("save_view");
  button->setText(tr("Save"));
  button->setIcon(icon("save"));
  button->setToolButtonStyle(toolButtonStyle());
  button->setPopupMode(QToolButton::InstantPopup);
  button->setFocusPolicy(Qt::StrongFocus);
  button->setAccessibleName(tr("Save the view"));
  button->setToolTip(tr("Save what is seen as a picture, or the trajectory as a table"));
  save_ = new QMenu(button);
  save_->addAction(tr("Save &picture (PNG)..."), this, [this] { emit pictureWanted(kOnce); });
  save_->addAction(tr("Save picture at &twice the size (PNG)..."), this,
                   [this] { emit pictureWanted(kTwice); });
  table_ = save_->addAction(tr("Save &trajectory (CSV)..."), this, [this] { emit tableWanted(); });
  button->setMenu(save_);
  addWidget(button);
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
