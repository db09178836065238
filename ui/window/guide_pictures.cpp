// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/guide_pictures.h"

#include "ui/screens/recording/motion_picture.h"

#include <QDir>
#include <QImage>
#include <QPixmap>
#include <QRegularExpression>
#include <QTextDocument>
#include <QUrl>

namespace evical::ui {
namespace {

constexpr const char *kMotionsPart = "Before you record", *kMotion = "motion-";
constexpr double kMotionShape = 0.5;  // height by width

QString urlOf(const QString& name) {
  return "picture:" + name;
}

QString motions() {
  QString text = "\n### How to move\n\n";
  for (const ShownMotion& motion : shownMotions())
    text += QString("**%1.** %2\n").arg(motion.title, motion.words) +
            QString("\n![%1](%2)\n\n").arg(motion.title, urlOf(kMotion + motion.name));
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
  static const QRegularExpression picture(R"(^!\[([^\]]*)\]\(pictures/([\w-]+)\.png\)$)");
  static const QRegularExpression link(R"((?<!!)\[([^\]]*)\]\([^)]*\))");  // to a page of the documentation
  QString all, part;
  for (const QString& line : markdown.split('\n')) {
    if (line.startsWith("## ")) {
      if (part == kMotionsPart) all += motions() + '\n';
      part = line.mid(3).trimmed();
    }
    if (const QRegularExpressionMatch found = picture.match(line); found.hasMatch())
      all += QString("![%1](%2)\n\n*%1*\n").arg(found.captured(1), urlOf(found.captured(2)));
    else
      all += QString(line).replace(link, "\\1") + '\n';
  }
  return all;
}

QStringList guidePictures() {
  return QDir(":/pictures").entryList().replaceInStrings(".png", "");
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
