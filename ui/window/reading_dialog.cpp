// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/reading_dialog.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QPushButton>
#include <QVBoxLayout>

namespace evical::ui {

QDialog* makeReadingDialog(QWidget* window, const QString& name, const QString& title) {
  auto* const dialog = new QDialog(window);
  dialog->setObjectName(name);
  dialog->setWindowTitle(title);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  new QVBoxLayout(dialog);
  return dialog;
}

void addCloseButton(QDialog* dialog) {
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Close, dialog);
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
  buttons->button(QDialogButtonBox::Close)->setAutoDefault(false);  // Return belongs to the fields
  dialog->layout()->addWidget(buttons);
}

bool raiseOpened(QWidget* window, const QString& name) {
  auto* const dialog = window->findChild<QDialog*>(name);
  if (dialog == nullptr) return false;
  dialog->raise();
  dialog->activateWindow();
  return true;
}

}  // namespace evical::ui
