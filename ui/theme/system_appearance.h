// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the desktop wants dark windows, and whether it wants things to move: asked from its portal, told when it changes. (Qt
// has this from 6.5 on.)
#pragma once

#include <QDBusVariant>
#include <QObject>

namespace evical::ui {

class SystemAppearance : public QObject {
  Q_OBJECT

 public:
  static SystemAppearance& instance();  // GUI thread only

  // Without a portal: what the platform's own palette says, as it was before the first theme was applied.
  bool dark() const { return dark_; }
  // People who get dizzy turn animations off.
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
