// Whole files, for comparisons in tests.
#pragma once

#include <QByteArray>
#include <QFile>
#include <QString>

#include <filesystem>

namespace evical::test {

// Empty if the file cannot be read.
inline QByteArray fileContent(const QString& path) {
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
}
inline QByteArray fileContent(const std::filesystem::path& path) {
  return fileContent(QString::fromStdString(path.string()));
}

}  // namespace evical::test
