#include "core/report/quantity_labels.h"

#include "core/base/yaml_node.h"
#include "core/data/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace evical {
namespace {

std::string ownerName(const QuantityAddress& number, const NamedResult& named) {
  switch (number.owner) {
    case QuantityOwner::Camera:
      return named.cameras.at(number.sensor).name;
    case QuantityOwner::Imu:
      return named.imus.at(number.sensor).name;
    case QuantityOwner::Board:
      return named.boards.at(number.sensor);
    case QuantityOwner::Rig:
      break;
  }
  return kGravityQuantity.name;
}

}  // namespace

std::string columnKeys(const QuantityAddress& number, const NamedResult& named) {
  constexpr std::array kOwners = {"camera", "imu", "board"};
  const auto owner = static_cast<std::size_t>(number.owner);
  const std::string component = quantityPart(number).component;
  std::string keys;
  if (owner < kOwners.size())
    keys = fmt::format("{}: {}, ", kOwners[owner], yamlText(ownerName(number, named)));
  keys += fmt::format("quantity: {}", quantityInfo(number.owner, number.id).name);
  return component.empty() ? keys : fmt::format("{}, component: {}", keys, component);
}

std::vector<std::string> columnNames(const NamedResult& named) {
  std::vector<std::string> names;
  for (const QuantityAddress& column : named.result->uncertainty.columns) {
    const QuantityPart part = quantityPart(column);
    names.push_back(fmt::format("{}.{} [{}]", ownerName(column, named), part.name, part.unit));
  }
  return names;
}

QuantityWords quantityWords(const QuantityAddress& number, const NamedResult& named) {
  const QuantityInfo& info = quantityInfo(number.owner, number.id);
  QuantityWords words{ownerName(number, named), info.title, quantityPart(number).component};
  if (info.shape == QuantityShape::UpperTriangle) words.quantity += " scale and misalignment";
  if (info.shape != QuantityShape::Intrinsics && info.shape != QuantityShape::Gravity) return words;
  const std::size_t dot = std::min(words.part.find('.'), words.part.size());
  words.quantity = words.part.substr(0, dot);
  words.part.erase(0, dot + 1);
  std::ranges::replace(words.quantity, '_', ' ');
  return words;
}

std::string quantitySentence(const QuantityWords& words) {
  std::string text = words.sensor.empty() ? words.quantity : words.sensor + ": " + words.quantity;
  return words.part.empty() ? text : text + " " + words.part;
}

}  // namespace evical
