// Labels with wrapped text in a role of the theme.
#pragma once

#include <QLabel>
#include <QPainter>
#include <QString>
#include <QStyle>

namespace evical::ui {

inline QLabel* wrappedLabel(const QString& text, const char* role, QWidget* parent) {
  auto* const label = new QLabel(text, parent);
  label->setProperty("role", role);
  label->setWordWrap(true);
  return label;
}

// One line, for names of files: they have no spaces where a text could wrap, so dots replace the middle of a
// long one. Its owner sets the tool tip.
class ElidedLabel : public QLabel {
 public:
  ElidedLabel(const char* role, QWidget* parent) : QLabel(parent) { setProperty("role", role); }
  QSize minimumSizeHint() const override { return {0, QLabel::minimumSizeHint().height()}; }

 protected:
  void paintEvent(QPaintEvent*) override {
    QPainter painter(this);
    const QString shown = fontMetrics().elidedText(text(), Qt::ElideMiddle, contentsRect().width());
    style()->drawItemText(&painter, contentsRect(), static_cast<int>(alignment()), palette(), isEnabled(),
                          shown, foregroundRole());
  }
};

// Text that can be selected and copied.
inline QLabel* selectableLabel(const char* role, const QString& text, QWidget* parent) {
  QLabel* const label = wrappedLabel(text, role, parent);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}
inline QLabel* selectableLabel(const char* role, QWidget* parent) {
  return selectableLabel(role, QString(), parent);
}

}  // namespace evical::ui
