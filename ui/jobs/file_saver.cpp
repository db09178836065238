// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/file_saver.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QImage>
#include <QMessageBox>
#include <QPageSize>
#include <QPainter>
#include <QPdfWriter>
#include <QPointer>
#include <QSaveFile>
#include <QSettings>
#include <QSvgGenerator>
#include <QThreadPool>
#include <QWidget>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

constexpr int kDotsPerInch = 96;  // gives fonts the same size as on the screen
constexpr double kPictureScale = 2.0;
const char* const kFolderKey = "pictures_folder";

SavedForm::Content png(const QSize& size, double scale, const std::function<void(QPaintDevice&)>& paint) {
  QImage image((QSizeF(size) * scale).toSize(), QImage::Format_ARGB32_Premultiplied);
  image.setDevicePixelRatio(scale);
  image.fill(Qt::transparent);
  paint(image);
  return [image] { return pngOf(image); };
}

SavedForm::Content svg(const QSize& size, const std::function<void(QPaintDevice&)>& paint) {
  QByteArray content;
  QBuffer buffer(&content);
  buffer.open(QIODevice::WriteOnly);
  QSvgGenerator generator;
  generator.setOutputDevice(&buffer);
  generator.setResolution(kDotsPerInch);
  generator.setSize(size);
  generator.setViewBox(QRect(QPoint(), size));
  generator.setTitle(QCoreApplication::applicationName());
  paint(generator);
  return [content] { return content; };
}

SavedForm::Content pdf(const QSize& size, const std::function<void(QPaintDevice&)>& paint) {
  constexpr double kPointsPerInch = 72.0;
  QByteArray content;
  QBuffer buffer(&content);
  buffer.open(QIODevice::WriteOnly);
  QPdfWriter writer(&buffer);
  writer.setResolution(kDotsPerInch);
  writer.setPageSize(QPageSize(QSizeF(size) * kPointsPerInch / kDotsPerInch, QPageSize::Point));
  writer.setPageMargins({});
  paint(writer);
  return [content] { return content; };
}

const SavedForm* formOf(const QString& suffix, const std::vector<SavedForm>& forms) {
  const auto found = std::find_if(forms.begin(), forms.end(), [&](const SavedForm& form) {
    return form.suffix.compare(suffix, Qt::CaseInsensitive) == 0;
  });
  return found == forms.end() ? nullptr : &*found;
}

QString filterOf(const SavedForm& form) {
  return QString("%1 (*.%2)").arg(form.title, form.suffix);
}

bool write(const QString& path, const QByteArray& content) {
  QSaveFile file(path);
  return !content.isEmpty() && file.open(QIODevice::WriteOnly) && file.write(content) == content.size() &&
         file.commit();
}

}  // namespace

QByteArray pngOf(const QImage& image) {
  QByteArray content;
  QBuffer buffer(&content);
  image.save(&buffer, "PNG");
  return content;
}

std::vector<SavedForm> pictureForms(const QSize& size, double scale,
                                    const std::function<void(QPaintDevice&)>& paint) {
  return {{QObject::tr("Picture"), "png", [=] { return png(size, scale, paint); }},
          {QObject::tr("Drawing"), "svg", [=] { return svg(size, paint); }},
          {QObject::tr("Document"), "pdf", [=] { return pdf(size, paint); }}};
}

std::vector<SavedForm> pictureForms(QWidget* widget) {
  return pictureForms(widget->size(), kPictureScale, [widget](QPaintDevice& device) {
    QPainter painter(&device);
    widget->render(&painter, {}, {}, QWidget::DrawChildren | QWidget::DrawWindowBackground);
  });
}

FileSaver::FileSaver(QWidget* parent) : QObject(parent), over_(parent) {}

void FileSaver::askAndSave(const QString& title, const QString& name, const std::vector<SavedForm>& forms) {
  QSettings settings;
  const QString folder =
      settings.value(kFolderKey, settings.value("last_folder", QDir::homePath())).toString();
  QFileDialog dialog(over_, title, folder);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setFileMode(QFileDialog::AnyFile);
  QStringList filters;
  for (const SavedForm& form : forms) filters << filterOf(form);
  dialog.setNameFilters(filters);
  dialog.setDefaultSuffix(forms.front().suffix);
  connect(&dialog, &QFileDialog::filterSelected, &dialog, [&](const QString& filter) {
    dialog.setDefaultSuffix(
        forms[static_cast<std::size_t>(std::max<qsizetype>(0, filters.indexOf(filter)))].suffix);
  });
  dialog.selectFile(name + "." + forms.front().suffix);
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return;
  QString path = dialog.selectedFiles().constFirst();
  const SavedForm* form = formOf(QFileInfo(path).suffix(), forms);
  if (form == nullptr) {
    form = formOf(dialog.defaultSuffix(), forms);
    path += "." + form->suffix;
  }
  settings.setValue(kFolderKey, QFileInfo(path).absolutePath());
  save(path, *form);
}

void FileSaver::save(const QString& path, const SavedForm& form) {
  QThreadPool::globalInstance()->start(
      [path, content = form.prepare(), saver = QPointer<FileSaver>(this)]() mutable {
        const bool done = write(path, content());
        QMetaObject::invokeMethod(
            QCoreApplication::instance(),
            [saver, path, done] {
              if (saver) done ? emit saver->saved(path) : saver->complain(path);
            },
            Qt::QueuedConnection);
      });
}

void FileSaver::complain(const QString& path) {
  auto* const message =
      new QMessageBox(QMessageBox::Warning, tr("Not saved"),
                      tr("%1 could not be written. Check that the folder exists and is writable, and "
                         "that the disk is not full.")
                          .arg(path),
                      QMessageBox::Ok, over_);
  message->setAttribute(Qt::WA_DeleteOnClose);
  message->open();
  emit failed(path);
}

}  // namespace evical::ui
