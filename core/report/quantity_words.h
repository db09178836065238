// Names of estimated quantities, "left.gyroscope_bias.x [rad/s]", as people say them.
#pragma once

#include <string>

namespace evical {

struct QuantityWords {
  std::string sensor;    // "left"
  std::string quantity;  // "gyroscope bias"
  std::string part;      // "x", "xy"; empty where the quantity is one number
};

// Sensors may have dots in their names. What nobody knows is taken apart at its dots.
QuantityWords quantityWords(const std::string& name);

// "left: gyroscope bias x"
std::string quantitySentence(const QuantityWords& words);

}  // namespace evical
