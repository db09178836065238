// result.yaml, our result file: written from a document, and read back into one. Truth files of simulations
// have the same keys and are read by the same function.
#pragma once

#include "core/report/result_document.h"

#include <filesystem>
#include <string>

namespace evical {

std::string resultYaml(const ResultDocument& document);

// Throws CalibrationError (BadInput) where the file is no result or truth. Unknown keys are left alone: newer
// versions add some.
ResultDocument readResult(const std::filesystem::path& file);

}  // namespace evical
