// Text in CSV.
#pragma once

#include "core/base/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Quoted text: names may contain commas and quotes; line breaks are replaced. A spreadsheet calculates cells
// that begin with one of = + - @: unless they are numbers, they get the mark ' at the beginning, which it
// shows as text.
std::string quotedCsv(const std::string& text);

// Quoted only if the text contains a comma, a semicolon, a quote or a line break.
std::string csvWord(const std::string& text);

// A cell without that mark.
std::string fromCsv(const std::string& cell);

// Reader for Evical's own tables; columns are identified by their names.
class CsvReader {
 public:
  // All members throw CalibrationError (BadInput) if the file cannot be read or a column is missing.
  CsvReader(const std::filesystem::path& file, const std::vector<std::string>& columns);

  bool next();  // the next line that is not empty; false at the end

  // Values of the line, by the column's position among the requested ones.
  const std::string& text(std::size_t column) const { return words_[places_[column]]; }
  double real(std::size_t column) const;  // finite
  int integer(std::size_t column, int minimum, int maximum) const;
  std::size_t choice(std::size_t column, const std::vector<std::string_view>& words) const;

  // "detections.csv (line 7): x_px ..."
  CalibrationError error(std::size_t column, const std::string& problem) const;

 private:
  bool split();

  std::filesystem::path file_;
  std::ifstream stream_;
  std::vector<std::string> columns_;
  std::vector<std::size_t> places_;
  std::string line_;
  std::vector<std::string> words_;
  std::uint64_t number_ = 0;
};

}  // namespace evical
