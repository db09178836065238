// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/option_editor.h"

#include "ui/theme/plain_labels.h"
#include "ui/theme/theme.h"

#include <QCheckBox>
#include <QComboBox>
#include <QEvent>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPainter>
#include <QPixmap>
#include <QSignalBlocker>
#include <QToolButton>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

constexpr int kDot_px = 8, kInput_px = 80, kUnit_px = 40;

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

// Rich text in which the search text is highlighted.
QString marked(const QString& plain, const QString& search, const QColor& colour) {
  const qsizetype at = search.isEmpty() ? -1 : plain.indexOf(search, 0, Qt::CaseInsensitive);
  if (at < 0) return plain.toHtmlEscaped();
  constexpr double kPale = 0.3;
  const QString background =
      QStringLiteral("rgba(%1,%2,%3,%4)").arg(colour.red()).arg(colour.green()).arg(colour.blue()).arg(kPale);
  return plain.left(at).toHtmlEscaped() +
         QStringLiteral("<span style='background-color:%1'>%2</span>")
             .arg(background, plain.mid(at, search.size()).toHtmlEscaped()) +
         marked(plain.mid(at + search.size()), search, colour);
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
      name_(new QLabel(shownName(row), this)),
      help_(smallText({}, "hint", this)),
      idle_(smallText({}, "hint", this)),
      problem_(smallText({}, "problem", this)),
      reset_(new QToolButton(this)) {
  QWidget* const input = makeInput();
  for (QLabel* const label : {name_, help_, idle_}) label->setTextFormat(Qt::RichText);
  name_->setWordWrap(true);
  name_->setBuddy(input);
  const QString tip = QString("<b>%1</b><br>%2<br>%3")
                          .arg(text(row.name).toHtmlEscaped(), text(row.help).toHtmlEscaped(),
                               tr("Default: %1").arg(text(row.default_value)).toHtmlEscaped());
  setToolTip(tip);
  useRichToolTip(*this);
  input->setAccessibleName(shownName(row));
  input->setAccessibleDescription(text(row.help));
  reset_->setIcon(icon("reset"));
  reset_->setAccessibleName(tr("Reset %1 to its default").arg(shownName(row)));
  reset_->setToolTip(tr("Reset to the default, %1").arg(text(row.default_value)));
  connect(reset_, &QToolButton::clicked, this,
          [this] { emit edited(text(row_.name), text(row_.default_value)); });
  dot_->setFixedWidth(kDot_px);

  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(2, 3, 2, 5);
  grid->setHorizontalSpacing(6);
  grid->setVerticalSpacing(2);
  grid->setColumnStretch(1, 1);
  grid->addWidget(dot_, 0, 0);
  grid->addWidget(name_, 0, 1, 1, toggle_ != nullptr ? 2 : 3);
  grid->addWidget(reset_, 0, 4);
  if (toggle_ != nullptr) grid->addWidget(toggle_, 0, 3);
  if (choice_ != nullptr) grid->addWidget(choice_, 1, 1, 1, 4);
  if (number_ != nullptr) placeNumber(*grid);
  for (QLabel* const line : {help_, idle_, problem_}) grid->addWidget(line, grid->rowCount(), 1, 1, 4);
  idle_->hide();
  problem_->hide();
  highlight({});
  setRow(row);
}

// Below the name, so that the row is narrow: slider, field and unit.
void OptionEditor::placeNumber(QGridLayout& grid) {
  if (OptionSlider::fits(row_)) makeSlider(grid);
  auto* const unit = new QLabel(text(row_.unit), this);
  unit->setFixedWidth(std::max(kUnit_px, unit->sizeHint().width()));  // keeps most fields in one column
  grid.addWidget(number_, 1, 2);
  grid.addWidget(unit, 1, 3, 1, 2);
}

void OptionEditor::makeSlider(QGridLayout& grid) {
  slider_ = new OptionSlider(row_, this);
  slider_->setAccessibleName(tr("%1, slider").arg(shownName(row_)));
  slider_->setToolTip(rangeText(row_));
  connect(slider_, &OptionSlider::turning, number_, &QLineEdit::setText);
  connect(slider_, &OptionSlider::turned, this, [this](const QString& number) {
    if (number != text(row_.value)) emit edited(text(row_.name), number);
  });
  grid.addWidget(slider_, 1, 1);
}

QString OptionEditor::helpText() const {
  const QString range = rangeText(row_);
  return text(row_.help) + (range.isEmpty() ? "" : " " + tr("Range: %1.").arg(range));
}

void OptionEditor::highlight(const QString& search) {
  const QColor mark = theme().accent;
  name_->setText(marked(shownName(row_), search, mark));
  help_->setText(marked(helpText(), search, mark));
}

void OptionEditor::showIdle(const QString& why) {
  idle_->setText(why.isEmpty() ? QString()
                               : "<i>" + tr("No effect here: %1.").arg(why).toHtmlEscaped() + "</i>");
  idle_->setVisible(!why.isEmpty());
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
  if (slider_ != nullptr) slider_->setShown(text(row_.value));
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
  dot_->setToolTip(isChanged() ? tr("Differs from the default, %1").arg(text(row_.default_value))
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

namespace {

constexpr int kPositions = 200;
constexpr double kPowersFrom = 50.0;  // ratio of maximum and minimum
constexpr int kDigits = 3;

QString sliderText(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

bool isWhole(const std::string& number) {
  bool is_whole = false;
  QLocale::c().toLongLong(sliderText(number), &is_whole);
  return is_whole;
}

bool isNumber(const std::string& number) {
  bool is_number = false;
  return std::isfinite(QLocale::c().toDouble(sliderText(number), &is_number)) && is_number;
}

}  // namespace

bool OptionSlider::fits(const OptionRow& row) {
  return row.choices.empty() && isNumber(row.minimum) && isNumber(row.maximum);
}

OptionSlider::OptionSlider(const OptionRow& row, QWidget* parent)
    : QSlider(Qt::Horizontal, parent),
      minimum_(QLocale::c().toDouble(sliderText(row.minimum))),
      maximum_(QLocale::c().toDouble(sliderText(row.maximum))),
      whole_(isWhole(row.minimum) && isWhole(row.maximum) && isWhole(row.default_value)),
      powers_(minimum_ > 0.0 && maximum_ > kPowersFrom * minimum_) {
  setRange(0, whole_ ? static_cast<int>(std::min<double>(kPositions, maximum_ - minimum_)) : kPositions);
  setFocusPolicy(Qt::TabFocus);
  connect(this, &QSlider::valueChanged, this, [this](int position) {
    if (isSliderDown()) return emit turning(numberAt(position));
    emit turned(numberAt(position));
  });
  connect(this, &QSlider::sliderReleased, this, [this] { emit turned(numberAt(value())); });
}

void OptionSlider::setShown(const QString& number) {
  const double value = std::clamp(QLocale::c().toDouble(number), minimum_, maximum_);
  const double share = powers_ ? std::log(value / minimum_) / std::log(maximum_ / minimum_)
                               : (value - minimum_) / (maximum_ - minimum_);
  const QSignalBlocker quiet(this);
  setValue(static_cast<int>(std::lround(share * maximum())));
}

QString OptionSlider::numberAt(int position) const {
  const double share = static_cast<double>(position) / maximum();
  const double value =
      powers_ ? minimum_ * std::pow(maximum_ / minimum_, share) : minimum_ + share * (maximum_ - minimum_);
  if (whole_) return QString::number(std::llround(value));
  const QString rounded = QString::number(value, 'g', kDigits);
  const double shown = std::clamp(rounded.toDouble(), minimum_, maximum_);  // rounding may exceed the range
  return QLocale::c().toString(shown, 'g', shown == rounded.toDouble() ? kDigits : 12);
}

void OptionSlider::wheelEvent(QWheelEvent* event) {
  event->ignore();
}

}  // namespace evical::ui
