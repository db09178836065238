// What is said of an old calibration once both results are there: each quantity tested, and the sentence for all.
#pragma once

#include "core/data/calibration_check.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/session/check_options.h"

#include <string>

namespace evical {

// Fills the check's findings.
void testQuantities(const ComparedQuantities& compared, const CheckOptions& options, CalibrationCheck& check);

// Verdict and reason from the findings, and what to do where something has changed.
void judgeFindings(CalibrationCheck& check);

void setCannotTell(const std::string& reason, CalibrationCheck& check);
// As a sentence, once.
void addAdvice(const std::string& advice, CalibrationCheck& check);

}  // namespace evical
