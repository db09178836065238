// The tags of AprilGrids: the family 36h11.
#pragma once

#include <bitset>
#include <vector>

namespace evical {

inline constexpr int kTagSide_bits = 6;  // without the border

// Bright bits of a tag, row by row from its top left, without the border.
class TagBits {
 public:
  bool isBright(int row, int col) const { return bright_[place(row, col)]; }
  void setBright(int row, int col, bool bright) { bright_[place(row, col)] = bright; }

 private:
  static std::size_t place(int row, int col) { return static_cast<std::size_t>(row * kTagSide_bits + col); }

  std::bitset<kTagSide_bits * kTagSide_bits> bright_;
};

// The first `count` tags by number; at most the 587 of the family.
std::vector<TagBits> firstTags(int count);

}  // namespace evical
