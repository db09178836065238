// Difference between a result and its exported files, read like their programs do (core/foreign/readers.h).
#pragma once

#include "core/export/export_target.h"
#include "core/foreign/read_calibration.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Largest differences from the result; empty for data that were not read.
struct ReadBackDifference {
  std::size_t cameras = 0, imus = 0;
  std::optional<double> lens_px = {};  // of the same ray, over the image
  std::optional<double> rotation_deg = {}, translation_mm = {}, time_ms = {};
  std::optional<double> numbers = {};  // relative, of scales, biases, noise, rates and gravity
  std::optional<double> refitted_px;   // of lenses with unsupported models; the error of their refit
  std::vector<std::string> problems;   // above rounding errors, or missing sensors; each names the file
};

// Sensors that the result does not have are ignored if the file names them.
ReadBackDifference differenceOf(const NamedResult& result, const ReadBack& read);

struct ExportCheck {
  bool same = false;
  std::string text;  // one line for people: "kalibr: reads back: ..."
};

// Checks the files below folder / target.name.
ExportCheck checkExport(const NamedResult& result, const ExportTarget& target,
                        const std::filesystem::path& folder);

}  // namespace evical
