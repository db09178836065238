// SPDX-License-Identifier: GPL-3.0-or-later
// What the card that judges a recording says.
#pragma once

#include "core/pipeline/rig/recording_assessment.h"

#include <QString>

#include <vector>

namespace evical::ui {

QString titleOf(AssessedThing thing);
QString sentence(QString text);  // with a capital and a full stop
// What is worst first; of two alike what comes first.
std::vector<const Assessed*> worstFirst(const RecordingAssessment& assessment);

QString summaryOf(const RecordingAssessment& assessment);
// Of what there is so far of a recording that goes on.
QString summaryWhileWritten(const RecordingAssessment& assessment);
QString stillMissing(const RecordingAssessment& assessment);  // empty: nothing

}  // namespace evical::ui
