// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/user_guide.h"

#include "ui/theme/theme.h"

#include <QDialog>
#include <QDialogButtonBox>
#include <QLabel>
#include <QTextBrowser>
#include <QUrl>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

// Not modal: the guide is read beside the work, and nothing stands in front of a running job.
QDialog* makeDialog(QWidget* window, const QString& name, const QString& title) {
  auto* const dialog = new QDialog(window);
  dialog->setObjectName(name);
  dialog->setWindowTitle(title);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  new QVBoxLayout(dialog);
  return dialog;
}

QDialog* opened(QWidget* window, const QString& name) {
  auto* const dialog = window->findChild<QDialog*>(name);
  if (dialog == nullptr) return nullptr;
  dialog->raise();
  dialog->activateWindow();
  return dialog;
}

void addCloseButton(QDialog* dialog) {
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Close, dialog);
  QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::close);
  dialog->layout()->addWidget(buttons);
}

}  // namespace

void showUserGuide(QWidget* window) {
  constexpr int kWidth_px = 760, kHeight_px = 720;
  if (opened(window, "user_guide") != nullptr) return;
  QDialog* const dialog = makeDialog(window, "user_guide", QObject::tr("User guide"));
  auto* const browser = new QTextBrowser(dialog);
  browser->setOpenExternalLinks(true);
  browser->setSource(QUrl("qrc:/user_guide.md"), QTextDocument::MarkdownResource);
  browser->document()->setDocumentMargin(18.0);
  dialog->layout()->addWidget(browser);
  addCloseButton(dialog);
  dialog->resize(kWidth_px, kHeight_px);
  dialog->show();
}

void showAbout(QWidget* window, const QString& version) {
  if (opened(window, "about") != nullptr) return;
  QDialog* const dialog = makeDialog(window, "about", QObject::tr("About Evical"));
  auto* const title = new QLabel("Evical " + version, dialog);
  title->setProperty("role", "title");
  auto* const text = new QLabel(
      QObject::tr("<p>Calibrates event cameras with IMUs from one recording of a printed circle grid.</p>"
                  "<p>This window is free software under the GNU General Public License, version 3 or later. "
                  "The calibration itself and the command line are under the BSD 3-Clause License.</p>"
                  "<p>With Qt %1, Ceres, OpenCV, Eigen, VTK and QCustomPlot.</p>")
          .arg(qVersion()),
      dialog);
  text->setWordWrap(true);
  text->setMinimumWidth(420);
  dialog->layout()->addWidget(title);
  dialog->layout()->addWidget(text);
  addCloseButton(dialog);
  dialog->show();
}

}  // namespace evical::ui
