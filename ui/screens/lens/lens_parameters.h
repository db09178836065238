// SPDX-License-Identifier: GPL-3.0-or-later
// A calibrated lens as rows for people: each number with its standard deviation, how far it is from another lens's, and
// what it rests on.
#pragma once

#include "core/pipeline/lens/lens_comparison.h"
#include "core/report/intrinsics_report.h"

#include <QString>

#include <optional>
#include <vector>

namespace evical::ui {

struct LensRow {
  QString name, value, sigma, unit;
  QString difference, sigmas;  // against the other lens; empty where nothing is compared
  bool far = false;            // by more than three sigmas
};

struct LensGroup {
  QString title;
  std::vector<LensRow> rows;
};

std::vector<LensGroup> lensGroups(const NamedIntrinsics& named,
                                  const std::optional<LensComparison>& compared);

// A line each: the models that the views were explained with, the spread of their errors and the share of the points
// that they explain; the one taken says so.
std::vector<LensRow> triedModels(const NamedIntrinsics& named);

}  // namespace evical::ui
