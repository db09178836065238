// Times of a text table: their columns, units and notation.
#pragma once

#include "core/recording/text/table_head.h"

namespace evical {

// Column of the time among those that the header names, and other candidates for it that are not used.
struct TimeChoice {
  std::vector<std::size_t> columns;  // the time is their sum
  bool doubtful = false;             // another column is as suitable
};
TimeChoice chooseTime(const TableHeader& header, std::span<const TableColumn> table,
                      const std::string& imu = {});

// Unit of whole or fractional times: IMUs give 20 to 20 000 samples a second; for events see
// guessTimeUnit_ns.
std::int64_t guessUnit_ns(const TableColumn& time, StreamType type);

// Sets the units of columns.time whose unit_ns is 0, and notes doubtful ones.
void chooseTimeUnit(std::span<const TableColumn> table, TextColumns& columns);

// Notation of times: of the day, or seconds and their fractions without leading zeros. Sets columns.problem
// if no time can be read, or if all are equal.
void checkTimes(const TableHead& head, TextColumns& columns);

}  // namespace evical
