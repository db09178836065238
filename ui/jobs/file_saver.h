// SPDX-License-Identifier: GPL-3.0-or-later
// Saves the content of a screen: asks for the file, collects the content in the GUI thread, formats and
// writes it in another, and reports failures.
#pragma once

#include <QByteArray>
#include <QObject>
#include <QSize>
#include <QString>

#include <functional>
#include <vector>

class QImage;
class QPaintDevice;
class QWidget;

namespace evical::ui {

// A file format for saving.
struct SavedForm {
  // Makes the file's content in a separate thread: owns all its inputs. Empty: failed.
  using Content = std::function<QByteArray()>;

  QString title;                     // "Picture"
  QString suffix;                    // "png"
  std::function<Content()> prepare;  // in the GUI thread
};

QByteArray pngOf(const QImage& image);  // thread-safe; empty for a null image

// A painting as PNG, with `scale` pixels per screen pixel, SVG and PDF. `paint` creates its own painter.
std::vector<SavedForm> pictureForms(const QSize& size, double scale,
                                    const std::function<void(QPaintDevice&)>& paint);
// A widget that paints itself.
std::vector<SavedForm> pictureForms(QWidget* widget);

class FileSaver : public QObject {
  Q_OBJECT

 public:
  explicit FileSaver(QWidget* parent);  // parent of messages

  // Proposes `name` in the last used folder. The format is that of the typed suffix, else the selected one.
  void askAndSave(const QString& title, const QString& name, const std::vector<SavedForm>& forms);
  void save(const QString& path, const SavedForm& form);

 signals:
  void saved(const QString& path);
  void failed(const QString& path);

 private:
  void complain(const QString& path);

  QWidget* over_;
};

}  // namespace evical::ui
