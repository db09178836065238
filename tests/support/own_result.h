// For tests that change the values of a result.
#pragma once

#include "core/report/result_yaml.h"

#include <memory>

namespace evical::test {

// The values of `named`, from now on not shared.
inline CalibrationResult& ownResult(NamedResult& named) {
  const auto copy = std::make_shared<CalibrationResult>(*named.result);
  named.result = copy;
  return *copy;
}

}  // namespace evical::test
