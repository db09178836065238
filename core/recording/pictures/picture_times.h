// Tables of picture times, one row each. Lines that are not rows are faults, except for comments,
// empty lines, and the first line if it has names.
#pragma once

#include "core/recording/pictures/picture_lists.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical::pictures {

// Appends the rows "time, name" of a table; its unit of time is 10^unit_digits ns.
void readNamedTimes(const std::filesystem::path& table, int unit_digits, PictureList& list);

// Appends the rows of a table in any order of columns: a time (a number, or a date of two columns) and the
// name of a picture in the list's folder, with or without its extension. Rows without names are paired with
// the pictures in order.
void readAnyTimes(const std::filesystem::path& table, int unit_digits, PictureList& list);

// Digits of the unit of a table of whole numbers, or of numbers with decimals, which are s.
int usualDigits(const std::filesystem::path& table, int of_decimals);

// The first column, or the first two, of a table, in ns.
struct TimeRow {
  std::int64_t first_ns = 0, second_ns = 0;
};
std::vector<TimeRow> readTimes(const std::filesystem::path& table, int unit_digits, bool two_columns,
                               PictureList& list);

// Assigns the times of the rows to the pictures of the list's folder, in the order of their names: the middle
// if there are two. Pictures or rows without a partner are skipped and reported.
void pairWithTimes(const std::vector<TimeRow>& rows, bool two_columns, PictureList& list);

// Assigns exposures of a table in us to pictures with times.
void readExposures(const std::filesystem::path& table, PictureList& list);

void addFault(PictureList& list, FaultKind kind, std::string text);  // at most ten of one kind

}  // namespace evical::pictures
