// Names of estimated numbers, for people and for tables.
#pragma once

#include "core/data/quantity_address.h"
#include "core/report/result_yaml.h"

#include <string>
#include <vector>

namespace evical {

// "camera: left, quantity: gyroscope_bias, component: x", as result.yaml has it.
std::string columnKeys(const QuantityAddress& number, const NamedResult& named);

// "left.gyroscope_bias.x [rad/s]", for all columns of the result's covariance.
std::vector<std::string> columnNames(const NamedResult& named);

struct QuantityWords {
  std::string sensor;    // "left"
  std::string quantity;  // "gyroscope bias"
  std::string part;      // "x", "xy"; empty if the quantity is one number
};

QuantityWords quantityWords(const QuantityAddress& number, const NamedResult& named);

// "left: gyroscope bias x"
std::string quantitySentence(const QuantityWords& words);

}  // namespace evical
