// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/theme/theme.h"

#include "ui/theme/plain_labels.h"
#include "ui/theme/system_appearance.h"

#include <QApplication>
#include <QFile>
#include <QFontDatabase>
#include <QIconEngine>
#include <QPainter>
#include <QPalette>
#include <QPixmap>
#include <QStyleFactory>
#include <QStyleOption>
#include <QSvgRenderer>

#include <memory>

// Outside of namespaces: the macro declares a global function.
static void initResources() {
  Q_INIT_RESOURCE(resources);
}

namespace evical::ui {
namespace {

// A fixed colour, or a role of the current palette.
struct Tint {
  QColor colour;
  QPalette::ColorRole role = QPalette::ButtonText;

  QColor now(QIcon::Mode mode) const {
    const QPalette palette = QApplication::palette();
    if (mode == QIcon::Disabled) return palette.color(QPalette::Disabled, QPalette::ButtonText);
    return colour.isValid() ? colour : palette.color(role);
  }
};

// Draws an SVG in the current palette's colour, so that icons follow the theme.
class TintedIconEngine final : public QIconEngine {
 public:
  TintedIconEngine(const QByteArray& svg, const Tint& tint)
      : svg_(svg), tint_(tint), renderer_(std::make_unique<QSvgRenderer>(svg)) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode, QIcon::State) override {
    const double ratio = painter->device()->devicePixelRatioF();
    painter->drawPixmap(rect, drawn((QSizeF(rect.size()) * ratio).toSize(), mode));
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State) override { return drawn(size, mode); }
  // Until Qt 6.8 `size` is in device pixels.
  QPixmap scaledPixmap(const QSize& size, QIcon::Mode mode, QIcon::State, qreal scale) override {
    constexpr bool kInDevicePixels = QT_VERSION < QT_VERSION_CHECK(6, 8, 0);
    return drawn(kInDevicePixels ? size : (QSizeF(size) * scale).toSize(), mode);
  }
  QIconEngine* clone() const override { return new TintedIconEngine(svg_, tint_); }

 private:
  // `size` is in device pixels.
  QPixmap drawn(const QSize& size, QIcon::Mode mode) {
    QPixmap pixmap(size);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    renderer_->setAspectRatioMode(Qt::KeepAspectRatio);
    renderer_->render(&painter, QRectF(QPointF(), QSizeF(size)));
    painter.setCompositionMode(QPainter::CompositionMode_SourceIn);
    painter.fillRect(pixmap.rect(), tint_.now(mode));
    return pixmap;
  }

  QByteArray svg_;
  Tint tint_;
  std::unique_ptr<QSvgRenderer> renderer_;
};

QIcon loaded(const QString& name, const Tint& tint) {
  initResources();
  QFile file(":/icons/" + name + ".svg");
  if (!file.open(QIODevice::ReadOnly)) return {};
  return QIcon(new TintedIconEngine(file.readAll(), tint));
}

}  // namespace

QIcon icon(const QString& name) {
  return loaded(name, {});
}

QIcon icon(const QString& name, const QColor& colour) {
  return loaded(name, {colour, QPalette::ButtonText});
}

QIcon icon(const QString& name, QPalette::ColorRole role) {
  return loaded(name, {{}, role});
}

}  // namespace evical::ui

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

namespace {

void drawOutline(const QStyleOption& option, QPainter& painter) {
  constexpr double kRadius_px = 2.0;
  constexpr float kFaint = 0.55f;
  QColor colour = theme().faint_text;
  const bool active = option.state.testFlag(QStyle::State_Enabled);
  colour.setAlphaF(active ? kFaint : 0.5f * kFaint);
  if (active && option.state.testFlag(QStyle::State_HasFocus)) colour = theme().accent;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colour, 1.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawRoundedRect(QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5), kRadius_px, kRadius_px);
  painter.restore();
}

}  // namespace

OutlinedStyle::OutlinedStyle() : QProxyStyle(QStyleFactory::create("Fusion")) {}

void OutlinedStyle::drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                                  const QWidget* widget) const {
  if (element == PE_FrameTabBarBase) return;  // a line above widgets next to the tabs
  QProxyStyle::drawPrimitive(element, option, painter, widget);
  if (theme().dark && (element == PE_IndicatorCheckBox || element == PE_FrameLineEdit))
    drawOutline(*option, *painter);
}

void OutlinedStyle::drawComplexControl(ComplexControl control, const QStyleOptionComplex* option,
                                       QPainter* painter, const QWidget* widget) const {
  QProxyStyle::drawComplexControl(control, option, painter, widget);
  if (theme().dark && control == CC_SpinBox) drawOutline(*option, *painter);
}

