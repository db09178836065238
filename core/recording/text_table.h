// Lines of numbers from a text file of any size, a block at a time, parsed by hand: iostreams and strtod
// would take longer than all the rest of a calibration.
#pragma once

#include "core/recording/input_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace evical {

class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path) : file_(path) {}

  // The next line without its end; the view is valid until the next call. False at the end.
  bool next(std::string_view& line);

  std::uint64_t lineNumber() const { return line_number_; }  // of the last one, from 1
  double fractionRead() const;
  const InputFile& file() const { return file_; }

 private:
  bool readBlock();

  InputFile file_;
  std::vector<std::uint8_t> block_, piece_;
  std::size_t position_ = 0;     // in the block
  std::uint64_t next_read_ = 0;  // in the file
  std::uint64_t line_number_ = 0;
};

// Parses columns one after another; blanks, tabs, commas and semicolons separate.
class ColumnParser {
 public:
  explicit ColumnParser(std::string_view line) : text_(line) {}

  // A decimal number times 10^power, rounded to an integer, exact beyond what a double holds. False if there
  // is no such number, or if it does not fit.
  bool decimal(int power, std::int64_t& value);
  bool real(double& value);
  std::string_view word();  // up to the next separator
  bool atEnd();

 private:
  void skipSeparators();

  std::string_view text_;
};

}  // namespace evical
