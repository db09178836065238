// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_editor.h"

#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QEvent>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPainter>
#include <QPixmap>
#include <QToolButton>

namespace evical::ui {
namespace {

constexpr int kDot_px = 8, kInput_px = 92;

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

QPixmap dotPixmap(const QColor& colour, double ratio) {
  QPixmap pixmap(QSize(kDot_px, kDot_px) * ratio);
  pixmap.setDevicePixelRatio(ratio);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colour);
  painter.drawEllipse(QRectF(1, 1, kDot_px - 2, kDot_px - 2));
  return pixmap;
}

QLabel* smallText(const QString& content, const char* role, QWidget* parent) {
  auto* const label = new QLabel(content, parent);
  label->setProperty("role", role);
  label->setWordWrap(true);
  QFont font = label->font();
  font.setPointSizeF(0.9 * font.pointSizeF());
  label->setFont(font);
  return label;
}

}  // namespace

QString OptionEditor::shownName(const OptionRow& row) {
  QString name = text(row.name).section('.', -1);
  QString suffix = text(row.unit).toLower();
  suffix.replace('/', '_').remove('^');
  if (!suffix.isEmpty() && name.endsWith("_" + suffix)) name.chop(suffix.size() + 1);
  return name.replace('_', ' ');
}

QString OptionEditor::rangeText(const OptionRow& row) {
  if (!row.choices.empty()) return {};
  return tr("%1 to %2 %3").arg(text(row.minimum), text(row.maximum), text(row.unit)).trimmed();
}

OptionEditor::OptionEditor(const OptionRow& row, QWidget* parent)
    : QWidget(parent),
      row_(row),
      dot_(new QLabel(this)),
      problem_(smallText({}, "problem", this)),
      reset_(new QToolButton(this)) {
  QWidget* const input = makeInput();
  auto* const name = new QLabel(shownName(row), this);
  name->setWordWrap(true);
  name->setBuddy(input);
  const QString range = rangeText(row);
  const QString tip =
      QString("<b>%1</b><br>%2<br>%3")
          .arg(text(row.name), text(row.help), tr("Default: %1").arg(text(row.default_value)));
  setToolTip(tip);
  input->setAccessibleName(shownName(row));
  input->setAccessibleDescription(text(row.help));
  reset_->setIcon(icon("reset"));
  reset_->setToolTip(tr("Back to the default, %1").arg(text(row.default_value)));
  connect(reset_, &QToolButton::clicked, this,
          [this] { emit edited(text(row_.name), text(row_.default_value)); });
  dot_->setFixedWidth(kDot_px);

  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(2, 3, 2, 5);
  grid->setHorizontalSpacing(6);
  grid->setVerticalSpacing(2);
  grid->setColumnStretch(1, 1);
  grid->addWidget(dot_, 0, 0);
  grid->addWidget(name, 0, 1);
  grid->addWidget(input, 0, 2);
  grid->addWidget(new QLabel(text(row.unit), this), 0, 3);
  grid->addWidget(reset_, 0, 4);
  const QString help = text(row.help) + (range.isEmpty() ? "" : " " + tr("From %1.").arg(range));
  grid->addWidget(smallText(help, "hint", this), 1, 1, 1, 4);
  grid->addWidget(problem_, 2, 1, 1, 4);
  problem_->hide();
  setRow(row);
}

QWidget* OptionEditor::makeInput() {
  if (row_.choices == std::vector<std::string>{"false", "true"}) {
    toggle_ = new QCheckBox(this);
    connect(toggle_, &QCheckBox::clicked, this,
            [this](bool on) { emit edited(text(row_.name), on ? "true" : "false"); });
    return toggle_;
  }
  if (!row_.choices.empty()) {
    choice_ = new QComboBox(this);
    for (const std::string& word : row_.choices) choice_->addItem(text(word));
    choice_->setFocusPolicy(Qt::StrongFocus);
    connect(choice_, &QComboBox::textActivated, this,
            [this](const QString& word) { emit edited(text(row_.name), word); });
    return choice_;
  }
  number_ = new QLineEdit(this);
  number_->setFixedWidth(kInput_px);
  number_->setAlignment(Qt::AlignRight);
  connect(number_, &QLineEdit::editingFinished, this, [this] {
    const QString typed = number_->text().trimmed();
    if (typed != text(row_.value)) emit edited(text(row_.name), typed);
    if (typed == text(row_.value)) {
      showProblem({});
      emit takenBack();
    }
  });
  return number_;
}

void OptionEditor::setRow(const OptionRow& row) {
  row_ = row;
  showValue();
  showProblem({});
  showChanged();
}

void OptionEditor::showValue() {
  if (toggle_ != nullptr) toggle_->setChecked(row_.value == "true");
  if (choice_ != nullptr) choice_->setCurrentText(text(row_.value));
  if (number_ != nullptr) number_->setText(text(row_.value));
}

void OptionEditor::showProblem(const QString& problem) {
  problem_->setText(problem);
  problem_->setVisible(!problem.isEmpty());
}

void OptionEditor::refuse(const QString& why) {
  showValue();
  showProblem(why);
}

void OptionEditor::showChanged() {
  dot_->setPixmap(isChanged() ? dotPixmap(theme().accent, devicePixelRatioF()) : QPixmap());
  dot_->setToolTip(isChanged() ? tr("Differs from its default, %1").arg(text(row_.default_value))
                               : QString());
  QSizePolicy policy = reset_->sizePolicy();
  policy.setRetainSizeWhenHidden(true);
  reset_->setSizePolicy(policy);
  reset_->setVisible(isChanged());
}

bool OptionEditor::matches(const QString& search) const {
  const QString all = text(row_.name) + ' ' + shownName(row_) + ' ' + text(row_.help);
  return all.contains(search, Qt::CaseInsensitive);
}

void OptionEditor::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) showChanged();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
