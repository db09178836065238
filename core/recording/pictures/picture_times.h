// Tables of the times of pictures, one row each. Lines that are not rows are faults, except for comments,
// empty ones, and the first if it has names.
#pragma once

#include "core/recording/pictures/picture_lists.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace evical::pictures {

// Appends the rows "time, name" of a table; 10^unit_digits ns are its unit of time.
void readNamedTimes(const std::filesystem::path& table, int unit_digits, PictureList& list);

// The first column, or the first two, of a table, in ns.
struct TimeRow {
  std::int64_t first_ns = 0, second_ns = 0;
};
std::vector<TimeRow> readTimes(const std::filesystem::path& table, int unit_digits, bool two_columns,
                               PictureList& list);

// Gives the pictures of the list's folder, in the order of their names, the times of the rows: the middle if
// there are two. Pictures or rows without a partner are skipped and reported.
void pairWithTimes(const std::vector<TimeRow>& rows, bool two_columns, PictureList& list);

// Gives pictures that have times their exposures, of a table in us.
void readExposures(const std::filesystem::path& table, PictureList& list);

void addFault(PictureList& list, FaultKind kind, std::string text);  // but ten of one kind at most

}  // namespace evical::pictures
