// A PNG of grey pixels that states how many there are to an inch, written row by row: only its compressed bytes are
// held.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace evical {

class GrayPng {
 public:
  GrayPng(int width_px, int height_px, double resolution_dpi);
  ~GrayPng();
  GrayPng(const GrayPng&) = delete;
  GrayPng& operator=(const GrayPng&) = delete;

  void addRow(std::span<const std::uint8_t> shades);
  std::string finish();  // the file, once all rows are there

 private:
  void addChunk(const char* type, const std::string& data);
  void compress(std::span<const std::uint8_t> bytes, int flush);

  struct Stream;  // of zlib
  std::unique_ptr<Stream> stream_;
  std::string file_, data_;
  std::vector<std::uint8_t> above_, line_;
};

}  // namespace evical
