// SPDX-License-Identifier: GPL-3.0-or-later
// Files of what a screen shows: asks where, takes what is shown in the GUI thread, makes and writes the file in
// another, and says where that failed.
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

// One format that something can be saved in.
struct SavedForm {
  // Makes the file's content in a thread of its own: owns all that it needs. Empty: it could not be made.
  using Content = std::function<QByteArray()>;

  QString title;                     // "Picture"
  QString suffix;                    // "png"
  std::function<Content()> prepare;  // in the GUI thread
};

QByteArray pngOf(const QImage& image);  // in any thread; empty of a null image

// Something painted as PNG, with `scale` pixels to one of the screen's, SVG and PDF. `paint` brings its own painter.
std::vector<SavedForm> pictureForms(const QSize& size, double scale,
                                    const std::function<void(QPaintDevice&)>& paint);
// A widget that paints itself.
std::vector<SavedForm> pictureForms(QWidget* widget);

class FileSaver : public QObject {
  Q_OBJECT

 public:
  explicit FileSaver(QWidget* parent);  // messages appear over it

  // Proposes `name` in the folder that was chosen last. The format is that of the suffix that is typed, else the one chosen.
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
