// SPDX-License-Identifier: GPL-3.0-or-later
// The desktop's settings for dark windows and animations, from its portal, with signals for changes. (Part of
// Qt from 6.5 on.)
#pragma once

#include <QDBusVariant>
#include <QObject>

namespace evical::ui {

class SystemAppearance : public QObject {
  Q_OBJECT

 public:
  static SystemAppearance& instance();  // GUI thread only

  // Without a portal: from the platform's palette before the first theme was applied.
  bool dark() const { return dark_; }
  // People who get dizzy disable animations.
  bool animated() const { return animated_; }

 signals:
  void changed(bool dark);

 private slots:
  void settingChanged(const QString& group, const QString& key, const QDBusVariant& value);

 private:
  SystemAppearance();
  void askPortal();

  bool dark_ = false, animated_ = true;
};

}  // namespace evical::ui
