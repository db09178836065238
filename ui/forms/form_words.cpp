// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/forms/form_words.h"

#include <QRegularExpression>

namespace evical::ui {
namespace {

const QString kNumber = "([0-9]+(?:\\.[0-9]+)?(?:e[-+]?[0-9]+)?)";

QString millimetres(const QString& metres) {
  constexpr int kDigits = 6;  // hides rounding errors of the conversion
  return QString::number(1e3 * metres.toDouble(), 'g', kDigits) + " mm";
}

// Replaces matches one after the other; `replaced` gets each match.
template <class Replaced>
void replaceAll(QString& text, const QRegularExpression& pattern, const Replaced& replaced) {
  qsizetype from = 0;
  for (QRegularExpressionMatch match = pattern.match(text); match.hasMatch();
       match = pattern.match(text, from)) {
    const QString by = replaced(match);
    text.replace(match.capturedStart(), match.capturedLength(), by);
    from = match.capturedStart() + by.size();
  }
}

}  // namespace

QString inFormWords(QString text) {
  static const QRegularExpression key("\\b(?:board\\.)?(spacing|radius|tag_size|length)_m\\b(?:(:| to| =) ?" +
                                      kNumber + "(?: m\\b)?)?");
  static const QRegularExpression length("\\b(spacing|radius|tag size|length)( of)? " + kNumber + " m\\b");
  replaceAll(text, key, [](const QRegularExpressionMatch& match) {
    const QString label = match.captured(1).replace('_', ' ');
    const QString between = match.captured(2) == " to" ? " to " : " ";
    return match.captured(3).isEmpty() ? label : label + between + millimetres(match.captured(3));
  });
  replaceAll(text, length, [](const QRegularExpressionMatch& match) {
    return match.captured(1) + match.captured(2) + ' ' + millimetres(match.captured(3));
  });
  return text.replace("on the print, in metres", "on the print, in millimetres");
}

}  // namespace evical::ui