namespace {

// No rules for spin boxes and combo boxes: with any rule they lose their arrows.
const char* const kRules = R"(
QToolTip { color: @text; background: @panel; border: 1px solid @line; padding: 4px 6px; }
QToolBar { border: none; border-bottom: 1px solid @line; padding: 4px 8px; spacing: 4px; }
QToolBar::separator { background: @line; width: 1px; margin: 5px 6px; }
QToolButton { border: 1px solid transparent; border-radius: 6px; padding: 5px 8px; }
QToolButton:hover { background: @hover; }
QToolButton:pressed, QToolButton:checked { background: @selected; }
QToolButton[primary="true"] { background: @accent; color: @on_accent; padding: 6px 14px; font-weight: 600; }
QToolButton[primary="true"]:hover { background: @accent_hover; }
QToolButton[primary="true"]:disabled { background: @line; color: @faint; }
QToolButton#cancel { padding: 6px 14px; font-weight: 600; }
QToolButton[popupMode="2"] { padding-right: 22px; }
QToolButton::menu-indicator { subcontrol-origin: padding; subcontrol-position: right center; right: 7px; }
QPushButton::menu-indicator { subcontrol-origin: padding; subcontrol-position: right center; right: 4px; }
QWidget#sidebar { border-right: 1px solid @line; }
QPushButton { border: 1px solid @border; border-radius: 6px; padding: 6px 14px; background: @panel; }
QPushButton:hover { border-color: @accent; }
QPushButton:pressed, QPushButton:checked { background: @selected; }
QPushButton:disabled { border-color: @line; background: transparent; }
QPushButton[primary="true"] { background: @accent; border-color: @accent; color: @on_accent; }
QPushButton[primary="true"]:disabled { background: @line; border-color: @line; color: @faint; }
QFrame[card="true"] { background: @card; border: 1px solid @line; border-radius: 8px; }
QFrame[card="bad"] { background: @card; border: 1px solid @bad; border-radius: 8px; }
QLabel[role="title"] { font-size: 17pt; font-weight: 600; }
QLabel[role="heading"] { font-size: 11pt; font-weight: 600; }
QLabel[role="hint"] { color: @faint; }
QLabel[role="problem"] { color: @bad; }
QListView, QTreeView, QTableView, QPlainTextEdit, QTextBrowser { border: 1px solid @line; border-radius: 6px; }
QListView::item, QTreeView::item { padding: 3px; }
QTableView::item { padding: 0 8px; }
QHeaderView::section { background: @window; border: none; border-bottom: 1px solid @line; padding: 5px 6px; }
QTreeView QHeaderView::section { padding: 5px 3px; }
QListView#navigation { border: none; border-radius: 0; background: @window; padding: 6px; }
QListView#navigation::item { border-radius: 6px; padding: 0 6px; margin: 1px 0; }
QListView#navigation::item:hover { background: @hover; }
QListView#navigation::item:selected { background: @selected; color: @text; }
QDockWidget::title { background: @window; border-bottom: 1px solid @line; padding: 7px 8px; }
QMainWindow::separator { background: @line; width: 1px; height: 1px; margin: 2px; }
QTabBar::tab { border: none; border-bottom: 2px solid transparent; padding: 8px 12px; color: @faint; }
QTabBar::tab:selected { color: @text; border-bottom-color: @accent; }
QTabWidget::pane { border: none; border-top: 1px solid @line; }
QGroupBox { font-weight: 600; border: none; margin-top: 22px; }
QGroupBox::title { subcontrol-origin: margin; left: 0; }
QProgressBar { border: none; border-radius: 4px; background: @line; max-height: 8px; }
QProgressBar::chunk { border-radius: 4px; background: @accent; }
QStatusBar { border-top: 1px solid @line; }
QStatusBar::item { border: none; }
QScrollBar:vertical { width: 11px; background: transparent; }
QScrollBar:horizontal { height: 11px; background: transparent; }
QScrollBar::handle { background: @border; border-radius: 3px; margin: 2px; min-height: 24px; min-width: 24px; }
QScrollBar::handle:hover { background: @faint; }
QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }
)";

}  // namespace

QString styleSheetOf(const Theme& t) {
  constexpr double kHover = 0.08, kSelected = 0.2, kBorder = 0.35, kRaised = 0.03;
  QString rules = kRules;
  rules.replace("@text", t.text.name());
  rules.replace("@faint", t.faint_text.name());
  // In dark themes, Fusion's fields have no visible outline: they are darker than the lighter ground.
  rules.replace("@card", t.dark ? mixed(t.window, t.text, kRaised).name() : t.panel.name());
  rules.replace("@panel", t.panel.name());
  rules.replace("@window", t.window.name());
  rules.replace("@line", t.grid_line.name());
  rules.replace("@on_accent", t.dark ? "#101317" : "#ffffff");
  rules.replace("@accent_hover", mixed(t.accent, t.text, kHover).name());
  rules.replace("@accent", t.accent.name());
  rules.replace("@bad", t.bad.name());
  rules.replace("@hover", mixed(t.window, t.text, kHover).name());
  rules.replace("@selected", mixed(t.window, t.accent, kSelected).name());
  rules.replace("@border", mixed(t.window, t.faint_text, kBorder).name());
  return rules;
}

}  // namespace evical::ui
