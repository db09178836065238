// SPDX-License-Identifier: GPL-3.0-or-later
// Each number over several recordings: mean, observed and predicted spread, and joint solution; with a
// comparison of two recordings.
#pragma once

#include "core/report/repeat_comparison.h"
#include "ui/screens/assessment/finding_table.h"

#include <cstddef>
#include <optional>

namespace evical::ui {

class RepeatTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column {
    kNumber,
    kMean,
    kDeviation,
    kMeanSigma,
    kRatio,
    kTogether,
    kFirst,
    kSecond,
    kDifference,
    kSigmas,
    kColumns
  };

  explicit RepeatTable(QWidget* parent = nullptr);

  void setRepeat(const Repeatability& repeat);
  // Columns of the repeat, or kAllTogether; without a value, the comparison is hidden.
  struct Pair {
    std::size_t first = 0, second = kAllTogether;
    QString first_name = {}, second_name = {};
  };
  void comparePair(const std::optional<Pair>& pair);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void fill();
  QTreeWidgetItem* itemOf(const RepeatedNumber& number) const;
  void fillPair(const RepeatedNumber& number, QTreeWidgetItem& item) const;

  Repeatability repeat_;
  std::optional<Pair> pair_;
};

// Recordings of a repeat: whether they fit, their distances from the others, and the reasons.
class RepeatedList : public CopyTable {
  Q_OBJECT

 public:
  enum Column { kName, kOutcome, kDistance, kWhat, kFile, kColumns };

  explicit RepeatedList(QWidget* parent = nullptr);

  void setRecordings(std::vector<RepeatedRecording> recordings);
  std::optional<std::size_t> chosen() const;  // if exactly one is selected

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void fill();

  std::vector<RepeatedRecording> recordings_;
};

}  // namespace evical::ui
