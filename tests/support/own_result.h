// For tests that change the numbers of a result.
#pragma once

#include "core/report/result_yaml.h"

#include <memory>

namespace evical::test {

// `named`'s numbers, from now on shared with nobody else.
inline CalibrationResult& ownResult(NamedResult& named) {
  const auto copy = std::make_shared<CalibrationResult>(*named.result);
  named.result = copy;
  return *copy;
}

}  // namespace evical::test
