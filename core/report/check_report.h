// What a check says, for people and programs. Keys are a contract.
#pragma once

#include "core/data/calibration_check.h"

#include <string>

namespace evical {

const char* verdictName(CheckVerdict verdict);   // still_good, changed, cannot_tell
const char* verdictWords(CheckVerdict verdict);  // "still good"

std::string checkYaml(const CalibrationCheck& check);
std::string checkJson(const CalibrationCheck& check);
std::string checkTable(const CalibrationCheck& check);

// A sentence without its full stop.
std::string windowsText(const CheckedWindows& windows);

}  // namespace evical
