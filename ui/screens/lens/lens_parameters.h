// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a calibrated lens: each number with its standard deviation, its difference to another lens, and the
// data behind it.
#pragma once

#include "core/pipeline/lens/lens_comparison.h"
#include "core/report/intrinsics_report.h"

#include <QString>

#include <optional>
#include <vector>

namespace evical::ui {

struct LensRow {
  QString name, value, sigma, unit;
  QString difference, sigmas;  // to the other lens; empty without a comparison
  bool far = false;            // by more than three sigmas
};

struct LensGroup {
  QString title;
  std::vector<LensRow> rows;
};

std::vector<LensGroup> lensGroups(const NamedIntrinsics& named,
                                  const std::optional<LensComparison>& compared);

// One row per model that was tried: the spread of its errors, the share of points that it explains, and a
// mark for the selected one.
std::vector<LensRow> triedModels(const NamedIntrinsics& named);

}  // namespace evical::ui
