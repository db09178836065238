// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/theme/plain_labels.h"

#include <QApplication>
#include <QEvent>
#include <QLabel>
#include <QPointer>
#include <QVariant>
#include <QWidget>

namespace evical::ui {
namespace {

constexpr const char* kRichToolTip = "evical_rich_tool_tip";

class PlainLabels : public QObject {
 public:
  using QObject::QObject;

  bool eventFilter(QObject* object, QEvent* event) override {
    if (event->type() == QEvent::Polish) polish(qobject_cast<QLabel*>(object));
    if (event->type() == QEvent::ToolTip && object->isWidgetType()) beforeToolTip(*object);
    return false;
  }

 private:
  // Before the label is first shown or measured.
  void polish(QLabel* label) {
    if (label == nullptr || label->textFormat() != Qt::AutoText) return;
    const bool tip = label->inherits("QTipLabel");
    if (tip) tip_ = label;
    label->setTextFormat(tip && rich_ ? Qt::RichText : Qt::PlainText);
  }

  // The visible tool tip is used again for the next text.
  void beforeToolTip(const QObject& widget) {
    rich_ = widget.property(kRichToolTip).toBool();
    if (tip_) tip_->setTextFormat(rich_ ? Qt::RichText : Qt::PlainText);
  }

  QPointer<QLabel> tip_;
  bool rich_ = false;
};

}  // namespace

void showTextAsPlain(QApplication& application) {
  const char* const name = "evical_plain_labels";
  if (application.findChild<QObject*>(name, Qt::FindDirectChildrenOnly) != nullptr) return;
  auto* const filter = new PlainLabels(&application);
  filter->setObjectName(name);
  application.installEventFilter(filter);
}

void useRichToolTip(QWidget& widget) {
  widget.setProperty(kRichToolTip, true);
}

}  // namespace evical::ui
