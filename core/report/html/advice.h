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

std::vector<Advice> adviceFor(const ReportData& data, const Measures& measures);

}  // namespace evical::html
