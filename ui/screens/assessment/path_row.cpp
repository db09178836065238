// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/assessment/path_row.h"

#include "ui/theme/theme.h"

#include <QDir>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPushButton>

namespace evical::ui {

PathRow::PathRow(const QString& object_name, const QString& title, const QString& tip, QGridLayout& grid,
                 QWidget* parent)
    : QObject(parent), field_(new QLineEdit(parent)), choose_(new QPushButton(tr("Choose..."), parent)) {
  const QString name = QString(title).remove('&');
  auto* const label = new QLabel(title, parent);
  label->setBuddy(field_);
  field_->setObjectName(object_name);
  field_->setAccessibleName(name);
  field_->setToolTip(tip);
  field_->setClearButtonEnabled(true);
  choose_->setObjectName("choose_" + object_name);
  choose_->setAccessibleName(tr("Choose: %1").arg(name));
  choose_->setToolTip(tip);
  const int row = grid.rowCount();
  grid.addWidget(label, row, 0);
  grid.addWidget(field_, row, 1);
  grid.addWidget(choose_, row, 2);
  connect(choose_, &QPushButton::clicked, this, &PathRow::chooseRequested);
  connect(field_, &QLineEdit::textEdited, this, [this] { by_hand_ = true; });
  connect(field_, &QLineEdit::textChanged, this, &PathRow::changed);
}

QString PathRow::path() const {
  return QDir::fromNativeSeparators(field_->text().trimmed());
}

void PathRow::setPath(const QString& path) {
  by_hand_ = true;
  field_->setText(QDir::toNativeSeparators(path));
}

void PathRow::proposePath(const QString& path) {
  if (!by_hand_ || field_->text().isEmpty()) field_->setText(QDir::toNativeSeparators(path));
}

void PathRow::setMenu(QMenu* menu) {
  choose_->setMenu(menu);
}

void PathRow::setPlaceholder(const QString& text) {
  field_->setPlaceholderText(text);
}

void PathRow::setEnabled(bool enabled) {
  field_->setEnabled(enabled);
  choose_->setEnabled(enabled);
}

}  // namespace evical::ui
