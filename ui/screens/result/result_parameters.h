// SPDX-License-Identifier: GPL-3.0-or-later
// A result as rows for people: each quantity with its standard deviation, in units that people use, and how
// far it is from what it is compared with.
#pragma once

#include "core/report/result_yaml.h"

#include <QString>

#include <optional>
#include <vector>

namespace evical::ui {

struct ParameterRow {
  QString key;  // as data/quantity_difference.h names it: "left.rotation.x"; empty where nothing is compared
  QString name, unit;
  double value = 0.0;
  double sigma = 0.0;                // 0: not estimated
  std::optional<double> difference;  // this minus the other, same unit
  QString remark = {};               // what to know before the value is used
  QString detail = {};               // behind the unit: "against the gyroscope"

  // As many decimals as the sigma's second digit.
  QString valueText() const;
  QString sigmaText() const;
  QString differenceText() const;
  QString sigmasText() const;  // the difference in sigmas
};

struct ParameterGroup {
  QString title;
  std::vector<ParameterRow> rows;
};

std::vector<ParameterGroup> parameterGroups(const NamedResult& named);

// With tabulators, for spreadsheets: a line a row below a header of name, value, sigma and unit, and the differences
// where there are any. Names begin with their group's title.
QString tabbedText(const std::vector<ParameterGroup>& groups);

// Fills in the differences. Throws CalibrationError if the two don't name the same sensors.
void compare(std::vector<ParameterGroup>& groups, const NamedResult& named, const NamedResult& other);

}  // namespace evical::ui
