#include "core/recording/aedat/chips.h"

#include <algorithm>
#include <string>

namespace evical::aedat {
namespace {

struct Chip {
  std::string_view begin;  // of its names, in capitals
  Resolution size_px;
};
constexpr Chip kChips[] = {{"DVS128", {128, 128}},   {"DAVIS128", {128, 128}}, {"DAVIS208", {208, 192}},
                           {"DAVIS240", {240, 180}}, {"DVS240", {240, 180}},   {"DAVIS346", {346, 260}},
                           {"DAVIS640", {640, 480}}, {"DVS132", {132, 104}}};

}  // namespace

Resolution chipSize(std::string_view name) {
  std::string capitals(name);
  for (char& c : capitals)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  for (const Chip& chip : kChips)
    if (capitals.starts_with(chip.begin)) return chip.size_px;
  return {};
}

}  // namespace evical::aedat
