#include "core/geometry/tag_bits.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <cstdint>
#include <memory>

namespace evical {

std::vector<TagBits> firstTags(int count) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  std::vector<TagBits> tags(static_cast<std::size_t>(std::clamp(count, 0, static_cast<int>(family->ncodes))));
  for (std::size_t id = 0; id < tags.size(); ++id)
    for (std::uint32_t bit = 0; bit < family->nbits; ++bit)  // coordinates include the border of 1 bit
      tags[id].setBright(static_cast<int>(family->bit_y[bit]) - 1, static_cast<int>(family->bit_x[bit]) - 1,
                         (family->codes[id] >> (family->nbits - 1 - bit) & 1) != 0);
  return tags;
}

}  // namespace evical
