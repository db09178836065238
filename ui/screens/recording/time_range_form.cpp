// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/time_range_form.h"

#include "ui/forms/number_field.h"
#include "ui/theme/theme.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QStyle>
#include <QToolButton>

namespace evical::ui {
namespace {

QString numberText(double value) {
  constexpr int kDigits = 12;
  return QLocale::c().toString(value, 'g', kDigits);
}

// Typed text: a time, nothing, or invalid.
struct Typed {
  bool is_empty = false;
  double time_s = 0.0;
  QString problem = {};
};

Typed typedIn(const QLineEdit& field) {
  if (field.text().trimmed().isEmpty()) return {true};
  const auto [time_s, problem] = typedNumber(field.text());
  const QString advice = QObject::tr("Enter seconds since the recording's start.");
  if (!time_s) return {false, 0.0, problem + ". " + advice};
  return {false, *time_s, *time_s < 0.0 ? advice : QString()};
}

QLineEdit* timeField(const QString& help, QWidget* parent) {
  constexpr int kWidth_px = 84;
  auto* const field = new QLineEdit(parent);
  field->setFixedWidth(kWidth_px);
  field->setAlignment(Qt::AlignRight);
  field->setToolTip(help);
  field->setAccessibleName(help);
  return field;
}

}  // namespace

TimeRangeForm::TimeRangeForm(QWidget* parent)
    : QWidget(parent),
      begin_(timeField(tr("Beginning in seconds since the recording's start; empty: from the start"), this)),
      end_(timeField(tr("End in seconds since the recording's start; empty: to its end"), this)),
      all_(new QToolButton(this)),
      words_(new QLabel(this)) {
  begin_->setObjectName("time_range_begin");
  end_->setObjectName("time_range_end");
  words_->setObjectName("time_range_words");
  words_->setWordWrap(true);
  all_->setIcon(icon("reset"));
  all_->setToolTip(tr("Use all of the recording"));
  all_->setAccessibleName(all_->toolTip());
  auto* const label = new QLabel(tr("Time range [s]"), this);
  label->setBuddy(begin_);
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(label);
  row->addWidget(begin_);
  row->addWidget(new QLabel(tr("to"), this));
  row->addWidget(end_);
  row->addWidget(all_);
  row->addWidget(words_, 1);
  connect(begin_, &QLineEdit::editingFinished, this, &TimeRangeForm::take);
  connect(end_, &QLineEdit::editingFinished, this, &TimeRangeForm::take);
  connect(all_, &QToolButton::clicked, this, [this] {
    begin_->clear();
    end_->clear();
    take();
  });
  setRange({});
}

void TimeRangeForm::setRange(const Range& range_s) {
  range_s_ = range_s;
  begin_->setText(range_s ? numberText((*range_s)[0]) : QString());
  end_->setText(range_s ? numberText((*range_s)[1]) : QString());
  showAdvice();
}

void TimeRangeForm::setDuration(std::optional<double> duration_s) {
  duration_s_ = duration_s;
  showAdvice();
}

void TimeRangeForm::take() {
  const Typed begin = typedIn(*begin_), end = typedIn(*end_);
  for (const Typed& typed : {begin, end})
    if (!typed.problem.isEmpty()) return say(typed.problem);
  const bool to_the_end = end.is_empty;
  if (begin.time_s == 0.0 && to_the_end) {
    if (range_s_) emit edited({});
    return showAdvice();
  }
  if (to_the_end && !duration_s_)
    return say(tr("Enter the end as well: the recording's end is not yet known."));
  const double end_s = to_the_end ? *duration_s_ : end.time_s;
  if (duration_s_ && begin.time_s >= *duration_s_)
    return say(tr("The recording ends at %1 s.").arg(*duration_s_, 0, 'f', 2));
  if (end_s <= begin.time_s) return say(tr("The end must be after the beginning."));
  const std::array<double, 2> typed = {begin.time_s, end_s};
  if (range_s_ != typed) emit edited(typed);
  showAdvice();
}

// The typed text stays, so that it can be corrected.
void TimeRangeForm::say(const QString& problem) {
  words_->setText(problem);
  words_->setProperty("role", "problem");
  words_->style()->polish(words_);
}

void TimeRangeForm::showAdvice() {
  begin_->setPlaceholderText("0");
  end_->setPlaceholderText(duration_s_ ? QString::number(*duration_s_, 'f', 2) : tr("the end"));
  all_->setEnabled(range_s_.has_value());
  QString advice = tr("All of the recording is used.");
  if (range_s_) {
    const auto [begin_s, end_s] = *range_s_;
    advice = tr("%1 s of the recording are used.").arg(end_s - begin_s, 0, 'g', 4);
    if (duration_s_ && end_s > *duration_s_)
      advice = tr("The recording ends earlier, at %1 s.").arg(*duration_s_, 0, 'f', 2);
  }
  words_->setText(advice);
  words_->setProperty("role", "hint");
  words_->style()->polish(words_);
}

}  // namespace evical::ui
