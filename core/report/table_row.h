// One row of a table for terminals: a name, a number with its +-, a unit.
#pragma once

#include <string>

namespace evical {

std::string tableRow(const std::string& name, double value, double sigma, const char* unit, int decimals = 5);

}  // namespace evical
