// SPDX-License-Identifier: GPL-3.0-or-later
// The real main window for tests, with simulated user actions: clicks, keys, answers to dialogs.
#pragma once

#include "tests/ui/slowdown.h"
#include "ui/theme/theme.h"
#include "ui/window/export_dialog.h"
#include "ui/window/main_window.h"

#include <QApplication>
#include <QDir>
#include <QEventLoop>
#include <QFileDialog>
#include <QLineEdit>
#include <QMessageBox>
#include <QSettings>
#include <QSignalSpy>
#include <QStackedWidget>
#include <QStandardPaths>
#include <QTemporaryDir>
#include <QTimer>
#include <QToolButton>
#include <QTreeWidget>
#include <QtTest>

namespace evical::ui::test {

inline constexpr int kPatience_ms = 120'000 * kSlowdown;

// Settings, recent files and the demo's place in separate folders for tests.
inline void usePrivateFolders(const QTemporaryDir& scratch) {
  QCoreApplication::setOrganizationName("evical_test");
  QStandardPaths::setTestModeEnabled(true);
  QDir(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)).removeRecursively();
  QSettings::setDefaultFormat(QSettings::IniFormat);
  QSettings::setPath(QSettings::IniFormat, QSettings::UserScope, scratch.filePath("settings"));
  QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
  applyTheme(*qApp, Appearance::Light);
}

// Runs the event loop like in the program.
inline void spin(int duration_ms) {
  QEventLoop loop;
  QTimer::singleShot(duration_ms, &loop, &QEventLoop::quit);
  loop.exec();
}

// Replaces the field's content; ended by Return.
inline void type(QLineEdit* field, const QString& text) {
  field->setFocus();
  field->selectAll();
  QTest::keyClicks(field, text);
  QTest::keyClick(field, Qt::Key_Return);
}

// Answers the next modal dialog: types a path into a file dialog, presses a button of a question.
inline void answerFileDialog(const QString& path) {
  QTimer::singleShot(200, qApp, [path] {
    auto* const dialog = qobject_cast<QFileDialog*>(QApplication::activeModalWidget());
    if (dialog == nullptr) return answerFileDialog(path);
    auto* const edit = dialog->findChild<QLineEdit*>("fileNameEdit");
    edit->setText(path);
    QTest::keyClick(edit, Qt::Key_Return);
    if (dialog->isVisible())
      QMetaObject::invokeMethod(dialog, "accept");  // a completer may have taken the key
  });
}

// Types the folder, checks more targets, and exports.
inline void answerExportDialog(const QStringList& targets, const QString& folder) {
  QTimer::singleShot(200, qApp, [targets, folder] {
    auto* const dialog = qobject_cast<ExportDialog*>(QApplication::activeModalWidget());
    if (dialog == nullptr) return answerExportDialog(targets, folder);
    dialog->findChild<QLineEdit*>("folder")->setText(folder);
    for (QTreeWidgetItemIterator at(dialog->findChild<QTreeWidget*>("targets")); *at; ++at)
      if (targets.contains((*at)->data(0, Qt::UserRole).toString())) (*at)->setCheckState(0, Qt::Checked);
    dialog->accept();
  });
}

// If a question is not asked, its answer would be given to a later one.
inline QList<QTimer*>& awaitedQuestions() {
  static QList<QTimer*> awaited;
  return awaited;
}

inline void answerQuestion(QMessageBox::StandardButton button) {
  auto* const timer = new QTimer(qApp);
  awaitedQuestions() << timer;
  QObject::connect(timer, &QTimer::timeout, timer, [timer, button] {
    auto* const box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
    if (box == nullptr) return;
    awaitedQuestions().removeOne(timer);
    timer->deleteLater();
    timer->stop();
    QTest::mouseClick(box->button(button), Qt::LeftButton);
  });
  timer->start(200);
}

struct WindowFixture {
  MainWindow window{"0.0.0"};
  QSignalSpy finished{&window.workbench().runner, &JobRunner::finished};

  // The automatic check of recordings is disabled; tests of that enable it.
  WindowFixture() {
    window.workbench().check.setAutomatic(false);
    window.show();
    QVERIFY(QTest::qWaitForWindowExposed(&window));
    window.activateWindow();
    QVERIFY(QTest::qWaitForWindowActive(&window));
  }
  ~WindowFixture() {
    if (!awaitedQuestions().isEmpty())
      QTest::qFail("a question was awaited that nobody asked", __FILE__, __LINE__);
    qDeleteAll(awaitedQuestions());
    awaitedQuestions().clear();
  }
  template <class Widget>
  Widget* child(const QString& name = {}) {
    return window.findChild<Widget*>(name);
  }
  CalibrationDocument& document() { return window.workbench().document; }
  JobRunner& runner() { return window.workbench().runner; }
  QString screen() {
    const auto* const stack = window.centralWidget()->findChild<QStackedWidget*>();
    return window.screenNames().value(stack->currentIndex());
  }
  void click(const QString& tool_button) {
    auto* const button = child<QToolButton>(tool_button);
    QVERIFY2(button && button->isVisible() && button->isEnabled(), qPrintable(tool_button));
    QTest::mouseClick(button, Qt::LeftButton);
  }
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    window.activateWindow();  // no window manager does this after a dialog
    QVERIFY(QTest::qWaitForWindowActive(&window));
    QTest::keyClick(&window, key, modifiers);
  }
  // The outcome of the job that runs or ended last.
  JobOutcome waitForJob() {
    if (finished.isEmpty()) finished.wait(kPatience_ms);
    return finished.isEmpty() ? JobOutcome::Failed : finished.takeLast().at(0).value<JobOutcome>();
  }
};

}  // namespace evical::ui::test
