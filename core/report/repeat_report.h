// What a repeat says, for people and programs. Keys are a contract.
#pragma once

#include "core/data/repeatability.h"

#include <string>

namespace evical {

const char* verdictName(RepeatVerdict verdict);   // agree, disagree, failed
const char* verdictWords(RepeatVerdict verdict);  // "they agree"
const char* outcomeName(RepeatOutcome outcome);   // fits, does_not_fit, failed

std::string repeatYaml(const Repeatability& repeat);
std::string repeatJson(const Repeatability& repeat);
std::string repeatTable(const Repeatability& repeat);
std::string repeatCsv(const Repeatability& repeat);  // a line for each number

}  // namespace evical
