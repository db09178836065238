// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/recent_files.h"

#include "core/report/result_yaml.h"

#include <QFile>
#include <QSettings>

#include <algorithm>
#include <array>

namespace evical::ui {
namespace {

constexpr qsizetype kMaxRecent = 10;
constexpr std::array kVerdicts = {CalibrationStatus::Ok, CalibrationStatus::Doubtful,
                                  CalibrationStatus::Failed};

void store(const QList<RecentFile>& files) {
  QSettings settings;
  settings.beginWriteArray("recent");
  for (qsizetype i = 0; i < std::min(files.size(), kMaxRecent); ++i) {
    settings.setArrayIndex(static_cast<int>(i));
    settings.setValue("path", files[i].path);
    settings.setValue("opened", files[i].opened);
    settings.setValue("verdict", files[i].verdict ? statusName(*files[i].verdict) : "");
  }
  settings.endArray();
}

}  // namespace

QList<RecentFile> recentFiles() {
  QSettings settings;
  QList<RecentFile> files;
  const int count = std::min(settings.beginReadArray("recent"), static_cast<int>(kMaxRecent));
  for (int i = 0; i < count; ++i) {
    settings.setArrayIndex(i);
    RecentFile file{settings.value("path").toString(), settings.value("opened").toDateTime(), {}};
    for (const CalibrationStatus verdict : kVerdicts)
      if (settings.value("verdict").toString() == statusName(verdict)) file.verdict = verdict;
    if (QFile::exists(file.path)) files << file;
  }
  return files;
}

void rememberOpened(const QString& file) {
  QList<RecentFile> files = recentFiles();
  RecentFile opened{file, QDateTime::currentDateTime(), {}};
  for (const RecentFile& known : files)
    if (known.path == file) opened.verdict = known.verdict;
  files.removeIf([&](const RecentFile& known) { return known.path == file; });
  files.prepend(opened);
  store(files);
}

void rememberVerdict(const QString& file, CalibrationStatus verdict) {
  QList<RecentFile> files = recentFiles();
  for (RecentFile& known : files)
    if (known.path == file) known.verdict = verdict;
  store(files);
}

}  // namespace evical::ui
