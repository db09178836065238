// PNG of grey pixels with its resolution in pixels per inch, written row by row: only the compressed bytes
// are stored.
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
  std::string finish();  // the file, after all rows

 private:
  void addChunk(const char* type, const std::string& data);
  void compress(std::span<const std::uint8_t> bytes, int flush);

  struct Stream;  // of zlib
  std::unique_ptr<Stream> stream_;
  std::string file_, data_;
  std::vector<std::uint8_t> above_, line_;
};

}  // namespace evical
