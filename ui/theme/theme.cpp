// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/theme/theme.h"

#include "ui/theme/outlined_style.h"
#include "ui/theme/plain_labels.h"
#include "ui/theme/style_sheet.h"
#include "ui/theme/system_appearance.h"

#include <QApplication>
#include <QFontDatabase>
#include <QPalette>

namespace evical::ui {
namespace {

Theme makeTheme(bool dark) {
  Theme t;
  t.dark = dark;
  t.window = dark ? QColor(0x1f, 0x22, 0x27) : QColor(0xf5, 0xf6, 0xf8);
  t.panel = dark ? QColor(0x17, 0x19, 0x1d) : QColor(0xff, 0xff, 0xff);
  t.text = dark ? QColor(0xe6, 0xe8, 0xeb) : QColor(0x1d, 0x21, 0x27);
  t.faint_text = dark ? QColor(0x9a, 0xa1, 0xab) : QColor(0x63, 0x6b, 0x76);
  t.grid_line = dark ? QColor(0x33, 0x38, 0x40) : QColor(0xdf, 0xe2, 0xe6);
  t.accent = dark ? QColor(0x5a, 0xa9, 0xf5) : QColor(0x1f, 0x6f, 0xc4);
  // States and axes are distinguishable with red-green colour blindness: the greens are bluish.
  t.good = dark ? QColor(0x3f, 0xc7, 0xb0) : QColor(0x00, 0x80, 0x6e);
  t.warning = dark ? QColor(0xf7, 0xd7, 0x74) : QColor(0xb8, 0x86, 0x0b);
  t.bad = dark ? QColor(0xee, 0x5a, 0x5f) : QColor(0xa3, 0x13, 0x3a);
  t.brighter = dark ? QColor(0xff, 0xa6, 0x4d) : QColor(0xd9, 0x5f, 0x0e);
  t.darker = dark ? QColor(0x5c, 0xb8, 0xff) : QColor(0x1c, 0x6d, 0xc9);
  t.axes = dark ? std::array{QColor(0xf0, 0x60, 0x5a), QColor(0x7f, 0xe0, 0xb0), QColor(0x5f, 0x9c, 0xf5)}
                : std::array{QColor(0xb3, 0x12, 0x2f), QColor(0x12, 0x96, 0x7a), QColor(0x24, 0x56, 0xb8)};
  t.series = {t.accent, t.warning, t.good, t.bad, t.axes[2].lighter(130), t.brighter, t.darker, t.faint_text};
  return t;
}

const Theme& themeOf(bool dark) {
  static const Theme light_theme = makeTheme(false), dark_theme = makeTheme(true);
  return dark ? dark_theme : light_theme;
}

// Derived from two colours, so that Light, Mid and Dark match, too: Fusion draws its bevels with them.
QPalette paletteOf(const Theme& t) {
  QPalette palette(t.dark ? QColor(0x2b, 0x2f, 0x36) : QColor(0xf0, 0xf1, 0xf4), t.window);
  palette.setColor(QPalette::Base, t.panel);
  palette.setColor(QPalette::AlternateBase, t.dark ? QColor(0x1c, 0x1f, 0x24) : QColor(0xf7, 0xf8, 0xfa));
  palette.setColor(QPalette::Highlight, t.accent);
  palette.setColor(QPalette::HighlightedText, t.dark ? QColor(0x10, 0x13, 0x17) : QColor(Qt::white));
  palette.setColor(QPalette::Link, t.accent);
  palette.setColor(QPalette::LinkVisited, t.accent);
  palette.setColor(QPalette::ToolTipBase, t.panel);
  palette.setColor(QPalette::ToolTipText, t.text);
  for (const QPalette::ColorRole role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    palette.setColor(role, t.text);
    QColor disabled = t.faint_text;
    disabled.setAlphaF(0.55F);
    palette.setColor(QPalette::Disabled, role, disabled);
  }
  palette.setColor(QPalette::PlaceholderText, t.faint_text);
  palette.setColor(QPalette::Disabled, QPalette::Highlight, t.grid_line);
  return palette;
}

QFont applicationFont() {
  constexpr int kPointSize = 10;
  QFont font = QFontDatabase::systemFont(QFontDatabase::GeneralFont);
  if (QFontDatabase::families().contains("Inter")) font.setFamily("Inter");
  font.setPointSize(kPointSize);
  return font;
}

void setColours(QApplication& application, bool dark) {
  application.setPalette(paletteOf(themeOf(dark)));
  application.setStyleSheet(styleSheetOf(themeOf(dark)));
}

}  // namespace

const Theme& theme() {
  constexpr int kHalfLight = 128;
  return themeOf(QApplication::palette().color(QPalette::Window).lightness() < kHalfLight);
}

void applyTheme(QApplication& application, Appearance appearance) {
  SystemAppearance& system = SystemAppearance::instance();
  showTextAsPlain(application);
  application.setStyle(new OutlinedStyle);
  application.setFont(applicationFont());
  QObject::disconnect(&system, nullptr, &application, nullptr);
  if (appearance == Appearance::System) {
    QObject::connect(&system, &SystemAppearance::changed, &application,
                     [&application](bool dark) { setColours(application, dark); });
  }
  setColours(application, appearance == Appearance::System ? system.dark() : appearance == Appearance::Dark);
}

bool desktopAnimates() {
  return SystemAppearance::instance().animated();
}

}  // namespace evical::ui
