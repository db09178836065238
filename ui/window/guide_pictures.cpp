// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/guide_pictures.h"

#include "ui/screens/recording/motion_picture.h"

#include <QImage>
#include <QPixmap>
#include <QTextDocument>
#include <QUrl>

#include <algorithm>
#include <array>

namespace evical::ui {
namespace {

struct GuidePicture {
  const char *part, *name, *title;  // heading of its part; file in pictures/
};

constexpr std::array<GuidePicture, 12> kPictures = {{
    {"The shortest way", "start-light", "Start"},
    {"Before you record", "print-board-light", "Print a board"},
    {"Before you record", "check-light", "Recording: the card shows whether the recording is good enough"},
    {"Your own recording", "recording-light", "Recording: streams, board and sensors"},
    {"A camera alone", "lens-light", "Result of a camera alone"},
    {"While it calibrates", "detection-dark", "Detection: events and the board detected in them"},
    {"Reading the result", "result-light", "Result: every number with its sigma"},
    {"Windows one by one", "residuals-light", "Residuals over the image, by window, and their distribution"},
    {"Trajectory and convergence", "trajectory-light", "Trajectory"},
    {"Trajectory and convergence", "convergence-light", "Convergence"},
    {"Trajectory and convergence", "signals-light", "Signals: measured, predicted, and their difference"},
    {"Copying and handing on", "export-light", "Export: programs, folder, and the check of the files"},
}};
constexpr const char *kMotionsPart = "Before you record", *kMotion = "motion-";
constexpr double kMotionShape = 0.5;  // height by width

QString urlOf(const QString& name) {
  return "picture:" + name;
}

QString imageOf(const QString& title, const QString& name) {
  return QString("\n![%1](%2)\n\n*%1*\n").arg(title, urlOf(name));
}

QString motions() {
  QString text = "\n### How to move\n\n";
  for (const ShownMotion& motion : shownMotions())
    text += QString("**%1.** %2\n").arg(motion.title, motion.words) +
            QString("\n![%1](%2)\n\n").arg(motion.title, urlOf(kMotion + motion.name));
  return text;
}

QString picturesOf(const QString& part) {
  QString text;
  for (const GuidePicture& picture : kPictures)
    if (part == picture.part) text += imageOf(QObject::tr(picture.title), picture.name);
  if (part == kMotionsPart) text += motions();
  return text;
}

QImage fileOf(const QString& name, int width_px, double pixel_ratio) {
  const QImage whole(QString(":/pictures/%1.png").arg(name));
  QImage scaled = whole.scaledToWidth(static_cast<int>(width_px * pixel_ratio), Qt::SmoothTransformation);
  scaled.setDevicePixelRatio(pixel_ratio);
  return scaled;
}

QImage drawingOf(const ShownMotion& motion, int width_px, double pixel_ratio) {
  MotionPicture drawn;
  drawn.resize(width_px, static_cast<int>(kMotionShape * width_px));
  drawn.setMotion(motion);
  QImage image(drawn.size() * pixel_ratio, QImage::Format_ARGB32_Premultiplied);
  image.setDevicePixelRatio(pixel_ratio);
  image.fill(Qt::transparent);
  drawn.render(&image);
  return image;
}

}  // namespace

QString withPictures(const QString& markdown) {
  QString all, part;
  for (const QString& line : markdown.split('\n')) {
    if (line.startsWith("## ")) {
      all += picturesOf(part) + '\n';
      part = line.mid(3).trimmed();
    }
    all += line + '\n';
  }
  return all + picturesOf(part);
}

QStringList guidePictures() {
  QStringList names;
  for (const GuidePicture& picture : kPictures) names << picture.name;
  return names;
}

void addGuidePictures(QTextDocument& document, int width_px, double pixel_ratio) {
  const auto add = [&](const QString& name, const QImage& image) {
    document.addResource(QTextDocument::ImageResource, QUrl(urlOf(name)), image);
  };
  for (const QString& name : guidePictures()) add(name, fileOf(name, width_px, pixel_ratio));
  for (const ShownMotion& motion : shownMotions())
    add(kMotion + motion.name, drawingOf(motion, width_px, pixel_ratio));
}

}  // namespace evical::ui
