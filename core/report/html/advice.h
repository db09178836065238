// What to do better next time: each piece only where the data say so, with the number that says it.
#pragma once

#include "core/report/html/html_report.h"
#include "core/report/html/measures.h"

#include <string>
#include <vector>

namespace evical::html {

struct Advice {
  std::string what;      // one sentence, imperative
  std::string evidence;  // what was measured
};

// Thirds of the image where hardly any circle was, in words: "top left, centre"; empty where there is none.
std::string emptyRegions(const CameraMeasures& camera);
// What mends most of the windows without the board; empty where there is none.
std::string remedyForMissed(const CameraMeasures& camera);

std::vector<Advice> adviceFor(const ReportData& data, const Measures& measures);

}  // namespace evical::html
