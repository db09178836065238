// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/about.h"

#include "ui/window/user_guide.h"

#include <QDialog>
#include <QFile>
#include <QLabel>
#include <QPlainTextEdit>
#include <QTabWidget>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

QString textOf(const QString& resource) {
  QFile file(resource);
  return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
}

QString versionText(const QString& version) {
  const QString commit = QStringLiteral(EVICAL_COMMIT);  // empty in a build without a checkout
  return commit.isEmpty() ? version : QObject::tr("%1 (%2)").arg(version, commit);
}

QWidget* makeSummary(const QString& version, QWidget* parent) {
  auto* const page = new QWidget(parent);
  auto* const title = new QLabel("Evical " + versionText(version), page);
  title->setProperty("role", "title");
  title->setTextInteractionFlags(Qt::TextSelectableByMouse);
  auto* const text = new QLabel(
      QObject::tr(
          "<p>Calibrates event cameras, frame cameras and IMUs from one recording of a printed board.</p>"
          "<p>The desktop program is free software under the <a "
          "href='https://www.gnu.org/licenses/gpl-3.0.html'>GNU General Public License</a>, version 3 "
          "or later. The calibration itself and the command line are under the BSD 3-Clause License.</p>"
          "<p>With Qt %1, Ceres, OpenCV, Eigen, VTK and QCustomPlot.</p>")
          .arg(qVersion()),
      page);
  text->setTextFormat(Qt::RichText);
  text->setWordWrap(true);
  text->setOpenExternalLinks(true);
  auto* const column = new QVBoxLayout(page);
  column->addWidget(title);
  column->addWidget(text);
  column->addStretch();
  return page;
}

QWidget* makeLicence(const QString& resource, QWidget* parent) {
  auto* const text = new QPlainTextEdit(textOf(resource), parent);
  text->setAccessibleName(QObject::tr("Licence"));
  text->setReadOnly(true);
  return text;
}

}  // namespace

void showAbout(QWidget* window, const QString& version) {
  constexpr int kWidth_px = 640, kHeight_px = 460;
  if (raiseOpened(window, "about")) return;
  QDialog* const dialog = makeReadingDialog(window, "about", QObject::tr("About Evical"));
  auto* const tabs = new QTabWidget(dialog);
  tabs->addTab(makeSummary(version, tabs), QObject::tr("Evical"));
  tabs->addTab(makeLicence(":/licences/gpl-3.0", tabs), QObject::tr("Licence of the desktop program"));
  tabs->addTab(makeLicence(":/licences/bsd-3-clause", tabs), QObject::tr("Licence of the calibration"));
  dialog->layout()->addWidget(tabs);
  addCloseButton(dialog);
  dialog->resize(kWidth_px, kHeight_px);
  dialog->show();
}

}  // namespace evical::ui
