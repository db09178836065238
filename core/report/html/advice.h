// Advice for the next recording: each item is triggered by a measured value, which is given with it.
#pragma once

#include "core/report/html/html_report.h"
#include "core/report/html/measures.h"

#include <string>
#include <vector>

namespace evical::html {

struct Advice {
  std::string what;      // one sentence, imperative
  std::string evidence;  // the measured value
};

// Names of the image's thirds with hardly any circle: "top left, middle centre". Empty if there are none.
std::string emptyRegions(const CameraMeasures& camera);
// Advice for the most frequent reason why the board was not found; empty if it was always found.
std::string remedyForMissed(const CameraMeasures& camera);

std::vector<Advice> adviceFor(const ReportData& data, const Measures& measures);

}  // namespace evical::html
