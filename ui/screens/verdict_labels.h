// SPDX-License-Identifier: GPL-3.0-or-later
// Texts of the card that assesses a recording.
#pragma once

#include "core/data/calibration_status.h"
#include "core/pipeline/rig/recording_assessment.h"

#include <QIcon>
#include <QString>

#include <vector>

namespace evical::ui {

// Criteria of motion and place, which the person who records can still improve.
bool isOfRecording(AssessedThing thing);
QString titleOf(AssessedThing thing);
QString sentence(QString text);  // in the words of the forms, with a capital and a full stop
// Obstacles first, since other measures may be their consequences; then from worst to best. Ties keep their
// order.
std::vector<const Assessed*> worstFirst(const RecordingAssessment& assessment);

QString summaryOf(const RecordingAssessment& assessment);
// For the existing part of a recording that is still being written.
QString summaryWhileWritten(const RecordingAssessment& assessment);
QString stillMissing(const RecordingAssessment& assessment);  // empty: nothing

// Icon of a verdict, distinct by colour and by shape.

QIcon verdictIcon(CalibrationStatus status);

}  // namespace evical::ui
