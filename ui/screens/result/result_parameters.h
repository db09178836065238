// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a result: each quantity with its standard deviation, in shown units, and its difference to the
// compared result.
#pragma once

#include "core/report/result_yaml.h"

#include <QString>

#include <optional>
#include <vector>

namespace evical::ui {

struct ParameterRow {
  QString key;  // of data/quantity_difference.h: "left.rotation.x"; empty without a comparison
  QString name, unit;
  double value = 0.0;
  double sigma = 0.0;                // 0: not estimated
  std::optional<double> difference;  // this minus the other, same unit
  QString remark = {};               // for a tool tip
  QString detail = {};               // after the unit: "against the gyroscope"

  // With as many decimals as the sigma's second digit.
  QString valueText() const;
  QString sigmaText() const;
  QString differenceText() const;
  QString sigmasText() const;  // the difference in sigmas
};

struct ParameterGroup {
  QString title;
  std::vector<ParameterRow> rows;
  bool folded = false;  // at first: poses and time offsets are shown, details are not
};

std::vector<ParameterGroup> parameterGroups(const NamedResult& named);

// Tab-separated for spreadsheets: a header (name, value, sigma, unit, and differences if any), then one line
// per row. Names start with their group's title.
QString tabbedText(const std::vector<ParameterGroup>& groups);

// Fills in the differences, and returns notes on sensors with different names that were compared. Throws
// CalibrationError if the two have different sensors.
QStringList compare(std::vector<ParameterGroup>& groups, const NamedResult& named, const NamedResult& other);

}  // namespace evical::ui
