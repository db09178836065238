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
constexpr uint kPrefersDark = 1;

// Portals wrap the value in a variant, some of them twice.
uint unwrapped(QVariant value) {
  while (value.canConvert<QDBusVariant>()) value = value.value<QDBusVariant>().variant();
  return value.toUInt();
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
  constexpr int kPatience_ms = 200;
  QDBusConnection bus = QDBusConnection::sessionBus();
  QDBusMessage question = QDBusMessage::createMethodCall(kService, kPath, kInterface, "Read");
  question << kGroup << kKey;
  const QDBusMessage answer = bus.call(question, QDBus::Block, kPatience_ms);
  if (answer.type() != QDBusMessage::ReplyMessage || answer.arguments().isEmpty()) return;
  dark_ = unwrapped(answer.arguments().constFirst()) == kPrefersDark;
  bus.connect(kService, kPath, kInterface, "SettingChanged", this,
              SLOT(settingChanged(QString, QString, QDBusVariant)));
}

void SystemAppearance::settingChanged(const QString& group, const QString& key, const QDBusVariant& value) {
  if (group != kGroup || key != kKey) return;
  const bool dark = unwrapped(value.variant()) == kPrefersDark;
  if (dark == dark_) return;
  dark_ = dark;
  emit changed(dark_);
}

}  // namespace evical::ui
