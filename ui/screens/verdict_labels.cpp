// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/verdict_labels.h"

#include "ui/forms/form_words.h"
#include "ui/theme/theme.h"

#include <QObject>
#include <QRegularExpression>

#include <algorithm>
#include <utility>

namespace evical::ui {
namespace {

bool isObstacle(const Assessed& one) {
  return one.thing == AssessedThing::Obstacle && one.light != Light::Good;
}

}  // namespace

bool isOfRecording(AssessedThing thing) {
  switch (thing) {
    case AssessedThing::Duration:
    case AssessedThing::Board:
    case AssessedThing::Coverage:
    case AssessedThing::Speed:
    case AssessedThing::Turns:
    case AssessedThing::Accelerations:
      return true;
    default:
      return false;
  }
}

QString titleOf(AssessedThing thing) {
  switch (thing) {
    case AssessedThing::Duration:
      return QObject::tr("Duration");
    case AssessedThing::Board:
      return QObject::tr("Board in view");
    case AssessedThing::Coverage:
      return QObject::tr("Coverage");
    case AssessedThing::Speed:
      return QObject::tr("Speed");
    case AssessedThing::Lens:
      return QObject::tr("Lens");
    case AssessedThing::Turns:
      return QObject::tr("Angular rate (x, y, z)");
    case AssessedThing::Accelerations:
      return QObject::tr("Accelerations (x, y, z)");
    case AssessedThing::Rotation:
      return QObject::tr("Expected uncertainty of the rotation");
    case AssessedThing::Translation:
      return QObject::tr("Expected uncertainty of the translation");
    case AssessedThing::TimeOffset:
      return QObject::tr("Expected uncertainty of the time offset");
    case AssessedThing::Obstacle:
      return QObject::tr("Problem");
  }
  return {};
}

QString sentence(QString text) {
  text = inFormWords(std::move(text));
  static const QRegularExpression name("^[^ ]+: ");  // of a sensor or a key, which is not changed
  if (!text.isEmpty() && !text.contains(name)) text[0] = text[0].toUpper();
  if (!text.isEmpty() && !text.endsWith('.') && !text.endsWith('?')) text += '.';
  return text;
}

std::vector<const Assessed*> worstFirst(const RecordingAssessment& assessment) {
  std::vector<const Assessed*> sorted;
  for (const Assessed& one : assessment.all) sorted.push_back(&one);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Assessed* a, const Assessed* b) {
    const bool first = isObstacle(*a), second = isObstacle(*b);
    return first != second ? first : a->light > b->light;
  });
  return sorted;
}

QString summaryOf(const RecordingAssessment& assessment) {
  if (!assessment.board_seen) return QObject::tr("The board was never seen");
  if (!assessment.can_be_calibrated) return QObject::tr("This recording cannot be calibrated");
  if (std::any_of(assessment.all.begin(), assessment.all.end(), isObstacle))
    return QObject::tr("The session contradicts this recording");
  switch (assessment.light) {
    case Light::Good:
      return QObject::tr("This recording is good enough");
    case Light::Fair:
      return QObject::tr("This recording is sufficient, but could be better");
    case Light::Poor:
      return QObject::tr("This recording is not good enough");
  }
  return {};
}

QString summaryWhileWritten(const RecordingAssessment& assessment) {
  QString so_far;
  for (const Assessed& one : assessment.all)
    if (one.thing == AssessedThing::Duration) so_far = QString::fromStdString(one.measured);
  if (!assessment.board_seen) return QObject::tr("%1 so far: the board was never seen").arg(so_far);
  switch (assessment.light) {
    case Light::Good:
      return QObject::tr("%1 so far: good enough, you can stop recording").arg(so_far);
    case Light::Fair:
      return QObject::tr("%1 so far: sufficient, but could be better").arg(so_far);
    case Light::Poor:
      return QObject::tr("%1 so far: not enough yet").arg(so_far);
  }
  return {};
}

QString stillMissing(const RecordingAssessment& assessment) {
  QStringList missing;
  for (const bool of_recording : {true, false}) {
    for (const Assessed* const one : worstFirst(assessment)) {
      const QString advice = sentence(QString::fromStdString(one->advice));
      if (isOfRecording(one->thing) != of_recording || advice.isEmpty() || missing.contains(advice)) continue;
      missing << advice;
    }
    if (!missing.isEmpty()) break;
  }
  return missing.isEmpty() ? QString() : QObject::tr("Still missing: %1").arg(missing.join(' '));
}

QIcon verdictIcon(CalibrationStatus status) {
  switch (status) {
    case CalibrationStatus::Ok:
      return icon("done", theme().good);
    case CalibrationStatus::Doubtful:
      return icon("warning", theme().warning);
    case CalibrationStatus::Failed:
      break;
  }
  return icon("error", theme().bad);
}

}  // namespace evical::ui
