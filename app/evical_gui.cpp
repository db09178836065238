// SPDX-License-Identifier: GPL-3.0-or-later
// The desktop program: builds the window and opens the given file.
#include "app/manual_page.h"
#include "app/version.h"
#include "core/base/child_process.h"
#include "core/recording/recording_server.h"
#include "ui/theme/theme.h"
#include "ui/window/main_window.h"
#include "ui/window/photographer.h"
#include "ui/window/session_files.h"

#include <QApplication>
#include <QCommandLineParser>
#include <QSettings>
#include <QTextStream>

#include <algorithm>
#include <clocale>
#include <csignal>
#include <cstdlib>
#include <string>

namespace {

using namespace evical::ui;

constexpr int kBadUse = 2;

// Pictures, help and the version need no display, but Qt aborts without one.
bool doWithoutDisplay(int argc, char** argv) {
  for (const char* const name : {"QT_QPA_PLATFORM", "DISPLAY", "WAYLAND_DISPLAY"})
    if (!qEnvironmentVariableIsEmpty(name)) return false;
  const auto chooses = [](const char* argument) { return QByteArrayView(argument).endsWith("-platform"); };
  if (std::any_of(argv, argv + argc, chooses)) return false;
  qputenv("QT_QPA_PLATFORM", "offscreen");
  return true;
}

int complain(const QString& text) {
  QTextStream(stderr) << text << '\n';
  return kBadUse;
}

struct Arguments {
  QString path, screen, picture;
  QStringList further;
  QSize size;
  Appearance appearance = Appearance::System;
};

// Qt aborts if it cannot open the display.
void reportMissingDisplay(QtMsgType type, const QMessageLogContext&, const QString& text) {
  if (type != QtFatalMsg) {
    QTextStream(stderr) << text << '\n';
    return;
  }
  complain("The window cannot be opened: " + text.simplified() +
           " Check DISPLAY, WAYLAND_DISPLAY and QT_QPA_PLATFORM, connect with `ssh -X`, or run `evical "
           "calibrate SESSION`, which needs no window.");
  std::_Exit(kBadUse);
}

// Manual page from the parser's options.
std::string manualOf(const QCommandLineParser& parser, const QList<QCommandLineOption>& options) {
  const std::string file = "[SESSION|RECORDING|RESULT]";
  evical::ManualSection section{"Options", "", {}};
  for (const QCommandLineOption& option : options) {
    QStringList names;
    for (const QString& name : option.names()) names << (name.size() > 1 ? "--" : "-") + name;
    section.entries.push_back({names.join(',').toStdString(), option.valueName().toStdString(),
                               evical::sentence(option.description().toStdString())});
  }
  return evical::manualPage({"evical-gui",
                             parser.applicationDescription().toStdString(),
                             "evical-gui [OPTIONS] " + file,
                             {section},
                             {"evical"}},
                            evical::kVersion);
}

// Exits on --help, --version and unknown options.
Arguments parse(const QApplication& application) {
  QCommandLineParser parser;
  parser.setApplicationDescription("Calibrates event cameras with IMUs from one recording of a board.");
  const QCommandLineOption help = parser.addHelpOption(), version = parser.addVersionOption();
  parser.addPositionalArgument("file", "Session file, recording, or folder of a result to open",
                               "[SESSION|RECORDING|RESULT]");
  const QCommandLineOption screen("screenshot",
                                  "Calibrate SESSION or open RESULT, save a picture of this screen, and "
                                  "quit; screens of several recordings take more of them as arguments, "
                                  "IMUs over time a log and the old result",
                                  "SCREEN");
  const QCommandLineOption output("o", "File of the picture", "x.png");
  const QCommandLineOption size("size", "Size of the window, for pictures", "WIDTHxHEIGHT", "1280x800");
  const QCommandLineOption appearance("appearance", "Colours of the window: system, light or dark", "WORD");
  // For the build.
  QCommandLineOption manual("manual");
  manual.setFlags(QCommandLineOption::HiddenFromHelp);
  const QList<QCommandLineOption> shown{help, version, screen, output, size, appearance};
  parser.addOptions({screen, output, size, appearance, manual});
  parser.process(application);
  if (parser.isSet(manual)) {
    QTextStream(stdout) << QString::fromStdString(manualOf(parser, shown));
    std::exit(0);
  }
  Arguments arguments;
  arguments.path = parser.positionalArguments().value(0);
  arguments.further = parser.positionalArguments().mid(1);
  arguments.screen = parser.value(screen);
  arguments.picture = parser.value(output);
  const QStringList numbers = parser.value(size).split('x');
  arguments.size = QSize(numbers.value(0).toInt(), numbers.value(1).toInt());
  const int saved = QSettings().value("appearance", static_cast<int>(Appearance::System)).toInt();
  arguments.appearance = static_cast<Appearance>(saved);
  if (parser.value(appearance) == "light") arguments.appearance = Appearance::Light;
  if (parser.value(appearance) == "dark") arguments.appearance = Appearance::Dark;
  return arguments;
}

int takePicture(const Arguments& arguments, MainWindow& window) {
  const QStringList screens = Photographer::screensOf(window);
  if (!screens.contains(arguments.screen))
    return complain("There is no screen " + arguments.screen + ". Give one of " + screens.join(", "));
  if (arguments.path.isEmpty() || arguments.picture.isEmpty() || !arguments.size.isValid())
    return complain("Session or picture file missing. Use --screenshot SCREEN -o x.png SESSION");
  const Photographer photographer(window, arguments.screen, arguments.picture, arguments.further);
  window.resize(arguments.size);
  window.show();
  window.files().open(arguments.path);
  return QApplication::exec();
}

}  // namespace

int main(int argc, char** argv) {
  evical::beRecordingServer(argc, argv);
  evical::keepFreedMemory();
  const bool without_display = doWithoutDisplay(argc, argv);
  std::signal(SIGCHLD, SIG_DFL);  // as in the command line program: the exit codes of jobs are needed
  const QtMessageHandler usual = qInstallMessageHandler(reportMissingDisplay);
  QApplication application(argc, argv);
  qInstallMessageHandler(usual);
  std::setlocale(LC_NUMERIC, "C");  // files have decimal points in any locale
  QApplication::setApplicationName("evical");
  QApplication::setOrganizationName("evical");
  QApplication::setApplicationVersion(evical::kVersion);
  QApplication::setDesktopFileName("evical");
  const Arguments arguments = parse(application);
  if (without_display && arguments.screen.isEmpty())
    return complain(
        "There is no display for the window (DISPLAY and WAYLAND_DISPLAY are empty). Run `evical calibrate "
        "SESSION`, which needs none, or connect with `ssh -X`.");
  applyTheme(application, arguments.appearance);
  QApplication::setWindowIcon(icon("calibrate", theme().accent));
  MainWindow window(evical::kVersion);
  if (!arguments.screen.isEmpty()) return takePicture(arguments, window);
  window.show();
  if (!arguments.path.isEmpty()) window.files().open(arguments.path);
  return QApplication::exec();
}
