// Verdict on an old calibration from both results: a test of each quantity, and one sentence for all.
#pragma once

#include "core/data/assessment.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/session/calibration_options.h"

#include <string>

namespace evical {

// Fills the check's findings.
void testQuantities(const ComparedQuantities& compared, const CheckOptions& options, CalibrationCheck& check);

// Verdict and reason from the findings, and advice if something has changed.
void judgeFindings(CalibrationCheck& check);

void setCannotTell(const std::string& reason, CalibrationCheck& check);
// The verdict on the recording of the old result itself, which agrees with it unless the session differs.
void judgeDuplicate(CalibrationCheck& check);
// Adds advice as a sentence, without duplicates.
void addAdvice(const std::string& advice, CalibrationCheck& check);

}  // namespace evical
