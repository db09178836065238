// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/theme/system_appearance.h"

#include <QApplication>
#include <QDBusConnection>
#include <QDBusMessage>
#include <QPalette>

namespace evical::ui {
namespace {

const char* const kService = "org.freedesktop.portal.Desktop";
const char* const kPath = "/org/freedesktop/portal/desktop";
const char* const kInterface = "org.freedesktop.portal.Settings";
const char* const kGroup = "org.freedesktop.appearance";
const char* const kKey = "color-scheme";
const char* const kDesktopGroup = "org.gnome.desktop.interface";
const char* const kAnimationsKey = "enable-animations";
constexpr uint kPrefersDark = 1;

// Portals wrap the value in a variant, some of them twice.
QVariant unwrapped(QVariant value) {
  while (value.canConvert<QDBusVariant>()) value = value.value<QDBusVariant>().variant();
  return value;
}

// Invalid without an answer.
QVariant setting(const QDBusConnection& bus, const char* group, const char* key) {
  constexpr int kPatience_ms = 200;
  QDBusMessage question = QDBusMessage::createMethodCall(kService, kPath, kInterface, "Read");
  question << group << key;
  const QDBusMessage answer = bus.call(question, QDBus::Block, kPatience_ms);
  if (answer.type() != QDBusMessage::ReplyMessage || answer.arguments().isEmpty()) return {};
  return unwrapped(answer.arguments().constFirst());
}

}  // namespace

SystemAppearance& SystemAppearance::instance() {
  static SystemAppearance appearance;
  return appearance;
}

SystemAppearance::SystemAppearance() {
  constexpr int kHalfLight = 128;
  dark_ = QApplication::palette().color(QPalette::Window).lightness() < kHalfLight;
  if (qEnvironmentVariableIsSet("DBUS_SESSION_BUS_ADDRESS")) askPortal();
}

void SystemAppearance::askPortal() {
  QDBusConnection bus = QDBusConnection::sessionBus();
  const QVariant scheme = setting(bus, kGroup, kKey);
  if (!scheme.isValid()) return;
  dark_ = scheme.toUInt() == kPrefersDark;
  if (const QVariant animations = setting(bus, kDesktopGroup, kAnimationsKey); animations.isValid())
    animated_ = animations.toBool();
  bus.connect(kService, kPath, kInterface, "SettingChanged", this,
              SLOT(settingChanged(QString, QString, QDBusVariant)));
}

void SystemAppearance::settingChanged(const QString& group, const QString& key, const QDBusVariant& value) {
  if (group == kDesktopGroup && key == kAnimationsKey) animated_ = unwrapped(value.variant()).toBool();
  if (group != kGroup || key != kKey) return;
  const bool dark = unwrapped(value.variant()).toUInt() == kPrefersDark;
  if (dark == dark_) return;
  dark_ = dark;
  emit changed(dark_);
}

}  // namespace evical::ui
