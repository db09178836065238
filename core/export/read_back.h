// How far exported files, read as their programs read them (core/foreign/readers.h), are from the result.
#pragma once

#include "core/export/export_target.h"
#include "core/foreign/read_calibration.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// The largest differences of what was read from the result; those of which nothing was read are empty.
struct ReadBackDifference {
  std::size_t cameras = 0, imus = 0;
  std::optional<double> lens_px = {};  // of the same ray, over the image
  std::optional<double> rotation_deg = {}, translation_mm = {}, time_ms = {};
  std::optional<double> numbers = {};  // relative, of scales, biases, noise, rates and gravity
  std::optional<double>
      refitted_px;  // of lenses that the program has no place for; as far as their refit is off
  std::vector<std::string>
      problems;  // more than rounding explains, or sensors that are nowhere; each names the file
};

// Sensors that the result does not have are left aside where the file names them.
ReadBackDifference differenceOf(const NamedResult& result, const ReadBack& read);

struct ExportCheck {
  bool same = false;
  std::string text;  // one line for people: "kalibr: reads back: ..."
};

// Of the files below folder / target.name.
ExportCheck checkExport(const NamedResult& result, const ExportTarget& target,
                        const std::filesystem::path& folder);

}  // namespace evical
