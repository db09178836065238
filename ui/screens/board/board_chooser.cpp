// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/board_chooser.h"

#include "ui/theme/theme.h"

#include <QHBoxLayout>
#include <QSignalBlocker>
#include <QTabBar>
#include <QToolButton>

namespace evical::ui {
namespace {

// Takes the focus when clicked, so that a field commits its text before the click acts.
QToolButton* toolButton(const char* icon_name, const QString& tip, QWidget* parent) {
  auto* const made = new QToolButton(parent);
  made->setIcon(icon(icon_name));
  made->setFocusPolicy(Qt::StrongFocus);
  made->setToolTip(tip);
  made->setAccessibleName(tip);
  return made;
}

QString addTip() {
  return BoardChooser::tr(
      "Adds a board for cameras that see a different one; it starts as a copy of this board");
}

}  // namespace

BoardChooser::BoardChooser(QWidget* parent)
    : QWidget(parent),
      tabs_(new QTabBar(this)),
      add_(toolButton("add", addTip(), this)),
      remove_(toolButton("remove", tr("Remove this board; its cameras then use the first board"), this)) {
  tabs_->setObjectName("boards");
  add_->setObjectName("add_board");
  remove_->setObjectName("remove_board");
  tabs_->setFocusPolicy(Qt::StrongFocus);
  tabs_->setExpanding(false);
  tabs_->setDrawBase(false);
  tabs_->setElideMode(Qt::ElideRight);
  tabs_->setUsesScrollButtons(true);
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(2);
  row->addWidget(tabs_, 1);
  row->addStretch();
  row->addWidget(add_);
  row->addWidget(remove_);
  connect(tabs_, &QTabBar::currentChanged, this,
          [this](int index) { emit chosen(static_cast<std::size_t>(index)); });
  connect(add_, &QToolButton::clicked, this, &BoardChooser::addRequested);
  connect(remove_, &QToolButton::clicked, this, &BoardChooser::removeRequested);
}

// Tabs are reused: a click on one may interrupt an edit.
void BoardChooser::setBoards(const QStringList& names, std::size_t chosen) {
  const QSignalBlocker quiet(tabs_);
  while (tabs_->count() > names.size()) tabs_->removeTab(tabs_->count() - 1);
  while (tabs_->count() < names.size()) tabs_->addTab(icon("board"), {});
  for (int i = 0; i < tabs_->count(); ++i) {
    tabs_->setTabText(i, QString(names[i]).replace('&', "&&"));
    tabs_->setTabToolTip(i, i == 0 ? tr("%1: its frame is the world frame").arg(names[i]) : names[i]);
  }
  tabs_->setCurrentIndex(static_cast<int>(chosen));
  tabs_->setVisible(names.size() > 1);
  remove_->setVisible(names.size() > 1);
}

void BoardChooser::setWrong(const std::set<std::size_t>& wrong) {
  for (int i = 0; i < tabs_->count(); ++i)
    tabs_->setTabIcon(i, icon(wrong.contains(static_cast<std::size_t>(i)) ? "warning" : "board"));
}

void BoardChooser::setFull(const QString& why) {
  add_->setEnabled(why.isEmpty());
  add_->setToolTip(why.isEmpty() ? addTip() : why);
}

}  // namespace evical::ui
